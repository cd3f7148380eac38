#include "calibrate/report.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/picture.h"
#include "text/csv.h"
#include "text/error_text.h"
#include "text/text.h"

static void print_length(double metres) {
  if (isnan(metres))
    printf(" %10s", "-");
  else
    printf(" %10.4f", 1e3 * metres);
}

static void print_level(const ethd__places *p, ethd__level level, bool chosen) {
  ethd__calibration c;
  char message[ETHD_MESSAGE_MAX];
  bool failed = ethd__places_fit(p, level, &c, message) != ETHD_OK;
  printf("%c %-8s", chosen ? '*' : ' ', ethd__level_names[level]);
  print_length(failed ? (double)NAN : c.residual);
  print_length(failed ? (double)NAN : ethd__places_left_out(p, level));
  printf(failed ? "  %s\n" : "\n", message);
}

static void print_sensor(const ethd__calibration *c, int k) {
  const ethd__sensor *s = &c->sensors[k];
  printf("  %-8d", k);
  print_length(s->residual);
  if (s->points)
    printf("  %8.0f  a table of %u point%s\n", s->dark, s->points, ethd__s(s->points));
  else
    printf("  %8.0f  %10.5g %8.4f %8.4f\n", s->dark, s->a, s->p, 1e3 * s->d0);
}

void ethd__calibration_print(const ethd__places *p, const ethd__calibration *chosen) {
  printf("\n%zu place%s, a rod of %.3f mm in a ring of %.3f mm (radii)\n\n", p->count, ethd__s(p->count), 1e3 * p->rod,
         1e3 * p->ring_radius);
  printf("  %-8s %10s %10s  mm rms; left out: at places that weren't used in the fit\n", "level", "residual",
         "left out");
  for (int level = 0; level < ETHD__LEVEL_COUNT; level++)
    print_level(p, (ethd__level)level, (ethd__level)level == chosen->level);
  printf("\n  %-8s %10s  %8s  %10s %8s %8s\n", "sensor", "residual", "dark", "a", "p", "d0 mm");
  for (int k = 0; k < ETHD_RAYS; k++) print_sensor(chosen, k);
  printf("\n");
}

static void put_reading(ethd_csv_out *out, const ethd__calibration *c, const ethd__place_reading *place, int k) {
  double counts = place->counts[k], at = place->distance[k];
  if (isnan(at) || counts <= 0 || counts >= ETHD__FRAME_SATURATED || isnan(c->sensors[k].dark)) return;
  double found = ethd__sensor_distance(&c->sensors[k], (uint16_t)rint(counts));
  ethd_csv_integer(out, k);
  ethd_csv_number(out, counts);
  ethd_csv_number(out, c->sensors[k].dark);
  ethd_csv_number(out, at);
  ethd_csv_number(out, found);
  ethd_csv_number(out, found - at);
  ethd_csv_row(out);
}

ethd_status ethd__calibration_csv(const ethd__places *p, const ethd__calibration *c, const char *path,
                                  char message[ETHD_MESSAGE_MAX]) {
  ethd_csv_out *out = ethd_csv_create(path, "sensor,counts,dark_counts,placed_m,found_m,error_m", message);
  if (!out) return ETHD_E_FILE;
  for (size_t i = 0; i < p->count; i++)
    for (int k = 0; k < ETHD_RAYS; k++) put_reading(out, c, &p->readings[i], k);
  return ethd_csv_close(out, message);
}

ethd_status ethd__calibration_draw(const char *csv, const char *png, char message[ETHD_MESSAGE_MAX]) {
  const ethd__picture_value values[] = {{"in", csv, true}, {"out", png, true}, {NULL, NULL, false}};
  return ethd__picture_draw("calibration.gp", NULL, values, message);
}
