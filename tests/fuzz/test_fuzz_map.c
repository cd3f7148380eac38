/* Register maps under mutation: ETHD_FUZZ_RUNS executions (default 20 000) from number ETHD_FUZZ_FROM on, after the
   corpus in tests/fuzz/map. A text is refused in one line that names it, or is a map that can be used: laid out,
   packed, within its limits. */
#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "servo/plan.h"
#include "servo/words.h"
#include "unit/mutate.h"

enum { SEEDS_MAX = 64, ROOM = 8192, LONGEST = 4096 };

static struct {
  char text[LONGEST];
  size_t size;
} seeds[SEEDS_MAX];
static uint32_t seed_count;
static ethd__servo_map map;
static ethd__servo_plan plan;
static uint64_t maps;

static int fail(const char *what, const char *text, size_t size) {
  printf("%s:\n%.*s\n", what, (int)size, text);
  return 1;
}

/* Every torque goes out within its limits, every cyclic register has its words. */
static int use(void) {
  ethd__servo_plan_make(&map, &plan);
  for (uint32_t i = 0; i < map.count; i++) {
    const ethd__servo_register *r = &map.registers[i];
    if (!r->cyclic) continue;
    if (plan.block[i] < 0) return 0;
    uint16_t *words = ethd__servo_plan_words(&plan, &map, (int32_t)i);
    if (r->role != ETHD__SERVO_TORQUE1 && r->role != ETHD__SERVO_TORQUE2) {
      (void)ethd__servo_joint(r, ethd__servo_unpack(r, words));
      continue;
    }
    for (double torque = -10; torque <= 10; torque += 10) {
      ethd__servo_pack(r, ethd__servo_raw(r, torque), words);
      double value = r->scale * ethd__servo_unpack(r, words) + r->offset, some = 1e-6 * (fabs(r->min) + fabs(r->max));
      if (!(value >= r->min - some && value <= r->max + some)) return 0;
    }
  }
  for (uint32_t i = 0; ethd__servo_risk(&map, i); i++) continue;
  return 1;
}

static int run(const char *text, size_t size) {
  char message[ETHD_MESSAGE_MAX] = "";
  ethd_status status = ethd__servo_map_parse(text, size, "m", &map, message);
  maps += status == ETHD_OK;
  if (status == ETHD_OK) return use() ? 0 : fail("a map that can't be used", text, size);
  if (status > 0 || message[0] != 'm' || message[1] != ':' || strchr(message, '\n')) return fail(message, text, size);
  return 0;
}

/* One key's value changed, or a few: more texts stay maps than under blind mutation. */
static size_t retouch(const char *seed, size_t size, uint64_t i, char *out) {
  static const char *const values[] = {
      "0",     "1",   "-1",        "2",       "65535", "0xFFFF",   "1e-9",   "-1e12",        "1e9",     "0.1",
      "i16",   "u16", "u32",       "f32",     "A",     "Nm",       "count",  "rad",          "input",   "read",
      "write", "rtu", "low-first", "silence", "yes",   "combined", "values", "wait s 1 1 1", "pause 1", "write c 65535",
      "17",    "32",  "torque1"};
  memcpy(out, seed, size);
  for (uint64_t k = 0; k < 1 + draw_bits(i) % 2; k++) {
    uint64_t r = draw_bits(i * 8 + k + 1);
    char *equals = memchr(out + r % size, '=', size - r % size);
    if (!equals) continue;
    char *end = memchr(equals, '\n', size - (size_t)(equals - out));
    const char *value = values[(r >> 32) % (sizeof values / sizeof *values)];
    size_t length = strlen(value), rest = end ? size - (size_t)(end - out) : 0;
    memmove(equals + 1 + length, out + size - rest, rest);
    memcpy(equals + 1, value, length);
    size = (size_t)(equals - out) + 1 + length + rest;
  }
  return size;
}

static int is_seed(const struct dirent *entry) { return entry->d_name[0] != '.'; }

static int load(const char *folder) {
  struct dirent **entries;
  int n = scandir(folder, &entries, is_seed, alphasort);
  for (int i = 0; i < n && seed_count < SEEDS_MAX; free(entries[i++])) {
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, entries[i]->d_name);
    FILE *file = fopen(path, "rb");
    if (!file) return printf("%s: can't be read\n", path), 1;
    seeds[seed_count].size = fread(seeds[seed_count].text, 1, LONGEST, file);
    seed_count++;
    fclose(file);
  }
  if (n <= 0) return printf("%s: no corpus\n", folder), 1;
  free(entries);
  return 0;
}

static uint64_t number(const char *name, uint64_t without) {
  const char *given = getenv(name);
  return given ? strtoull(given, NULL, 10) : without;
}

int main(void) {
  static const char *const words[] = {"\n[register torque1]\n",
                                      "[register measured2]",
                                      "\n",
                                      "=",
                                      "0x",
                                      "echo=e\n",
                                      "step1=",
                                      "wait s 1 1 1\n",
                                      "1e999",
                                      "-0.0",
                                      "type=f32\n",
                                      "order=low-first\n",
                                      "[",
                                      "]",
                                      "min=-1e300\n",
                                      "max=",
                                      "nan",
                                      "65536",
                                      "direction=write\n",
                                      "unit=A\n",
                                      "; c",
                                      "0",
                                      "1e12",
                                      "scale=1e-9\n",
                                      NULL};
  static char text[ROOM];
  uint64_t runs = number("ETHD_FUZZ_RUNS", 20000), from = number("ETHD_FUZZ_FROM", 0);
  if (load("tests/fuzz/map")) return 1;
  for (uint32_t s = 0; s < seed_count; s++)
    if (run(seeds[s].text, seeds[s].size)) return 1;
  if (maps < 6) return printf("only %llu of the corpus are maps\n", (unsigned long long)maps), 1;
  for (uint64_t i = from; i < from + runs; i++) {
    uint32_t s = (uint32_t)(draw_bits(~i) % seed_count);
    size_t size = i % 2 ? mutate(seeds[s].text, seeds[s].size, words, i, text, sizeof text)
                        : retouch(seeds[s].text, seeds[s].size, i, text);
    if (run(text, size)) return printf("run %llu\n", (unsigned long long)i), 1;
  }
  printf("%llu runs from %u seeds, %llu were maps\n", (unsigned long long)runs, seed_count, (unsigned long long)maps);
  return 0;
}
