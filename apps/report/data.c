#include "report/data.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "study/protocol.h"
#include "text/error_text.h"
#include "text/file_name.h"

/* ---- quantities ---- */

#define OF(name, expression) \
  static double name(const ethd__metrics *m) { return expression; }
OF(v_rvo, m->v_rvo)
OF(v_of, m->v_of)
OF(d_max, 1e3 * m->d_max)
OF(v_rmin, m->v_rmin)
OF(delta_s, m->delta_s)
OF(eps, 1e3 * m->eps)
OF(delay, 1e3 * (m->t_of - m->t_seen))
OF(force, m->peak_force)

const ethd__quantity ethd__quantities[ETHD_QUANTITIES] = {
    [ETHD_Q_V_RVO] = {"v_rvo", "Ring's speed as it meets the wall", "m/s", v_rvo, 3},
    [ETHD_Q_V_OF] = {"v_of", "Ring's speed as the finger touches it", "m/s", v_of, 3},
    [ETHD_Q_D_MAX] = {"d_max", "First rebound", "mm", d_max, 3},
    [ETHD_Q_V_RMIN] = {"v_rmin", "Ring's smallest speed after the touch", "m/s", v_rmin, 3},
    [ETHD_Q_DELTA_S] = {"delta_s", "Time of braking", "ms", delta_s, 2},
    [ETHD_Q_EPS] = {"eps", "Offset of the wall", "mm", eps, 3},
    [ETHD_Q_DELAY] = {"delay", "Touch felt after it is seen", "ms", delay, 1},
    [ETHD_Q_FORCE] = {"peak_force", "Largest rendered force", "N", force, 2},
};

size_t ethd__group_values(const ethd__group *group, const ethd__quantity *quantity, double *out, uint32_t *person) {
  size_t n = 0;
  for (size_t i = 0; i < group->cell.count; i++) {
    const ethd__metrics *m = &group->cell.results[i].metrics;
    double value = quantity->of(m);
    if (m->reason != ETHD_TAP_OK || isnan(value)) continue;
    if (person) person[n] = group->who[i].person;
    out[n++] = value;
  }
  return n;
}

/* ---- reading ---- */

/* Columns that are needed, in this order. */
enum { TRANSITION, SPEED, VALID, REASON, WORDS };
static const char *const word_names[WORDS] = {"transition", "speed", "valid", "reason"};

static const struct {
  const char *name;
  size_t offset;
} figures[] = {
#define METRIC(column, field) {column, offsetof(ethd__result, metrics) + offsetof(ethd__metrics, field)}
    METRIC("v_rvo_mps", v_rvo),
    METRIC("v_of_mps", v_of),
    METRIC("d_max_m", d_max),
    METRIC("v_rmin_mps", v_rmin),
    METRIC("delta_s_ms", delta_s),
    METRIC("eps_m", eps),
    METRIC("t_rvo_s", t_rvo),
    METRIC("t_of_s", t_of),
    METRIC("t_seen_s", t_seen),
    METRIC("peak_force_n", peak_force),
    {"finger_radius_m", offsetof(ethd__result, finger_radius)},
    {"commanded_mps", offsetof(ethd__result, commanded)},
};
enum { FIGURES = sizeof figures / sizeof *figures };

typedef struct reading {
  ethd__data *out;
  const ethd_plant *plant;
  size_t point;
  int word[WORDS], figure[FIGURES], participant, part, at_point;
  char *message;
} reading;

static ethd_status refuse(const reading *r, size_t row, const char *column, const char *found, const char *allowed) {
  char quote[ETHD_QUOTE_MAX];
  return ethd__say(r->message, ETHD_E_RANGE, "%s:%zu: %s: found %s, %s is allowed", r->out->sheet.path, row + 2, column,
                   ethd__quote(found, strlen(found), quote), allowed);
}

