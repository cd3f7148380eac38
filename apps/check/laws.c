#include "check/laws.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "device/driver_file.h"
#include "ethd/config.h"
#include "ethd/plugin.h"
#include "settings/config_parts.h"
#include "text/csv.h"

/* ---- one table ---- */

static const char *text_of(const ethd_param *row, double value, char out[32]) {
  const char *at = row->unit;
  if (!ethd_param_words(row)) {
    snprintf(out, 32, "%.10g", value);
    return out;
  }
  for (int i = 0; i < (int)value; i++) at += strcspn(at, "|") + 1;
  snprintf(out, 32, "%.*s", (int)strcspn(at, "|"), at);
  return out;
}

static void print(const char *section, const ethd_method *m) {
  char def[32];
  printf("%s %s: %s\n", section, m->id, m->brief);
  for (uint32_t i = 0; i < m->param_count; i++) {
    const ethd_param *row = &m->params[i];
    text_of(row, row->def, def);
    if (ethd_param_words(row))
      printf("    %-14s %-12s %s: %s\n", row->name, def, row->unit, row->brief);
    else
      printf("    %-14s %-12s %s, %.10g to %.10g: %s\n", row->name, def, row->unit, row->min, row->max, row->brief);
  }
}

static void write_row(ethd_csv_out *csv, const char *section, const ethd_method *m, const ethd_param *row) {
  char def[32] = "";
  ethd_csv_word(csv, section);
  ethd_csv_word(csv, m->id);
  ethd_csv_word(csv, row ? row->name : "");
  ethd_csv_text(csv, row ? row->unit : "");
  ethd_csv_number(csv, row ? row->min : NAN);
  ethd_csv_number(csv, row ? row->max : NAN);
  if (row && ethd_param_words(row))
    ethd_csv_word(csv, text_of(row, row->def, def));
  else
    ethd_csv_number(csv, row ? row->def : NAN);
  ethd_csv_text(csv, row ? row->brief : m->brief);
  ethd_csv_row(csv);
}

static void show(const char *section, const ethd_method *m, ethd_csv_out *csv) {
  print(section, m);
  if (!csv) return;
  write_row(csv, section, m, NULL);
  for (uint32_t i = 0; i < m->param_count; i++) write_row(csv, section, m, &m->params[i]);
}

static void show_all(const ethd_law *const *laws, ethd_csv_out *csv) {
  for (const ethd_setup_part *part = ethd_setup_parts; part < ethd_setup_parts + ETHD_SETUP_PARTS; part++) {
    for (uint32_t i = 0; i < part->count; i++) show(part->section, &part->methods[i], csv);
    for (const ethd_law *const *law = laws; !part->methods && *law; law++) {
      const ethd_method m = {(*law)->id, (*law)->brief, (*law)->params, (*law)->param_count};
      if ((*law)->kind == part->kind) show(part->section, &m, csv);
    }
  }
}

/* ---- drivers ---- */

static void show_driver(const ethd_driver *driver, ethd_csv_out *csv) {
  const ethd_method m = {driver->id, driver->brief, driver->params, driver->param_count};
  show("device", &m, csv);
  for (const char *const *key = driver->keys; key && *key; key++) printf("    %-14s text\n", *key);
}

static void show_file(const char *path, ethd_csv_out *csv) {
  char what[ETHD_MESSAGE_MAX];
  ethd_driver driver;
  ethd_status status = ethd__driver_load(path, &driver, what);
  if (status < 0) ethd__fail(ethd__exit_code(status), "--driver: %s: %s", path, what);
  show_driver(&driver, csv);
}

static void show_drivers(ethd_csv_out *csv) {
  for (const ethd_driver *const *d = ethd_drivers; *d; d++) show_driver(*d, csv);
}

/* ---- laws ---- */

/* Loads plugins as a configuration does. */
static ethd_config *load(const ethd__listing *what) {
  char message[ETHD_MESSAGE_MAX];
  ethd_config *config;
  ethd__must(ethd_config_load(NULL, &config, message), message);
  for (int i = 0; i < what->plugin_count; i++) {
    ethd__key key = {NULL, 0, "plugins", "file", what->plugins[i], message};
    ethd__need(ethd__config_plugin((ethd__config *)config, &key), message);
  }
  return config;
}

void ethd__list(const ethd__listing *what) {
  char message[ETHD_MESSAGE_MAX];
  ethd_csv_out *csv = NULL;
  ethd_config *config = load(what);
  if (what->csv && !(csv = ethd_csv_create(what->csv, "section,id,param,unit,min,max,default,brief", message)))
    ethd__fail(ETHD_EXIT_FAILED, "%s", message);
  if (what->laws) show_all(config->laws, csv);
  if (what->drivers) show_drivers(csv);
  if (what->driver) show_file(what->driver, csv);
  if (csv && ethd_csv_close(csv, message) < 0) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
  ethd_config_free(config);
}
