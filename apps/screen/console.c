#include "screen/console.h"

#include <inttypes.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "cli/cli.h"
#include "cli/terminal.h"
#include "study/progress.h"

#define LOOK 100 /* ms between two checks of a terminal in whose background this may be */

/* ---- lines out ---- */

static void block(void *self, const char *participant, const ethd__turn *turn, bool rest) {
  const ethd__console *c = self;
  if (c->quiet) return;
  if (rest && c->ask) printf("time for a rest: pause begins one, go ends it\n");
  printf("%s block %zu of %zu: %s %s, %s\n", participant, turn->number, turn->of,
         c->protocol->strategies.word[turn->block.strategy], c->protocol->speeds.word[turn->block.speed],
         turn->block.training ? "training" : "test");
}

ethd__phrase_name ethd__advice(ethd__reason reason) {
  static const ethd__phrase_name advice[ETHD_TAP_REASON_COUNT] = {[ETHD_TAP_OK] = ETHD_PHRASE_VALID,
                                                                  [ETHD_TAP_FAULT] = ETHD_PHRASE_FAULT,
                                                                  [ETHD_TAP_EARLY_CONTACT] = ETHD_PHRASE_EARLY_CONTACT,
                                                                  [ETHD_TAP_TOO_SLOW] = ETHD_PHRASE_TOO_SLOW,
                                                                  [ETHD_TAP_TOO_FAST] = ETHD_PHRASE_TOO_FAST,
                                                                  [ETHD_TAP_NO_CONTACT] = ETHD_PHRASE_NO_CONTACT,
                                                                  [ETHD_TAP_GRAZING] = ETHD_PHRASE_GRAZING,
                                                                  [ETHD_TAP_DOUBLE] = ETHD_PHRASE_DOUBLE};
  return advice[reason];
}

ethd__phrase_name ethd__advised(ethd__reason reason, const char *checked) {
  if (!checked) return ethd__advice(reason);
  return strcmp(checked, "reject") ? ETHD_PHRASE_ACCEPTED : ETHD_PHRASE_REJECTED;
}

static void verdict(void *self, const char *participant, const ethd__taken *taken, const ethd__tally *tally) {
  ethd__console *c = self;
  const ethd__metrics *m = &taken->result.metrics;
  c->good = m->reason == ETHD_TAP_OK;
  if (c->quiet) return;
  printf("%s tap %2" PRIu32 ": %s", participant, taken->turn.attempt,
         ethd__phrases[ethd__advised(m->reason, tally->checked)].words);
  if (m->v_rvo == m->v_rvo)
    printf(" (%.3f m/s; %.3g to %.3g count)", m->v_rvo, taken->speed->centre - taken->speed->band,
           taken->speed->centre + taken->speed->band);
  if (tally->wanted) printf(", %" PRIu32 " of %" PRIu32, tally->valid, tally->wanted);
  if (tally->accepted + tally->rejected)
    printf("; accepted: %" PRIu32 ", rejected: %" PRIu32, tally->accepted, tally->rejected);
  putchar('\n');
  fflush(stdout);
}

/* ---- lines in ---- */

/* Returns whether stdin has input for us; false while the program is in the background of its terminal. */
static bool is_there(bool wait) {
  struct pollfd in = {.fd = STDIN_FILENO, .events = POLLIN};
  int ready;
  do ready = poll(&in, ethd__stdin_is_ours(), wait ? LOOK : 0);
  while (wait && ready == 0 && !ethd__stop);
  return ready > 0;
}

/* Reads a line if there is one; waits for it only during a pause or after a question. */
static bool read_line(ethd__console *c, bool wait, char *out, size_t room) {
  size_t n = 0;
  if (c->ended || !is_there(wait)) return false;
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
  bool accept = !strncmp(line, "accept ", 7), reject = !strncmp(line, "reject ", 7);
  if (accept || reject) {
    if (!c->good) puts("the latest tap doesn't count, so it can't be accepted or rejected");
    snprintf(words, ETHD_MESSAGE_MAX, "%.*s", ETHD_MESSAGE_MAX - 1, line + 7);
    return !c->good ? ETHD_WISH_GO : accept ? ETHD_WISH_ACCEPT : ETHD_WISH_REJECT;
  }
  if (!strcmp(line, "abort")) return ETHD_WISH_ABORT;
  if (!strcmp(line, "undo")) return ETHD_WISH_UNDO;
  if (!strcmp(line, "stop")) return ETHD_WISH_STOP;
  if (!strcmp(line, "go")) c->paused = false;
  if (!strcmp(line, "pause") && !c->paused) {
    c->paused = true;
    return ETHD_WISH_PAUSE;
  }
  if (strcmp(line, "go") && strcmp(line, "pause"))
    printf("found \"%.40s\"; note WORDS, accept WORDS, reject WORDS, pause, go, abort, undo, stop are allowed\n", line);
  return ETHD_WISH_GO;
}