static ethd_status find_columns(reading *r) {
  const ethd__sheet *sheet = &r->out->sheet;
  const char *missing = NULL;
  for (int i = 0; i < WORDS; i++)
    if ((r->word[i] = ethd__sheet_column(sheet, word_names[i])) < 0) missing = word_names[i];
  for (int i = 0; i < FIGURES; i++)
    if ((r->figure[i] = ethd__sheet_column(sheet, figures[i].name)) < 0) missing = figures[i].name;
  r->participant = ethd__sheet_column(sheet, "participant");
  r->part = ethd__sheet_column(sheet, "part");
  r->at_point = ethd__sheet_column(sheet, "point");
  if (r->participant < 0) missing = "participant";
  if (!missing) return ETHD_OK;
  return ethd__say(r->message, ETHD_E_UNKNOWN, "%s:1: no column %s; a taps.csv of ethd-study has it", sheet->path,
                   missing);
}

static ethd__group *group_of(reading *r, size_t row) {
  ethd__data *data = r->out;
  const char *law = ethd__sheet_cell(&data->sheet, row, r->word[TRANSITION]);
  const char *speed = ethd__sheet_cell(&data->sheet, row, r->word[SPEED]);
  for (size_t i = 0; i < data->group_count; i++)
    if (!strcmp(data->group[i].cell.law, law) && !strcmp(data->group[i].speed.word, speed)) return &data->group[i];
  if (data->group_count == ETHD_REPORT_CELLS) return NULL;
  ethd__group *group = &data->group[data->group_count];
  *group = (ethd__group){.cell = {.law = law}};
  if (!ethd__speed_parse(speed, r->plant, &group->speed)) return NULL;
  data->group_count++;
  return group;
}

static ethd_status read_result(const reading *r, size_t row, ethd__result *out) {
  const ethd__sheet *sheet = &r->out->sheet;
  const char *reason = ethd__sheet_cell(sheet, row, r->word[REASON]);
  int index = 0;
  *out = (ethd__result){0};
  while (index < ETHD_TAP_REASON_COUNT && strcmp(reason, ethd__reason_words[index])) index++;
  if (index == ETHD_TAP_REASON_COUNT) return refuse(r, row, "reason", reason, "ok, early-contact and the like");
  out->metrics.reason = (ethd__reason)index;
  for (int i = 0; i < FIGURES; i++)
    if (!ethd__sheet_number(sheet, row, r->figure[i], (double *)((char *)out + figures[i].offset)))
      return refuse(r, row, figures[i].name, ethd__sheet_cell(sheet, row, r->figure[i]), "a number");
  return ETHD_OK;
}

/* Participants' rows stand together, but for another point's. */
static uint32_t person_of(reading *r, size_t row) {
  ethd__data *data = r->out;
  const char *id = ethd__sheet_cell(&data->sheet, row, r->participant);
  for (size_t i = data->people_count; i-- > 0;)
    if (!strcmp(data->people[i], id)) return (uint32_t)i;
  data->people[data->people_count] = id;
  return (uint32_t)data->people_count++;
}

static bool grow(ethd__group *group) {
  size_t n = group->cell.count;
  if (n & (n - 1)) return true; /* room doubles at powers of two */
  size_t room = n ? 2 * n : 1;
  ethd__result *results = realloc(group->cell.results, room * sizeof *results);
  if (results) group->cell.results = results;
  ethd__who *who = realloc(group->who, room * sizeof *who);
  if (who) group->who = who;
  return results && who;
}

/* Words of the table that stand in names of files. */
static ethd_status check_words(const reading *r, size_t row) {
  static const struct {
    const char *name;
    size_t column;
  } words[] = {{"participant", offsetof(reading, participant)},
               {"transition", offsetof(reading, word[TRANSITION])},
               {"speed", offsetof(reading, word[SPEED])}};
  for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
    const char *word = ethd__sheet_cell(&r->out->sheet, row, *(const int *)((const char *)r + words[i].column));
    if (!ethd__file_word(word) || strchr("+-", *word)) return refuse(r, row, words[i].name, word, ETHD_FILE_WORD);
  }
  return ETHD_OK;
}

