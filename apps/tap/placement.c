#include "tap/placement.h"

#include <dirent.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "text/csv.h"
#include "text/error_text.h"
#include "text/file.h"
#include "text/text.h"

/* ---- reading ---- */

enum { T, X, Y, COLUMNS };

const ethd__movement_form ethd__movement_si = {.columns = {"t_s", "x_m", "y_m"}, .time = 1, .length = 1};

/* One column of the file: value = unit * cell. */
typedef struct source {
  const char *name;
  int column;
  double unit;
} source;

static ethd_status find(const char *path, const ethd_csv *csv, source from[COLUMNS], char *message) {
  for (int i = 0; i < COLUMNS; i++) {
    from[i].column = ethd_csv_column(csv, from[i].name);
    if (from[i].column < 0)
      return ethd__say(message, ETHD_E_UNKNOWN, "%s:1: no column %s; %s, %s and %s are needed", path, from[i].name,
                       from[T].name, from[X].name, from[Y].name);
  }
  if (csv->rows < 3)
    return ethd__say(message, ETHD_E_RANGE, "%s: %zu sample%s; at least 3 are needed", path, csv->rows,
                     ethd__s(csv->rows));
  return ETHD_OK;
}

static ethd_status check_row(const char *path, const ethd_csv *csv, const source from[COLUMNS], size_t row,
                             char *message) {
  size_t line = ethd_csv_line(row);
  for (int i = 0; i < COLUMNS; i++) {
    double cell = csv->values[row * csv->columns + (size_t)from[i].column], most = 1e3 / fabs(from[i].unit);
    if (!isfinite(cell))
      return ethd__say(message, ETHD_E_NOT_FINITE, "%s:%zu: %s: %s; a finite number is needed", path, line,
                       from[i].name, ethd_csv_empty(csv, row, from[i].column) ? "an empty cell" : "nan");
    if (i != T && !(fabs(cell) <= most))
      return ethd__say(message, ETHD_E_RANGE, "%s:%zu: %s: found %.10g, %.6g to %.6g is allowed", path, line,
                       from[i].name, cell, -most, most);
  }
  return ETHD_OK;
}

static ethd_status check_step(const char *path, const char *time, const ethd_path_sample *s, size_t line,
                              char *message) {
  double speed = hypot(s[0].x - s[-1].x, s[0].y - s[-1].y) / (s[0].t - s[-1].t);
  if (!(s[0].t > s[-1].t))
    return ethd__say(message, ETHD_E_RANGE, "%s:%zu: %s: found %.10g s after %.10g s; times must rise", path, line,
                     time, s[0].t, s[-1].t);
  if (!(s[0].t <= ETHD_MOVEMENT_MOST))
    return ethd__say(message, ETHD_E_RANGE,
                     "%s:%zu: %s: %.10g s after the start; at most %g are allowed. --units m,ms reads milliseconds",
                     path, line, time, s[0].t, ETHD_MOVEMENT_MOST);
  if (speed <= ETHD_MOVEMENT_FASTEST) return ETHD_OK;
  return ethd__say(message, ETHD_E_RANGE,
                   "%s:%zu: found a hand at %.3g m/s; at most %g are allowed. --units cm or mm reads other units", path,
                   line, speed, ETHD_MOVEMENT_FASTEST);
}

static ethd_status check_direction(const char *path, const ethd__movement *m, char *message) {
  double to = 0, away = 0;
  for (size_t k = 0; k < m->count; k++) {
    double v = ethd__movement_speed(m, k);
    to = fmax(to, v), away = fmax(away, -v);
  }
  if (!(to < away / 5)) return ETHD_OK;
  return ethd__say(message, ETHD_E_RANGE,
                   "%s: moves to +x (at up to %.3g m/s), away from the wall; --columns t_s,-x_m,-y_m turns it", path,
                   away);
}

static ethd_status convert(const char *path, const ethd_csv *csv, source from[COLUMNS], ethd__movement *out,
                           char *message) {
  ethd_status status = find(path, csv, from, message);
  for (size_t row = 0; !status && row < csv->rows; row++) status = check_row(path, csv, from, row, message);
  if (status) return status;
  out->samples = malloc(csv->rows * sizeof *out->samples);
  if (!out->samples) return ethd__no_memory(message, path);
  out->count = csv->rows;
  for (size_t row = 0; !status && row < csv->rows; row++) {
    const double *cell = &csv->values[row * csv->columns], *first = csv->values;
    out->samples[row] = (ethd_path_sample){from[T].unit * (cell[from[T].column] - first[from[T].column]),
                                           from[X].unit * cell[from[X].column], from[Y].unit * cell[from[Y].column]};
    if (row) status = check_step(path, from[T].name, &out->samples[row], ethd_csv_line(row), message);
  }
  return status ? status : check_direction(path, out, message);
}

ethd_status ethd__movement_load(const char *path, const ethd__movement_form *form, ethd__movement *out,
                                char message[ETHD_MESSAGE_MAX]) {
  source from[COLUMNS];
  const char *names[COLUMNS + 1] = {NULL};
  ethd_csv csv;
  *out = (ethd__movement){0};
  for (int i = 0; i < COLUMNS; i++) {
    bool turned = i != T && form->columns[i][0] == '-';
    from[i] = (source){form->columns[i] + turned, -1, i == T ? form->time : turned ? -form->length : form->length};
    names[i] = from[i].name;
  }
  ethd_status status = ethd_csv_read_columns(path, names, &csv, message);
  if (status) return status;
  status = convert(path, &csv, from, out, message);
  if (status) ethd__movement_free(out);
  ethd_csv_free(&csv);
  return status;
}

