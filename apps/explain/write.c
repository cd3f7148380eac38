/* Writes the plant that was found as files that ethd-tap takes. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "explain/prior.h"
#include "sim/plant.h"
#include "text/error_text.h"
#include "text/text.h"

static void put_number(FILE *f, const ethd__plant_row *row, const ethd_plant *plant) {
  double value;
  memcpy(&value, (const char *)plant + row->offset, sizeof value);
  fprintf(f, "%s = %.6g ; %s\n", row->param.name, value, row->param.unit);
}

static void put_choice(FILE *f, const ethd__plant_row *row, const ethd_plant *plant) {
  int32_t value;
  const char *word = row->param.unit;
  memcpy(&value, (const char *)plant + row->offset, sizeof value);
  for (int32_t i = 0; i < value; i++) word += strcspn(word, "|") + 1;
  fprintf(f, "%s = %.*s\n", row->param.name, (int)strcspn(word, "|"), word);
}

static void put_origins(FILE *f, const ethd__explain_point *point) {
  fprintf(f, "# Found by ethd-explain within stated bounds, to explain the paper. Plausible, not measured.\n");
  for (int n = 0; n < ETHD_EXPLAIN_NUMBERS; n++) {
    const ethd__explain_prior *p = &ethd__explain_priors[n];
    fprintf(f, "#   %s %.6g (%g to %g %s): %s\n", p->name, ethd__explain_value(point, n), p->low, p->high, p->unit,
            p->origin);
  }
}

static void put_plant(FILE *f, const ethd__explain_point *point, const ethd_plant *plant) {
  const char *section = "";
  put_origins(f, point);
  for (size_t i = 0; i < ethd__plant_row_count; i++) {
    const ethd__plant_row *row = &ethd__plant_rows[i];
    if (strcmp(section, row->section) != 0) fprintf(f, "\n[%s]\n", section = row->section);
    if (ethd_param_words(&row->param))
      put_choice(f, row, plant);
    else
      put_number(f, row, plant);
  }
}

static void put_config(FILE *f, const char *name, const ethd__explain_twin *twin) {
  const ethd_plant *p = &twin->plant;
  fprintf(f, "# The controller beside plant %s: the paper's gains, the law as printed.\n", name);
  fprintf(f, "[arm]\nmechanism = parallel\nmass_x = %.6g\nmass_y = %.6g\n", p->mass[0], p->mass[1]);
  fprintf(f, "\n[finger]\nradius = %s\nradius_max = %s\n", twin->text[2], twin->text[3]);
  fprintf(f, "\n[velocity]\nmethod = lowpass\ncutoff = %s\n", twin->text[0]);
  fprintf(f,
          "\n[finger_filter]\nmethod = cv\nreference = %s\ncompensation = none\ngate = inf\nnoise = 0.101e-3\n"
          "acceleration = %s\n",
          twin->text[4], twin->text[1]);
  fprintf(f, "\n[transition]\nlaw = offset\npreset = paper\n\n[device]\ndriver = sim\nplant = %s\n", name);
}

static ethd_status put_file(const char *path, const char *suffix, const ethd__explain_point *point,
                            const ethd__explain_twin *twin, char *message) {
  char *text = NULL, *name = NULL;
  const char *slash = strrchr(path, '/');
  size_t length;
  FILE *f = open_memstream(&text, &length);
  if (!f || asprintf(&name, "%s%s", path, suffix) < 0) return ethd__no_memory(message, path);
  if (point)
    put_plant(f, point, &twin->plant);
  else
    put_config(f, slash ? slash + 1 : path, twin);
  ethd_status status = fclose(f) ? ethd__no_memory(message, path) : ethd_text_write(name, text, strlen(text), message);
  free(text);
  free(name);
  return status;
}

ethd_status ethd__explain_write(const char *path, const ethd__explain_point *point, const ethd__explain_twin *twin,
                                char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = put_file(path, ".plant", point, twin, message);
  return status ? status : put_file(path, ".ini", NULL, twin, message);
}
