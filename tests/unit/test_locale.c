/* Text is the same in every locale, rounding and set of traps of the thread, which has them back. Run by tests/locale.sh in
   hosts with a decimal comma, too. */
#include <errno.h>
#include <fenv.h>
#include <math.h>

#include "ethd/ethd.h"
#include "text/csv.h"
#include "text/error_text.h"
#include "text/text.h"
#include "unit/suite.h"

static const char *const words[] = {"0.1", "0.3", "-0.7", "1e23", "4.9e-324", "1.7976931348623157e308"};
#define WORDS (sizeof words / sizeof *words)

/* All that text says of the words: numbers that were read, by bits, then text that was written. */
static void work(char out[2048]) {
  char message[ETHD_MESSAGE_MAX], scene_text[64];
  size_t n = 0;
  for (size_t i = 0; i < WORDS; i++) {
    double v = 0;
    ethd_scene *scene = NULL;
    bool good = ethd__number(words[i], strlen(words[i]), &v);
    uint64_t bits, parsed = 0;
    memcpy(&bits, &v, sizeof bits);
    snprintf(scene_text, sizeof scene_text, "material m k=%s\ncircle 0 0 1 material=m", words[i]);
    if (!ethd_scene_parse(scene_text, strlen(scene_text), &scene, NULL))
      memcpy(&parsed, &ethd_scene_material(scene, 0)->values[0].value, sizeof parsed);
    ethd_scene_destroy(scene);
    ethd_error error = {ETHD_E_RANGE, 3, "x", v, -v, 2 / 3.};
    ethd_error_text("f", &error, message);
    n += (size_t)snprintf(out + n, 2048 - n, "%d %llx %llx %.17g %.3f %s\n", good, (unsigned long long)bits,
                          (unsigned long long)parsed, v, 2.0004, message);
  }
}

TEST(test_rounding) {
  static const int modes[] = {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};
  char expected[2048], found[2048];
  work(expected);
  ck_assert_msg(strstr(expected, "1 3fb999999999999a 3fb999999999999a 0.10000000000000001 2.000 f:3: x: ") == expected,
                "%s", expected);
  for (int i = 0; i < 3; i++) {
    fesetround(modes[i]);
    work(found);
    int after = fegetround();
    fesetround(FE_TONEAREST);
    ck_assert_int_eq(after, modes[i]);
    ck_assert_str_eq(found, expected);
  }
}

TEST(test_traps) {
  const int traps = FE_OVERFLOW | FE_UNDERFLOW | FE_INEXACT | FE_INVALID | FE_DIVBYZERO;
  double v;
  char text[32];
  feenableexcept(traps);
  bool good = ethd__number("1e999", 5, &v) || !ethd__number("1e-320", 6, &v);
  snprintf(text, sizeof text, "%.3g", v);
  int after = fedisableexcept(traps);
  ck_assert(!good);
  ck_assert_int_eq(after, traps);
  ck_assert_str_eq(text, "1e-320");
}

TEST(test_thread_locale) {
  locale_t own = newlocale(LC_ALL_MASK, "", (locale_t)0), before = uselocale(own);
  double v;
  char text[32];
  ck_assert(ethd__number("777.25", 6, &v) && v == 777.25);
  ck_assert(ethd__number("INF", 3, &v) && v == INFINITY);
  snprintf(text, sizeof text, "%g %s", 0.5, strerror(ENOENT));
  ck_assert_str_eq(text, "0.5 No such file or directory");
  ck_assert(uselocale((locale_t)0) == own);
  uselocale(before);
  freelocale(own);
}
