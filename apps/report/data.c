#include "report/data.h"

#include <math.h>
#include <search.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "study/protocol.h"
#include "text/error_text.h"
#include "text/file_name.h"

/* ---- taking ---- */

/* The table must have these columns. */
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
    METRIC("v_hand_mps", v_hand), /* a table may lack the columns from here on */
    METRIC("touch_depth_m", touch_depth),
    METRIC("eps_felt_m", eps_felt),
};
enum { FIGURES = sizeof figures / sizeof *figures, NEEDED = FIGURES - 3 };

typedef struct taking {
  ethd__data *out;
  const ethd_plant *plant;
  size_t point;
  int word[WORDS], figure[FIGURES], participant, part, at_point, by_ring, by_finger;
  void *ids; /* a tree of participants */
  char *message;
} taking;

static ethd_status refuse(const taking *r, size_t row, const char *column, const char *found, const char *allowed) {
  char quote[ETHD_QUOTE_MAX];
  return ethd__say(r->message, ETHD_E_RANGE, "%s:%zu: %s: found %s, %s is allowed", r->out->sheet.path, row + 2, column,
                   ethd__quote(found, strlen(found), quote), allowed);
}

static ethd_status find_columns(taking *r) {
  const ethd__sheet *sheet = &r->out->sheet;
  const char *missing = NULL;
  for (int i = 0; i < WORDS; i++)
    if ((r->word[i] = ethd__sheet_column(sheet, word_names[i])) < 0) missing = word_names[i];
  for (int i = 0; i < FIGURES; i++)
    if ((r->figure[i] = ethd__sheet_column(sheet, figures[i].name)) < 0 && i < NEEDED) missing = figures[i].name;
  r->participant = ethd__sheet_column(sheet, "participant");
  r->part = ethd__sheet_column(sheet, "part");
  r->at_point = ethd__sheet_column(sheet, "point");
  r->by_ring = ethd__sheet_column(sheet, "by_ring");
  r->by_finger = ethd__sheet_column(sheet, "by_finger");
  if (r->participant < 0) missing = "participant";
  if (!missing) return ETHD_OK;
  return ethd__say(r->message, ETHD_E_UNKNOWN, "%s:1: no column %s; a taps.csv of ethd-study has it", sheet->path,
                   missing);
}

static ethd__group *group_of(taking *r, size_t row) {
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

/* An empty cell of a table of an earlier version is no reason: ETHD_TAP_REASON_COUNT. */
static ethd_status read_reason(const taking *r, size_t row, int column, ethd__reason *out) {
  const char *reason = ethd__sheet_cell(&r->out->sheet, row, column);
  int index = 0;
  while (index < ETHD_TAP_REASON_COUNT && strcmp(reason, ethd__reason_words[index])) index++;
  *out = (ethd__reason)index;
  if (index < ETHD_TAP_REASON_COUNT || (!*reason && column != r->word[REASON])) return ETHD_OK;
  return refuse(r, row, r->out->sheet.cell[column], reason, "ok, early-contact and the like");
}

static ethd_status read_result(const taking *r, size_t row, ethd__result *out) {
  const ethd__sheet *sheet = &r->out->sheet;
  *out = (ethd__result){0};
  ethd_status status = read_reason(r, row, r->word[REASON], &out->metrics.reason);
  if (!status) status = read_reason(r, row, r->by_ring, &out->metrics.by_ring);
  if (!status) status = read_reason(r, row, r->by_finger, &out->metrics.by_finger);
  if (status) return status;
  for (int i = 0; i < FIGURES; i++)
    if (!ethd__sheet_number(sheet, row, r->figure[i], (double *)((char *)out + figures[i].offset)))
      return refuse(r, row, figures[i].name, ethd__sheet_cell(sheet, row, r->figure[i]), "a number");
  return ETHD_OK;
}

static int by_id(const void *a, const void *b) { return strcmp(*(const char *const *)a, *(const char *const *)b); }

/* The tree's entries are places in data->people. False: no memory. */
static bool find_person(taking *r, size_t row, uint32_t *out) {
  ethd__data *data = r->out;
  const char **next = &data->people[data->people_count];
  *next = ethd__sheet_cell(&data->sheet, row, r->participant);
  const char ***found = tsearch(next, &r->ids, by_id);
  if (!found) return false;
  *out = (uint32_t)(*found - data->people);
  data->people_count += *found == next;
  return true;
}

static void keep(void *place) { (void)place; }

static bool grow(ethd__group *group) {
  size_t n = group->cell.count;
  if (n & (n - 1)) return true; /* room doubles at powers of two */
  size_t room = n ? 2 * n : 1;
  ethd__result *results = realloc(group->cell.results, room * sizeof *results);
  if (results) group->cell.results = results;
  uint32_t *person = realloc(group->cell.person, room * sizeof *person);
  if (person) group->cell.person = person;
  size_t *row = realloc(group->row, room * sizeof *row);
  if (row) group->row = row;
  return results && person && row;
}

/* Checks the words of the table that are used in names of files. */
static ethd_status check_words(const taking *r, size_t row) {
  static const struct {
    const char *name;
    size_t column;
  } words[] = {{"participant", offsetof(taking, participant)},
               {"transition", offsetof(taking, word[TRANSITION])},
               {"speed", offsetof(taking, word[SPEED])}};
  for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
    const char *word = ethd__sheet_cell(&r->out->sheet, row, *(const int *)((const char *)r + words[i].column));
    if (!ethd__file_word(word) || strchr("+-", *word)) return refuse(r, row, words[i].name, word, ETHD_FILE_WORD);
  }
  return ETHD_OK;
}