static ethd_status take(reading *r, size_t row) {
  double point = 0;
  const ethd__sheet *sheet = &r->out->sheet;
  if (r->at_point >= 0 && !ethd__sheet_number(sheet, row, r->at_point, &point))
    return refuse(r, row, "point", ethd__sheet_cell(sheet, row, r->at_point), "a number");
  if (!(point >= 0 && point <= ETHD_STUDY_POINTS))
    return refuse(r, row, "point", ethd__sheet_cell(sheet, row, r->at_point), "a point of the grid");
  if (point >= (double)r->out->points) r->out->points = (size_t)point + 1;
  if (point != (double)r->point) return ETHD_OK;
  ethd_status status = check_words(r, row);
  if (status) return status;
  bool training = !strcmp(ethd__sheet_cell(sheet, row, r->part), "training");
  r->out->training += training;
  if (training) return ETHD_OK;
  ethd__group *group = group_of(r, row);
  if (!group)
    return refuse(r, row, "speed", ethd__sheet_cell(sheet, row, r->word[SPEED]), "low, high or a number, in 64 cells,");
  if (!grow(group)) return ethd__no_memory(r->message, sheet->path);
  status = read_result(r, row, &group->cell.results[group->cell.count]);
  if (status) return status;
  group->who[group->cell.count++] = (ethd__who){person_of(r, row), row};
  return ETHD_OK;
}

/* Low before high, then as found; strategies by name from the one that brakes least. */
static int by_speed(const void *a, const void *b) {
  static const char *const order[] = {"abrupt", "smooth", "offset"};
  const ethd__group *p = a, *q = b;
  if (p->speed.centre != q->speed.centre) return p->speed.centre < q->speed.centre ? -1 : 1;
  int i = 0, j = 0;
  while (i < 3 && strcmp(p->cell.law, order[i])) i++;
  while (j < 3 && strcmp(q->cell.law, order[j])) j++;
  return i != j ? i - j : strcmp(p->cell.law, q->cell.law);
}

/* out->sheet is there. */
static ethd_status take_all(reading *r) {
  ethd__data *out = r->out;
  out->points = 1;
  out->people = calloc(out->sheet.rows + 1, sizeof *out->people);
  ethd_status status = out->people ? find_columns(r) : ethd__no_memory(r->message, out->sheet.path);
  for (size_t row = 0; !status && row < out->sheet.rows; row++) status = take(r, row);
  if (!status && !out->group_count)
    status = ethd__say(r->message, ETHD_E_RANGE, "%s: no test tap at point %zu of %zu", out->sheet.path, r->point,
                       out->points);
  if (status) {
    ethd__data_free(out);
    return status;
  }
  qsort(out->group, out->group_count, sizeof *out->group, by_speed);
  for (size_t i = 0; i < out->group_count; i++) out->group[i].cell.speed = &out->group[i].speed;
  return ETHD_OK;
}

ethd_status ethd__data_read(const char *path, const ethd_plant *plant, size_t point, ethd__data *out,
                            char message[ETHD_MESSAGE_MAX]) {
  reading r = {.out = out, .plant = plant, .point = point, .message = message};
  memset(out, 0, sizeof *out);
  ethd_status status = ethd__sheet_read(path, &out->sheet, message);
  return status ? status : take_all(&r);
}

ethd_status ethd__data_at(const ethd__data *whole, const ethd_plant *plant, size_t point, ethd__data *out,
                          char message[ETHD_MESSAGE_MAX]) {
  reading r = {.out = out, .plant = plant, .point = point, .message = message};
  memset(out, 0, sizeof *out);
  out->sheet = whole->sheet;
  out->borrowed = true;
  return take_all(&r);
}

void ethd__data_free(ethd__data *data) {
  for (size_t i = 0; i < data->group_count; i++) {
    free(data->group[i].cell.results);
    free(data->group[i].who);
  }
  free(data->people);
  if (!data->borrowed) ethd__sheet_free(&data->sheet);
  data->people = NULL;
  data->group_count = 0;
}

size_t ethd__data_cells(const ethd__data *data, ethd__cell out[ETHD_REPORT_CELLS]) {
  for (size_t i = 0; i < data->group_count; i++) out[i] = data->group[i].cell;
  return data->group_count;
}
