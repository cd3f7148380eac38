/* The dialogues on the screen between taps: hand-over, consent, instruction, the survey. */
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "screen/draw.h"
#include "study/progress.h"

/* ---- a participant begins ---- */

void ethd__page_of_hand_over(const ethd__questionnaire *q, const ethd__meeting *meeting, const char *typed,
                             ethd__page *out, char text[256]) {
  ethd__phrase_fill(text, 256, ethd__phrase_of(q, ETHD_PHRASE_HAND_OVER), &meeting->participant, 1);
  *out = (ethd__page){.title = meeting->participant,
                      .keys = ethd__phrase_of(q, meeting->can_undo ? ETHD_PHRASE_KEYS_UNDO : ETHD_PHRASE_KEYS_BEGIN)};
  ethd__page_add(out, ETHD_TEXT_LARGE, ethd__phrase_of(q, ETHD_PHRASE_CALL), ethd__white);
  ethd__page_add(out, ETHD_TEXT_SMALL, text, ethd__grey);
  ethd__page_add(out, ETHD_TEXT_LARGE, *typed ? typed : "_", ethd__green);
}

/* Nobody types the next one's number by chance. */
static ethd__wish hand_over(ethd__screen *s, const ethd__meeting *meeting) {
  const ethd__questionnaire *q = &s->protocol->questionnaire;
  char line[32] = "", text[256], refused[256] = "";
  ethd__page page;
  do {
    ethd__page_of_hand_over(q, meeting, "", &page, text);
    page.count--; /* the typed line replaces the last paragraph */
    ethd__page_add(&page, ETHD_TEXT_SMALL, refused, ethd__red);
    *line = 0;
    if (!ethd__screen_type(s, &page, line, sizeof line))
      return s->window.key == SDLK_F2 && meeting->can_undo && !s->stop ? ETHD_WISH_UNDO : ETHD_WISH_STOP;
    ethd__phrase_fill(refused, sizeof refused, ethd__phrase_of(q, ETHD_PHRASE_OTHER_ONE),
                      (const char *[]){line, meeting->participant}, 2);
  } while (strcasecmp(line, meeting->participant) != 0);
  return ETHD_WISH_GO;
}

static ethd__wish consent(ethd__screen *s, const char *participant) {
  switch (ethd__screen_read(s, s->protocol->questionnaire.consent, participant,
                            ethd__screen_words(s, ETHD_PHRASE_KEYS_CONSENT), (const int[]){SDLK_y, SDLK_n, 0})) {
  case SDLK_y: return ETHD_WISH_AGREE;
  case SDLK_n: return ETHD_WISH_ABORT;
  default: return ETHD_WISH_STOP;
  }
}

ethd__wish ethd__screen_meet(void *self, const ethd__meeting *meeting) {
  ethd__screen *s = self;
  const ethd__questionnaire *q = &s->protocol->questionnaire;
  snprintf(s->title, sizeof s->title, "%s", meeting->participant);
  ethd__wish wish = meeting->handed_over ? hand_over(s, meeting) : ETHD_WISH_GO;
  if (wish == ETHD_WISH_GO && q->consent && !meeting->consented) wish = consent(s, meeting->participant);
  if ((wish != ETHD_WISH_GO && wish != ETHD_WISH_AGREE) || !q->instruction) return wish;
  return ethd__screen_read(s, q->instruction, meeting->participant, ethd__screen_words(s, ETHD_PHRASE_KEYS_GO),
                           (const int[]){SDLK_SPACE, SDLK_RETURN, 0}) == SDLK_ESCAPE &&
                 wish != ETHD_WISH_AGREE
             ? ETHD_WISH_STOP
             : wish; /* a given consent is kept; the stop is handled next */
}

/* ---- the survey ---- */

#define LINE_ROOM 256 /* largest number of bytes of an answer in words */

/* Length of the longest prefix of whole letters within a number of bytes. */
static size_t bytes_within(const char *text, size_t most) {
  size_t n = strlen(text);
  if (n <= most) return n;
  for (n = most; n && (text[n] & 0xc0) == 0x80;) n--;
  return n;
}

void ethd__page_of_question(const ethd__question *question, int chosen, ethd__page *out,
                            char text[ETHD_STUDY_ANSWERS][256]) {
  char words[200];
  ethd__page_add(out, ETHD_TEXT_LARGE, question->text, ethd__white);
  for (int k = 1; k <= (int)ethd__answer_count(question); k++) {
    ethd__answer_words(question, k, words, sizeof words);
    snprintf(text[k - 1], 256, k == chosen ? "> %d   %s <" : "%d   %s", k, words);
    ethd__page_add(out, ETHD_TEXT_LARGE, text[k - 1], k == chosen ? ethd__green : ethd__grey);
  }
}