static ethd_status no_memory(const taking *r) { return ethd__no_memory(r->message, r->out->sheet.path); }
static ethd_status take(taking *r, size_t row) {
  const ethd__sheet *sheet = &r->out->sheet;
  ethd_status status = check_words(r, row);
  if (status) return status;
  bool training = !strcmp(ethd__sheet_cell(sheet, row, r->part), "training");
  r->out->training += training;
  if (training) return ETHD_OK;
  if (ethd__is_absent(&r->out->absent, ethd__sheet_cell(sheet, row, r->participant))) {
    r->out->left_out++;
    return ETHD_OK;
  }
  ethd__group *group = group_of(r, row);
  if (!group)
    return refuse(r, row, "speed", ethd__sheet_cell(sheet, row, r->word[SPEED]), "low, high or a number, in 64 cells,");
  if (!grow(group)) return no_memory(r);
  status = read_result(r, row, &group->cell.results[group->cell.count]);
  if (status) return status;
  size_t index = group->cell.count++;
  group->row[index] = row;
  return find_person(r, row, &group->cell.person[index]) ? ETHD_OK : no_memory(r);
}

/* ---- points of a grid ---- */

static ethd_status point_of(const taking *r, size_t row, size_t *out) {
  double point = 0;
  if (r->at_point >= 0 &&
      (!ethd__sheet_number(&r->out->sheet, row, r->at_point, &point) || !(point >= 0 && point <= ETHD_STUDY_POINTS)))
    return refuse(r, row, "point", ethd__sheet_cell(&r->out->sheet, row, r->at_point), "a point of the grid");
  *out = (size_t)point;
  return ETHD_OK;
}

/* Sorts the rows by their points, so that each point reads only its own. */
static ethd_status index_points(const taking *r) {
  ethd__data *data = r->out;
  size_t rows = data->sheet.rows, *point = malloc((rows + 1) * sizeof *point);
  ethd_status status = ETHD_OK;
  data->points = 1;
  data->row = malloc((rows + 1) * sizeof *data->row);
  for (size_t i = 0; point && !status && i < rows; i++) {
    status = point_of(r, i, &point[i]);
    if (!status && point[i] >= data->points) data->points = point[i] + 1;
  }
  data->first = calloc(data->points + 2, sizeof *data->first);
  if (!status && (!point || !data->row || !data->first)) status = no_memory(r);
  if (!status) { /* here first[p + 1] moves from the beginning of p to its end */
    for (size_t i = 0; i < rows; i++) data->first[point[i] + 2]++;
    for (size_t p = 2; p < data->points + 2; p++) data->first[p] += data->first[p - 1];
    for (size_t i = 0; i < rows; i++) data->row[data->first[point[i] + 1]++] = i;
  }
  free(point);
  return status;
}

