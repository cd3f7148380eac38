/* Readers of files that somebody sent: is their time linear in the file? Texts of 1, 8 and 64 times as many rows;
   beside the SVG reader expat, which only takes the XML apart, and beside the tables strtod, which only reads their
   numbers. */
#include <expat.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bench/bench.h"
#include "cli/cli.h"
#include "ethd/scene.h"
#include "report/data.h"
#include "svg/svg.h"
#include "text/csv.h"
#include "text/text.h"

enum { FILE_SIZES = 3, LEAST_ROWS = 500, PEOPLE_TAPS = 4 };

#define GROWTH 4.0 /* of the time a byte, for caches and a tree's depth; a quadratic reader's would be 64 */

static void check(ethd_status status, const char *message) {
  if (status < 0) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
}

/* ---- texts ---- */

static void write_circles(FILE *out, int rows) {
  fputs("<svg xmlns='http://www.w3.org/2000/svg' width='9000mm' height='9000mm'>\n", out);
  for (int i = 0; i < rows; i++) fprintf(out, "<circle cx='%d.25' cy='%d.5' r='0.25'/>\n", i % 997, i / 997);
  fputs("</svg>\n", out);
}

/* One path: the numbers of a single attribute. */
static void write_path(FILE *out, int rows) {
  fputs("<svg xmlns='http://www.w3.org/2000/svg' width='9000mm' height='9000mm'>\n<path fill='none' stroke='black' "
        "d='M 0,0",
        out);
  for (int i = 1; i <= rows; i++) fprintf(out, " L %d.125,%d.75", i % 997, i % 2 + i / 997);
  fputs("'/>\n</svg>\n", out);
}

static void write_scene(FILE *out, int rows) {
  for (int i = 0; i < rows; i++) fprintf(out, "circle %d.5 %d 0.25 # %d\n", i % 997, i / 997, i);
}

static void write_motion(FILE *out, int rows) {
  fputs("t_s,x_m,y_m\n", out);
  for (int i = 0; i < rows; i++) fprintf(out, "%d.001,0.%d,-1e-%d\n", i, i, i % 99);
}

/* taps.csv of a study in which each person has some taps. */
static void write_taps(FILE *out, int rows) {
  fputs("point,participant,part,transition,speed,valid,reason,v_rvo_mps,v_of_mps,d_max_m,v_rmin_mps,delta_s_ms,eps_m,t_"
        "rvo_s,"
        "t_of_s,t_seen_s,peak_force_n,finger_radius_m,commanded_mps\n",
        out);
  for (int i = 0; i < rows; i++)
    fprintf(out, "0,P%06d,test,%s,low,1,ok,0.2,0.1,0.001,-0.1,5,0.001,0.1,0.2,0.2,20,0.007,0.2\n", i / PEOPLE_TAPS,
            i % 2 ? "offset" : "smooth");
}

/* ---- readers ---- */

typedef struct sent_file {
  char *text;
  size_t length;
  char path[64]; /* of a copy on disk, for the reader that opens a file */
} sent_file;

static void read_svg(void *data) {
  const sent_file *f = data;
  const ethd_svg_options options = {1e-4, (double)NAN, {0, 0}};
  char message[ETHD_MESSAGE_MAX] = "";
  ethd_svg_notes notes;
  ethd_scene *scene;
  check(ethd_svg_parse(f->text, f->length, "drawing", &options, &scene, &notes, message), message);
  ethd_scene_destroy(scene);
}

static void read_scene(void *data) {
  const sent_file *f = data;
  ethd_scene *scene;
  check(ethd_scene_parse(f->text, f->length, &scene, NULL), "the scene isn't taken");
  ethd_scene_destroy(scene);
}

static void read_motion(void *data) {
  const sent_file *f = data;
  char message[ETHD_MESSAGE_MAX] = "";
  ethd_csv csv;
  check(ethd_csv_parse(f->text, f->length, "motion", NULL, &csv, message), message);
  ethd_csv_free(&csv);
}

static void read_taps(void *data) {
  const ethd_plant plant = {.speed_low = 0.2, .speed_high = 0.4, .band_low = 0.06, .band_high = 0.08};
  const sent_file *f = data;
  char message[ETHD_MESSAGE_MAX] = "";
  ethd__data taps;
  check(ethd__data_read(f->path, &plant, 0, &taps, message), message);
  ethd__data_free(&taps);
}

