#include <inttypes.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "cli/cli.h"
#include "study/dictionary.h"
#include "study/front.h"

/* ---- lines out ---- */

static void block(void *self, const char *participant, const ethd__turn *turn) {
  const ethd__console *c = self;
  if (c->quiet) return;
  printf("%s block %zu: %s %s, %s\n", participant, turn->number, c->protocol->strategies.word[turn->block.strategy],
         c->protocol->speeds.word[turn->block.speed], turn->block.training ? "training" : "test");
}

const char *ethd__advice(ethd__reason reason) {
  switch (reason) {
  case ETHD_TAP_OK: return "valid";
  case ETHD_TAP_FAULT: return "the device stopped itself";
  case ETHD_TAP_EARLY_CONTACT: return "touched the ring before the wall: keep the finger in the middle";
  case ETHD_TAP_TOO_SLOW: return "too slow";
  case ETHD_TAP_TOO_FAST: return "too fast";
  case ETHD_TAP_NO_CONTACT: return "no contact: go on until the wall is felt";
  case ETHD_TAP_GRAZING: return "only grazed: press for a moment";
  case ETHD_TAP_DOUBLE: return "tapped twice: once is enough";
  default: return "";
  }
}

static void verdict(void *self, const char *participant, const ethd__taken *taken, uint32_t valid, uint32_t wanted) {
  const ethd__console *c = self;
  const ethd__metrics *m = &taken->result.metrics;
  if (c->quiet) return;
  printf("%s tap %2" PRIu32 ": %s", participant, taken->turn.attempt, ethd__advice(m->reason));
  if (m->v_rvo == m->v_rvo)
    printf(" (%.3f m/s; %.3g to %.3g count)", m->v_rvo, taken->speed->centre - taken->speed->band,
           taken->speed->centre + taken->speed->band);
  if (wanted) printf(", %" PRIu32 " of %" PRIu32, valid, wanted);
  putchar('\n');
  fflush(stdout);
}

/* ---- lines in ---- */

/* Waits for a line only in a pause, or when asked for an answer. */
static bool read_line(ethd__console *c, bool wait, char *out, size_t room) {
  struct pollfd in = {.fd = STDIN_FILENO, .events = POLLIN};
  size_t n = 0;
  if (c->ended || poll(&in, 1, wait ? -1 : 0) <= 0) return false;
  for (char byte; read(STDIN_FILENO, &byte, 1) == 1;) {
    if (byte == '\n') return out[n] = 0, true;
    if (n + 1 < room) out[n++] = byte;
  }
  c->ended = true;
  out[n] = 0;
  return n > 0;
}

static ethd__wish command(ethd__console *c, const char *line, char words[ETHD_MESSAGE_MAX]) {
  if (!strncmp(line, "note ", 5)) {
    snprintf(words, ETHD_MESSAGE_MAX, "%.*s", ETHD_MESSAGE_MAX - 1, line + 5);
    return ETHD_WISH_NOTE;
  }
  if (!strcmp(line, "abort")) return ETHD_WISH_ABORT;
  if (!strcmp(line, "stop")) return ETHD_WISH_STOP;
  if (!strcmp(line, "go")) c->paused = false;
  if (!strcmp(line, "pause") && !c->paused) {
    c->paused = true;
    return ETHD_WISH_PAUSE;
  }
  if (strcmp(line, "go") && strcmp(line, "pause"))
    printf("found \"%.40s\"; note WORDS, pause, go, abort, stop are allowed\n", line);
  return ETHD_WISH_GO;
}

static ethd__wish wish(void *self, char words[ETHD_MESSAGE_MAX]) {
  ethd__console *c = self;
  char line[ETHD_MESSAGE_MAX];
  if (!c->ask) return ETHD_WISH_GO;
  while (read_line(c, c->paused, line, sizeof line)) {
    ethd__wish wanted = command(c, line, words);
    if (wanted != ETHD_WISH_GO) return wanted;
  }
  return c->paused ? ETHD_WISH_STOP : ETHD_WISH_GO;
}

static bool stopped(void *self, const char *why) {
  ethd__console *c = self;
  char line[ETHD_MESSAGE_MAX];
  if (!c->ask) return false;
  do {
    printf("the device stopped itself: %s; ack goes on, stop ends\n", why);
    fflush(stdout);
    if (!read_line(c, true, line, sizeof line) || !strcmp(line, "stop")) return false;
  } while (strcmp(line, "ack"));
  return true;
}

static bool ask(ethd__console *c, int question, int *answer) {
  char line[ETHD_MESSAGE_MAX];
  printf("%s\n", ethd__questions[question]);
  fflush(stdout);
  while (read_line(c, true, line, sizeof line)) {
    if (line[0] >= '1' && line[0] <= '5' && !line[1]) return *answer = line[0] - '0', true;
    if (!*line) return false;
    printf("found \"%.40s\"; 1 to 5, or an empty line for no answer\n", line);
    fflush(stdout);
  }
  return false;
}

static bool survey(void *self, const ethd__turn *turn, int answers[3]) {
  ethd__console *c = self;
  (void)turn;
  if (!c->ask) return false;
  for (int i = 0; i < 3; i++)
    if (!ask(c, i, &answers[i])) return false;
  return true;
}

ethd__front ethd__console_front(ethd__console *console) {
  return (ethd__front){console, block, verdict, wish, stopped, survey};
}