/* Speeds are sorted from low to high; strategies from the one that brakes least, others by name. */
static int by_speed(const void *a, const void *b) {
  static const char *const order[] = {"abrupt", "smooth", "offset"};
  const ethd__group *p = a, *q = b;
  if (p->speed.centre != q->speed.centre) return p->speed.centre < q->speed.centre ? -1 : 1;
  int i = 0, j = 0;
  while (i < 3 && strcmp(p->cell.law, order[i])) i++;
  while (j < 3 && strcmp(q->cell.law, order[j])) j++;
  return i != j ? i - j : strcmp(p->cell.law, q->cell.law);
}

/* out->sheet and its points are there. */
static ethd_status take_all(taking *r) {
  ethd__data *out = r->out;
  size_t at = r->point < out->points ? out->first[r->point] : 0;
  size_t end = r->point < out->points ? out->first[r->point + 1] : 0;
  out->people = calloc(end - at + 1, sizeof *out->people);
  ethd_status status = out->people ? ETHD_OK : no_memory(r);
  for (; !status && at < end; at++) status = take(r, out->row[at]);
  tdestroy(r->ids, keep);
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

ethd_status ethd__data_of(ethd__sheet *sheet, const ethd__sheet *participants, const ethd_plant *plant, size_t point,
                          ethd__data *out, char message[ETHD_MESSAGE_MAX]) {
  taking r = {.out = out, .plant = plant, .point = point, .message = message};
  memset(out, 0, sizeof *out);
  out->sheet = *sheet;
  *sheet = (ethd__sheet){0};
  ethd_status status = find_columns(&r);
  if (!status) status = index_points(&r);
  if (!status && participants && participants->columns) status = ethd__absent_of(participants, &out->absent, message);
  if (status) ethd__data_free(out);
  return status ? status : take_all(&r);
}

ethd_status ethd__data_read(const char *path, const ethd_plant *plant, size_t point, ethd__data *out,
                            char message[ETHD_MESSAGE_MAX]) {
  ethd__sheet sheet;
  memset(out, 0, sizeof *out);
  ethd_status status = ethd__sheet_read(path, &sheet, message);
  return status ? status : ethd__data_of(&sheet, NULL, plant, point, out, message);
}

ethd_status ethd__data_at(const ethd__data *whole, const ethd_plant *plant, size_t point, ethd__data *out,
                          char message[ETHD_MESSAGE_MAX]) {
  taking r = {.out = out, .plant = plant, .point = point, .message = message};
  *out = (ethd__data){.sheet = whole->sheet,
                      .row = whole->row,
                      .first = whole->first,
                      .points = whole->points,
                      .absent = whole->absent,
                      .borrowed = true};
  ethd_status status = find_columns(&r);
  return status ? status : take_all(&r);
}

void ethd__data_free(ethd__data *data) {
  for (size_t i = 0; i < data->group_count; i++) {
    free(data->group[i].cell.results);
    free(data->group[i].cell.person);
    free(data->group[i].row);
  }
  free(data->people);
  if (!data->borrowed) {
    ethd__sheet_free(&data->sheet);
    free(data->row);
    free(data->first);
    ethd__absent_free(&data->absent);
  }
  data->people = NULL;
  data->row = data->first = NULL;
  data->group_count = 0;
}

size_t ethd__data_cells(const ethd__data *data, ethd__cell out[ETHD_REPORT_CELLS]) {
  for (size_t i = 0; i < data->group_count; i++) out[i] = data->group[i].cell;
  return data->group_count;
}