static void take_apart(void *data) {
  const sent_file *f = data;
  XML_Parser parser = XML_ParserCreate(NULL);
  if (!parser) ethd__fail_memory();
  if (XML_Parse(parser, f->text, (int)f->length, 1) != XML_STATUS_OK)
    ethd__fail(ETHD_EXIT_FAILED, "expat refuses the drawing");
  XML_ParserFree(parser);
}

static void read_numbers(void *data) {
  const sent_file *f = data;
  double sum = 0;
  for (const char *at = f->text; *at;) {
    char *end;
    sum += strtod(at, &end);
    at = end > at ? end : at + 1;
  }
  ethd__bench_sink = sum;
}

static const struct {
  const char *name;
  void (*write)(FILE *out, int rows);
  void (*read)(void *data);
  const char *peer;
  void (*least)(void *data); /* the peer's */
} readers[] = {
    {"SVG circles", write_circles, read_svg, "expat", take_apart},
    {"SVG path", write_path, read_svg, "expat", take_apart},
    {"scene", write_scene, read_scene, "strtod", read_numbers},
    {"motion CSV", write_motion, read_motion, "strtod", read_numbers},
    {"taps of a report", write_taps, read_taps, "strtod", read_numbers},
};

/* ---- all ---- */

static void open_file(sent_file *f, size_t reader, int rows) {
  FILE *out = open_memstream(&f->text, &f->length);
  if (!out) ethd__fail_memory();
  readers[reader].write(out, rows);
  if (fclose(out)) ethd__fail_memory();
  strcpy(f->path, "/tmp/ethd-bench-XXXXXX");
  int fd = mkstemp(f->path);
  FILE *copy = fd < 0 ? NULL : fdopen(fd, "w");
  if (!copy || fwrite(f->text, 1, f->length, copy) != f->length || fclose(copy))
    unlink(f->path), ethd__fail(ETHD_EXIT_FAILED, "%s can't be written", f->path);
}

static void close_file(sent_file *f) {
  unlink(f->path);
  free(f->text);
}

/* Returns ns a byte, of the reader and of its peer. */
static void time_reader(size_t reader, int rows, double seconds, double ns[2], size_t *bytes) {
  sent_file f;
  open_file(&f, reader, rows);
  ethd__bench_entry both[2] = {{"", readers[reader].read, &f, (double)f.length, 0},
                               {"", readers[reader].least, &f, (double)f.length, 0}};
  ethd__bench_race(both, 2, seconds);
  for (int i = 0; i < 2; i++) ns[i] = both[i].ns;
  *bytes = f.length;
  close_file(&f);
}

static int run(const char *folder, int quick) {
  FILE *csv = ethd__bench_csv(folder, "readers", "# time of reading a text of so many rows, ns a byte\n",
                              "reader,rows,bytes,who,ns_per_byte");
  printf("readers of files that somebody sent: ns a byte, 1, 8 and 64 times as many rows\n");
  printf("  %-18s %8s %8s %8s   %s\n", "", "1", "8", "64", "peer, at 64");
  for (size_t r = 0; r < sizeof readers / sizeof *readers; r++) {
    double ns[FILE_SIZES][2];
    for (int k = 0, rows = LEAST_ROWS; k < FILE_SIZES; k++, rows *= 8) {
      size_t bytes;
      time_reader(r, rows, quick ? 1e-3 : 4e-3, ns[k], &bytes); /* 5 and 20 turns */
      for (int who = 0; who < 2; who++)
        fprintf(csv, "%s,%d,%zu,%s,%.17g\n", readers[r].name, rows, bytes, who ? readers[r].peer : "libethd",
                ns[k][who]);
    }
    printf("  %-18s %8.2f %8.2f %8.2f   %s %.2f, times %.1f\n", readers[r].name, ns[0][0], ns[1][0], ns[2][0],
           readers[r].peer, ns[2][1], ns[2][0] / ns[2][1]);
    double growth = ns[2][0] / ns[0][0];
    printf("  goal: %-18s 64 times as many rows, ns a byte <= %g times: %.2f, %s\n", readers[r].name, GROWTH, growth,
           ethd__bench_verdict(growth <= GROWTH));
  }
  return ethd__bench_close();
}

const ethd__bench ethd__bench_readers = {"readers", "readers of files: is their time linear in the file?", run};