void ethd__movement_free(ethd__movement *movement) {
  free(movement->samples);
  *movement = (ethd__movement){0};
}

/* ---- where it touches ---- */

static bool within(double span) { return span <= ETHD_MOVEMENT_WINDOW + 1e-9; }

/* Slope = sum (t - t_mean)(x - x_mean) / sum (t - t_mean)^2. */
double ethd__movement_speed(const ethd__movement *movement, size_t k) {
  const ethd_path_sample *s = movement->samples;
  size_t a = k, b = k;
  while (a > 0 && (a == k || within(s[k].t - s[a - 1].t))) a--;
  while (b + 1 < movement->count && (b == k || within(s[b + 1].t - s[k].t))) b++;
  double t = 0, x = 0, tx = 0, tt = 0, n = (double)(b - a + 1);
  for (size_t i = a; i <= b; i++) t += (s[i].t - s[k].t) / n, x += (s[i].x - s[k].x) / n;
  for (size_t i = a; i <= b; i++) {
    double dt = s[i].t - s[k].t - t;
    tx += dt * (s[i].x - s[k].x - x);
    tt += dt * dt;
  }
  return -tx / tt;
}

static size_t peak_of(const ethd__movement *movement, double *speed) {
  size_t peak = 0;
  *speed = ethd__movement_speed(movement, 0);
  for (size_t k = 1; k < movement->count; k++) {
    double v = ethd__movement_speed(movement, k);
    if (v > *speed) *speed = v, peak = k;
  }
  return peak;
}

static double falls_to(const ethd__movement *movement, double speed, size_t peak, double before) {
  const ethd_path_sample *s = movement->samples;
  for (size_t k = peak + 1; k < movement->count; k++) {
    double v = ethd__movement_speed(movement, k);
    if (v <= speed) return s[k - 1].t + (before - speed) / (before - v) * (s[k].t - s[k - 1].t);
    before = v;
  }
  return s[movement->count - 1].t;
}

void ethd__movement_touchdown(const ethd__movement *movement, double speed, ethd__touchdown *out) {
  const ethd_path path = {.samples = movement->samples, .sample_count = movement->count};
  double highest;
  ethd_vec v;
  size_t peak = peak_of(movement, &highest);
  out->never_fast = !(highest >= speed);
  out->t = out->never_fast ? movement->samples[peak].t : falls_to(movement, speed, peak, highest);
  ethd_path_at(&path, out->t, &out->x, &v);
}

/* ---- placing ---- */

static bool reachable(const ethd_arm *arm, ethd_vec x) {
  double inner, outer, r = ethd_vec_norm(x);
  ethd_arm_reach(arm, &inner, &outer);
  return r > inner && r < outer;
}

size_t ethd__movement_place(const ethd__movement *movement, const ethd__touchdown *touchdown, ethd_vec centre,
                            const ethd_arm *arm, ethd_path_sample *out) {
  const ethd_path_sample *s = movement->samples;
  ethd_vec shift = ethd_vec_sub(centre, touchdown->x);
  size_t begin = 0, count = 0;
  if (!reachable(arm, centre)) return 0;
  for (size_t k = 0; k < movement->count; k++) {
    ethd_vec x = {s[k].x + shift.x, s[k].y + shift.y};
    if (reachable(arm, x)) {
      if (!count) begin = k;
      out[count++] = (ethd_path_sample){s[k].t - s[begin].t, x.x, x.y};
    } else if (s[k].t > touchdown->t) {
      break;
    } else {
      count = 0;
    }
  }
  return count;
}

/* ---- files ---- */

static int is_csv(const struct dirent *entry) {
  size_t n = strlen(entry->d_name);
  return n > 4 && entry->d_name[0] != '.' && !strcmp(entry->d_name + n - 4, ".csv");
}

ethd_status ethd__movements_in(const char *folder, char ***files, size_t *count, char message[ETHD_MESSAGE_MAX]) {
  struct dirent **entries = NULL;
  *count = 0;
  int fd = ethd__file_open(folder, O_RDONLY | O_DIRECTORY, 0);
  int n = fd < 0 ? -1 : scandirat(fd, ".", &entries, is_csv, alphasort);
  bool failed = n < 0;
  if (fd >= 0) close(fd);
  *files = calloc(n > 0 ? (size_t)n : 1, sizeof **files);
  for (int i = 0; i < n; i++) {
    char *path = *files ? ethd__path_join(folder, entries[i]->d_name) : NULL;
    if (path) (*files)[(*count)++] = path;
    failed |= !path;
    free(entries[i]);
  }
  free(entries);
  if (!failed && n > 0) return ETHD_OK;
  return ethd__say(message, ETHD_E_FILE,
                   "%s: no folder with recorded movements (*.csv); ETHD_MOTION_DIR may name the one it is in", folder);
}

ethd_status ethd__movements_list(const char *path, char ***files, size_t *count, char message[ETHD_MESSAGE_MAX]) {
  struct stat what;
  *count = 0;
  *files = NULL;
  if (!ethd__file_look(path, &what) && S_ISDIR(what.st_mode)) return ethd__movements_in(path, files, count, message);
  *files = calloc(1, sizeof **files);
  char *copy = *files ? strdup(path) : NULL;
  if (copy) (*files)[(*count)++] = copy;
  return copy ? ETHD_OK : ethd__no_memory(message, path);
}

void ethd__movements_free(char **files, size_t count) {
  for (size_t i = 0; i < count; i++) free(files[i]);
  free(files);
}
