#include "tap/people.h"

#include <math.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "statistics/sample.h"

uint32_t ethd__cell_person(const ethd__cell *cell, size_t i) { return cell->person ? cell->person[i] : (uint32_t)i; }

typedef struct persons_value {
  uint32_t person;
  double value;
} persons_value;

static int by_person(const void *a, const void *b) {
  const persons_value *p = a, *q = b;
  if (p->person != q->person) return p->person < q->person ? -1 : 1;
  return (p->value > q->value) - (p->value < q->value);
}

static size_t take(const ethd__cell *cell, ethd__tap_value *of, bool attempts, persons_value *out) {
  size_t n = 0;
  for (size_t i = 0; cell && i < cell->count; i++) {
    const ethd__metrics *m = &cell->results[i].metrics;
    double value = attempts || m->reason == ETHD_TAP_OK ? of(m) : NAN;
    if (!isnan(value)) out[n++] = (persons_value){ethd__cell_person(cell, i), value};
  }
  qsort(out, n, sizeof *out, by_person);
  return n;
}

void ethd__people_figure(const ethd__cell *cell, ethd__tap_value *of, ethd__person_figure figure, size_t people,
                         double *out) {
  size_t room = (cell ? cell->count : 0) + 1;
  persons_value *taken = malloc(room * sizeof *taken);
  double *own = malloc(room * sizeof *own);
  if (!taken || !own) ethd__fail_memory();
  size_t n = take(cell, of, figure == ETHD_PERSON_ATTEMPTS, taken);
  for (size_t p = 0; p < people; p++) out[p] = NAN;
  for (size_t i = 0, count; i < n; i += count) {
    uint32_t person = taken[i].person;
    for (count = 0; i + count < n && taken[i + count].person == person; count++) own[count] = taken[i + count].value;
    out[person] = figure == ETHD_PERSON_MEDIAN ? ethd__quantile(own, count, 0.5)
                  : figure == ETHD_PERSON_MOST ? own[count - 1]
                                               : ethd__mean_of(own, count);
  }
  free(taken);
  free(own);
}