static ethd__wish wish(void *self, bool over, char words[ETHD_MESSAGE_MAX]) {
  ethd__console *c = self;
  char line[ETHD_MESSAGE_MAX];
  (void)over;
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

/* ---- a participant begins ---- */

/* Asks until a line is one of the two words or "stop". The second word may be NULL. */
static ethd__wish choose(ethd__console *c, const char *const word[2], const ethd__wish wish[2]) {
  char line[ETHD_MESSAGE_MAX];
  fflush(stdout);
  while (read_line(c, true, line, sizeof line)) {
    for (int i = 0; i < 2; i++)
      if (word[i] && !strcmp(line, word[i])) return wish[i];
    if (!strcmp(line, "stop")) return ETHD_WISH_STOP;
    printf("found \"%.40s\"; %s%s%s or stop is allowed\n", line, word[0], word[1] ? ", " : "", word[1] ? word[1] : "");
    fflush(stdout);
  }
  return ETHD_WISH_STOP;
}

/* The experimenter types the number of the next participant, which can't happen by accident. */
static ethd__wish meet(void *self, const ethd__meeting *meeting) {
  ethd__console *c = self;
  const ethd__questionnaire *q = &c->protocol->questionnaire;
  if (!c->ask) return ETHD_WISH_GO;
  if (meeting->handed_over) {
    const char *const words[2] = {meeting->participant, meeting->can_undo ? "undo" : NULL};
    printf("next is %s: the experimenter types %s when they sit%s\n", meeting->participant, meeting->participant,
           meeting->can_undo ? ", or undo where the last one was ended by mistake" : "");
    ethd__wish wish = choose(c, words, (const ethd__wish[]){ETHD_WISH_GO, ETHD_WISH_UNDO});
    if (wish != ETHD_WISH_GO) return wish;
  }
  ethd__wish wish = ETHD_WISH_GO;
  if (q->consent && !meeting->consented) {
    puts(q->consent);
    puts("yes: I agree; no: I don't");
    wish = choose(c, (const char *const[]){"yes", "no"}, (const ethd__wish[]){ETHD_WISH_AGREE, ETHD_WISH_ABORT});
  }
  if (q->instruction && (wish == ETHD_WISH_GO || wish == ETHD_WISH_AGREE)) puts(q->instruction);
  return wish;
}

/* ---- the survey ---- */

static void print_question(const ethd__question *q) {
  char words[ETHD_MESSAGE_MAX];
  printf("%s", q->text);
  for (int k = 1; k <= (int)ethd__answer_count(q); k++) {
    ethd__answer_words(q, k, words, sizeof words);
    printf("%s %d %s", k > 1 ? "," : "", k, words);
  }
  printf(ethd__question_is_text(q) ? " in your own words\n" : "\n");
  fflush(stdout);
}

static void print_answers(const ethd__asked *asked) {
  printf("the answers:");
  for (size_t i = 0; i < asked->number; i++)
    if (asked->answer[i] > 0 && *asked->said[i])
      printf(" \"%s\"", asked->said[i]);
    else if (asked->answer[i] > 0)
      printf(" %d", asked->answer[i]);
    else
      printf(" none");
  printf("; ok keeps them, back changes them\n");
  fflush(stdout);
}

static int ask(void *self, const ethd__asked *asked) {
  ethd__console *c = self;
  const ethd__question *question = &asked->question[asked->number];
  char line[ETHD_MESSAGE_MAX];
  bool confirm = asked->number == asked->count, text = !confirm && ethd__question_is_text(question);
  int most = confirm ? 0 : (int)ethd__answer_count(question);
  if (!c->ask) return ETHD_ANSWER_NOBODY;
  (confirm ? print_answers(asked) : print_question(question));
  while (read_line(c, true, line, sizeof line)) {
    if (!strcmp(line, "back")) return ETHD_ANSWER_BACK;
    if (!strcmp(line, "stop")) return ETHD_ANSWER_STOP;
    if (confirm ? !strcmp(line, "ok") : !*line) return ETHD_ANSWER_NONE;
    if (text) {
      snprintf(asked->words, ETHD_MESSAGE_MAX, "%s", line);
      return 1;
    }
    if (line[0] >= '1' && line[0] <= '0' + most && !line[1]) return line[0] - '0';
    if (confirm)
      printf("found \"%.40s\"; ok, back or stop is allowed\n", line);
    else
      printf("found \"%.40s\"; 1 to %d, back, stop, or an empty line for no answer\n", line, most);
    fflush(stdout);
  }
  return ETHD_ANSWER_STOP;
}

ethd__front ethd__console_front(ethd__console *console) {
  return (ethd__front){console, meet, block, verdict, wish, stopped, ask};
}