void ethd__page_of_answers(const ethd__questionnaire *q, const ethd__asked *asked, ethd__page *out,
                           char text[ETHD_STUDY_QUESTIONS][256]) {
  char words[200];
  ethd__page_add(out, ETHD_TEXT_LARGE, ethd__phrase_of(q, ETHD_PHRASE_ANSWERS), ethd__white);
  for (size_t i = 0; i < asked->count; i++) {
    words[0] = 0;
    if (ethd__question_is_text(&asked->question[i]))
      snprintf(words, sizeof words, "%.*s", (int)bytes_within(asked->said[i], sizeof words - 1), asked->said[i]);
    else if (asked->answer[i] > 0)
      ethd__answer_words(&asked->question[i], asked->answer[i], words, sizeof words);
    snprintf(text[i], 256, "%zu   %s", i + 1, *words ? words : ethd__phrase_of(q, ETHD_PHRASE_NO_ANSWER));
    ethd__page_add(out, ETHD_TEXT_SMALL, text[i], *words ? ethd__green : ethd__red);
  }
}

static int confirm(ethd__screen *s, const ethd__asked *asked) {
  char text[ETHD_STUDY_QUESTIONS][256];
  ethd__page page = {.title = s->title, .keys = ethd__screen_words(s, ETHD_PHRASE_KEYS_ANSWERS)};
  ethd__page_of_answers(&s->protocol->questionnaire, asked, &page, text);
  switch (ethd__screen_page(s, &page, (const int[]){SDLK_RETURN, SDLK_KP_ENTER, SDLK_BACKSPACE, 0})) {
  case SDLK_BACKSPACE: return ETHD_ANSWER_BACK;
  case SDLK_ESCAPE: return ETHD_ANSWER_STOP;
  default: return ETHD_ANSWER_NONE;
  }
}

/* A line in the participant's own words, which begins with the previous answer. */
static int ask_words(ethd__screen *s, const ethd__asked *asked) {
  ethd__page page = {.title = s->title, .keys = ethd__screen_words(s, ETHD_PHRASE_KEYS_TEXT)};
  ethd__page_add(&page, ETHD_TEXT_LARGE, asked->question[asked->number].text, ethd__white);
  snprintf(asked->words, ETHD_MESSAGE_MAX, "%s", asked->said[asked->number]);
  if (ethd__screen_type(s, &page, asked->words, LINE_ROOM)) return *asked->words ? 1 : ETHD_ANSWER_NONE;
  return s->window.key == SDLK_F2 && !s->stop ? ETHD_ANSWER_BACK : ETHD_ANSWER_STOP;
}

/* The digit that was pressed, -1: none. */
static int digit_of(int key) {
  if (key >= SDLK_0 && key <= SDLK_9) return key - SDLK_0;
  if (key == SDLK_KP_0) return 0;
  return key >= SDLK_KP_1 && key <= SDLK_KP_9 ? key - SDLK_KP_1 + 1 : -1;
}

/* A digit chooses and Enter confirms: fast digits choose again, and answer one question. */
static int ask_number(ethd__screen *s, const ethd__asked *asked) {
  const ethd__question *question = &asked->question[asked->number];
  int chosen = asked->answer[asked->number];
  char text[ETHD_STUDY_ANSWERS][256], keys[256], most[24], none[256];
  snprintf(most, sizeof most, "%zu", ethd__answer_count(question));
  snprintf(none, sizeof none, "> %s <", ethd__screen_words(s, ETHD_PHRASE_NO_ANSWER));
  ethd__phrase_fill(keys, sizeof keys, ethd__screen_words(s, ETHD_PHRASE_KEYS_QUESTION), (const char *[]){most}, 1);
  while (ethd__screen_begin(s)) {
    int key = s->window.key, digit = digit_of(key);
    if (key == SDLK_BACKSPACE) return ETHD_ANSWER_BACK;
    if ((key == SDLK_RETURN || key == SDLK_KP_ENTER) && chosen >= 0) return chosen;
    if (digit >= 0 && digit <= (int)ethd__answer_count(question)) chosen = digit;
    ethd__page page = {.title = s->title, .keys = keys};
    ethd__page_of_question(question, chosen, &page, text);
    if (!chosen) ethd__page_add(&page, ETHD_TEXT_LARGE, none, ethd__green);
    ethd__page_draw(&s->window, &page);
    ethd__window_end(&s->window);
  }
  return ETHD_ANSWER_STOP;
}

int ethd__screen_ask(void *self, const ethd__asked *asked) {
  ethd__screen *s = self;
  if (asked->number == asked->count) return confirm(s, asked);
  return (ethd__question_is_text(&asked->question[asked->number]) ? ask_words : ask_number)(s, asked);
}
