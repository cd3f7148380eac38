#include "tune/search.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "text/error_text.h"

/* A round runs 1/part of the last round's taps. It keeps the best points of the round before: `percent` of the number
   of points in the first round. It draws `children` new points about each survivor, within `spread` of the range. */
static const struct {
  uint32_t part, percent, children;
  double spread;
} plan[ETHD_TUNE_ROUNDS] = {{20, 0, 0, 0}, {10, 12, 3, 0.12}, {4, 8, 2, 0.05}, {1, 6, 0, 0}};

#define WORSE 1.1 /* times the configuration's figure: a worse figure counts more, by the next factor */
#define DEARER 10.0
#define TAPS_LEAST 8      /* with fewer hardly a hand meets the wall at the requested speed */
#define LEAST 4           /* points kept in the smallest search */
#define THIN 4            /* one in THIN points outside the margin is tapped too, for comparison */
#define DRAWS_A_POINT 128 /* points that are drawn at most for one that keeps the margin */

/* ---- a round's points ---- */

static ethd_status make_room(ethd__tune_round *r, size_t most, char *message) {
  r->entries = calloc(most, sizeof *r->entries);
  return r->entries ? ETHD_OK : ethd__no_memory(message, NULL);
}

static void add(ethd__tune_round *r, const ethd__tune_point *point, bool keeps) {
  r->entries[r->count++] = (ethd__tune_entry){.point = *point, .keeps = keeps, .settled = -1};
}

/* Adds the configuration's own point, which is the reference, whether it keeps the margin or not. */
static void add_own(const ethd__tune_search *s, ethd__tune_round *r) {
  ethd__tune_point own = ethd__space_own(s->rig->space);
  add(r, &own, ethd__score_keeps(s->rig, &own));
}

static ethd_status hardly_any(const ethd__tune_search *s, char *message) {
  const unsigned long long kept = s->kept, drawn = s->drawn;
  if (!s->rig->passive)
    return ethd__say(message, ETHD_E_RANGE,
                     "hardly any gains keep the margin: %llu of %llu; a smaller --gain-margin or --delay-margin, other "
                     "ranges",
                     kept, drawn);
  return ethd__say(
      message, ETHD_E_RANGE,
      "hardly any gains keep the margin: %llu of %llu; --passive asks for k_e T/2 + b_e under the device's "
      "%.3g Ns/m: --range contact.k_e=LOW:HIGH, contact.b_e=LOW:HIGH",
      kept, drawn, s->rig->study->plant.viscous);
}

static ethd_status fill_first(ethd__tune_search *s, ethd__tune_round *r, char *message) {
  const size_t thin = s->points / THIN;
  ethd_status status = make_room(r, s->points + thin + 1, message);
  if (status) return status;
  add_own(s, r);
  for (uint64_t i = 0; s->kept < s->points && !ethd__stop; i++) {
    ethd__tune_point p = ethd__space_at(s->rig->space, i);
    bool keeps = ethd__score_keeps(s->rig, &p);
    s->drawn++;
    s->kept += keeps;
    if (keeps || s->drawn - s->kept <= thin) add(r, &p, keeps);
    if (i >= (uint64_t)DRAWS_A_POINT * s->points) return hardly_any(s, message);
  }
  return ETHD_OK;
}

static uint32_t survivors(const ethd__tune_search *s, int round) {
  uint32_t n = s->points * plan[round].percent / 100;
  return n < LEAST ? LEAST : n;
}

static int by_total(const void *a, const void *b) {
  const ethd__tune_entry *const *x = a, *const *y = b;
  if ((*x)->front != (*y)->front) return (*x)->front ? -1 : 1;
  if ((*x)->total != (*y)->total) return (*x)->total < (*y)->total ? -1 : 1;
  return *x < *y ? -1 : 1;
}

/* Orders the points by their totals, those of the front before the others. */
static const ethd__tune_entry **ranked(const ethd__tune_round *r, size_t *count) {
  const ethd__tune_entry **order = malloc(r->count * sizeof *order);
  *count = 0;
  for (size_t i = 1; order && i < r->count; i++) /* the own point is in every round already */
    if (r->entries[i].keeps && isfinite(r->entries[i].total)) order[(*count)++] = &r->entries[i];
  if (order) qsort(order, *count, sizeof *order, by_total);
  return order;
}

/* Appends the best point by each goal to the first `count` of the order, unless it is among them. Returns the new
   count. */
static size_t add_extremes(const ethd__tune_entry **order, size_t count, size_t all) {
  for (int g = 0; g < ETHD_TUNE_GOALS; g++) {
    size_t best = 0;
    for (size_t i = 1; i < all; i++)
      if (order[i]->goals[g] < order[best]->goals[g]) best = i;
    if (best < count) continue;
    const ethd__tune_entry *e = order[best];
    order[best] = order[count];
    order[count++] = e;
  }
  return count;
}

/* Keeps the first `most` points of the order that settle at their margins in time, and notes in their round which
   do. */
static ethd_status confirm(ethd__tune_search *s, ethd__tune_round *from, const ethd__tune_entry **order, size_t *count,
                           size_t most, char *message) {
  ethd_status status = ETHD_OK;
  size_t good = 0;
  for (size_t i = 0; !status && i < *count && good < most && !ethd__stop; i++) {
    ethd__progress(good, most, "margins in time");
    status = ethd__score_confirm(s->rig, &order[i]->point, &s->verdict, message);
    s->asked++;
    if (!status) from->entries[order[i] - from->entries].settled = s->verdict.settles;
    if (!status && s->verdict.settles) order[good++] = order[i];
  }
  ethd__progress(most, most, "margins in time");
  *count = good;
  return status;
}

static ethd_status fill_next(ethd__tune_search *s, int round, char *message) {
  ethd__tune_round *r = &s->rounds[round];
  size_t parents;
  ETHD__FREED const ethd__tune_entry **order = ranked(r - 1, &parents);
  if (!order) return ethd__no_memory(message, NULL);
  ethd_status status = ETHD_OK;
  if (round == ETHD_TUNE_ROUNDS - 1)
    status = confirm(s, r - 1, order, &parents, survivors(s, round), message);
  else if (parents > survivors(s, round))
    parents = add_extremes(order, survivors(s, round), parents);
  if (!status) status = make_room(r, 1 + parents * (1 + plan[round].children), message);
  if (!status) add_own(s, r);
  for (size_t i = 0; !status && i < parents; i++) {
    add(r, &order[i]->point, true);
    r->entries[r->count - 1].settled = order[i]->settled;
    for (uint32_t c = 0; c < plan[round].children; c++) {
      uint64_t number = ((uint64_t)round << 48) + i * plan[round].children + c;
      ethd__tune_point p = ethd__space_near(s->rig->space, &order[i]->point, plan[round].spread, number);
      if (ethd__score_keeps(s->rig, &p)) add(r, &p, true);
    }
  }
  return status;
}

/* ---- scores ---- */

static ethd_status score_all(ethd__tune_search *s, int round, char *message) {
  ethd__tune_round *r = &s->rounds[round];
  char what[48];
  snprintf(what, sizeof what, "round %d of %d", round + 1, ETHD_TUNE_ROUNDS);
  ethd_status status = ETHD_OK;
  for (size_t i = 0; !status && i < r->count && !ethd__stop; i++) {
    ethd__progress(i, r->count, what);
    status = ethd__score_run(s->rig, &r->entries[i].point, r->taps, &r->entries[i].score, message);
  }
  ethd__progress(r->count, r->count, what);
  return status;
}

/* ---- ranks ---- */

static bool dominates(const ethd__tune_entry *a, const ethd__tune_entry *b) {
  bool better = false;
  for (int g = 0; g < ETHD_TUNE_GOALS; g++) {
    if (a->goals[g] > b->goals[g]) return false;
    better |= a->goals[g] < b->goals[g];
  }
  return better;
}

static void rank(const ethd__tune_search *s, ethd__tune_round *r) {
  for (size_t i = 0; i < r->count; i++) {
    ethd__tune_entry *e = &r->entries[i];
    e->total = 0;
    ethd__score_goals(&e->score, &r->entries[0].score, e->goals);
    for (int g = 0; g < ETHD_TUNE_GOALS; g++)
      e->total += s->weights[g] * e->goals[g] + DEARER * fmax(0, e->goals[g] - log(WORSE));
  }
  for (size_t i = 0; i < r->count; i++) {
    ethd__tune_entry *e = &r->entries[i];
    e->front = e->keeps && isfinite(e->total);
    for (size_t k = 0; k < r->count && e->front; k++)
      if (r->entries[k].keeps && dominates(&r->entries[k], e)) e->front = false;
  }
}

/* ---- the whole ---- */

ethd_status ethd__search_run(ethd__tune_search *s, bool *over, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = ETHD_OK;
  *over = false;
  for (int round = 0; !status && round < ETHD_TUNE_ROUNDS; round++) {
    s->rounds[round].taps = s->taps / plan[round].part > TAPS_LEAST ? s->taps / plan[round].part : TAPS_LEAST;
    status = round ? fill_next(s, round, message) : fill_first(s, &s->rounds[0], message);
    if (!status) status = score_all(s, round, message);
    if (status || ethd__stop) return status;
    rank(s, &s->rounds[round]);
    if (!isfinite(s->rounds[round].entries[0].total))
      return ethd__say(
          message, ETHD_E_RANGE,
          "under the configuration's own gains hardly a finger touches at the speeds asked for, so nothing can be "
          "compared: more --taps, or other gains to begin from");
  }
  *over = !status;
  return status;
}

const ethd__tune_entry *ethd__search_choice(const ethd__tune_search *s) {
  const ethd__tune_round *last = &s->rounds[ETHD_TUNE_ROUNDS - 1];
  const ethd__tune_entry *best = NULL;
  for (size_t i = 1; i < last->count; i++)
    if (last->entries[i].front && (!best || last->entries[i].total < best->total)) best = &last->entries[i];
  return best;
}

void ethd__search_free(ethd__tune_search *s) {
  for (int i = 0; i < ETHD_TUNE_ROUNDS; i++) free(s->rounds[i].entries);
}
