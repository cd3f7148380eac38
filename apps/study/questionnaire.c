#include "study/questionnaire.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "study/dictionary.h"

#define BARE 5 /* answers of a question without words for them */

const char *const ethd__asking_sections[ETHD_ASKINGS] = {"before", "survey", "after"};
const char *const ethd__asking_columns[ETHD_ASKINGS] = {"before_", "", "after_"};

ethd__asking ethd__asking_of(const char *section) {
  int i = 0;
  while (i < ETHD_ASKINGS && strcmp(section, ethd__asking_sections[i])) i++;
  return (ethd__asking)i;
}

size_t ethd__question_count(const ethd__question *list) {
  size_t n = 0;
  while (n < ETHD_STUDY_QUESTIONS && list[n].text) n++;
  return n;
}

bool ethd__question_is_text(const ethd__question *question) {
  return question->answers && !strcmp(question->answers, "text");
}

size_t ethd__answer_count(const ethd__question *question) {
  size_t n = 1;
  if (ethd__question_is_text(question)) return 0;
  if (!question->answers) return BARE;
  for (const char *p = question->answers; *p; p++) n += *p == '|';
  return n;
}

void ethd__answer_words(const ethd__question *question, int answer, char *out, size_t room) {
  const char *from = question->answers;
  snprintf(out, room, "%d", answer);
  for (int i = 1; from && i < answer; i++) {
    from = strchr(from, '|');
    from += from != NULL;
  }
  if (!from) return;
  from += strspn(from, " \t");
  size_t n = strcspn(from, "|");
  while (n && strchr(" \t", from[n - 1])) n--;
  if (n) snprintf(out, room, "%.*s", (int)n, from);
}

/* ---- phrases ---- */

#define ROW(name, key, words) [ETHD_PHRASE_##name] = {key, words},
const ethd__phrase ethd__phrases[ETHD_PHRASES] = {ETHD_PHRASE_LIST(ROW)};
#undef ROW

const char *ethd__phrase_of(const ethd__questionnaire *q, ethd__phrase_name name) {
  return q->phrase[name] ? q->phrase[name] : ethd__phrases[name].words;
}

void ethd__phrase_fill(char *out, size_t room, const char *phrase, const char *const *values, size_t count) {
  size_t n = 0;
  out[0] = 0;
  for (const char *p = phrase; *p && n + 1 < room;) {
    bool place = p[0] == '{' && p[1] >= '1' && (size_t)(p[1] - '1') < count && p[2] == '}';
    n += (size_t)snprintf(out + n, room - n, "%.*s", place ? (int)room : 1, place ? values[p[1] - '1'] : p);
    p += place ? 3 : 1;
  }
}

const char *ethd__phrase_fault(const char *phrase, const char *instead_of, size_t *length) {
  for (const char *p = phrase; (p = strchr(p, '{')); p++) {
    char place[4] = {0};
    *length = strcspn(p, "}") + (p[strcspn(p, "}")] == '}');
    snprintf(place, sizeof place, "%.3s", p);
    if (*length != 3 || !strstr(instead_of, place)) return p;
  }
  return NULL;
}

/* ---- letters ---- */

bool ethd__letter_goes_left(uint32_t c) {
  return (c >= 0x590 && c < 0x900) || (c >= 0xfb1d && c < 0xfe00) || (c >= 0xfe70 && c < 0xff00) || c == 0x200f ||
         (c >= 0x202a && c <= 0x202e) || (c >= 0x2066 && c <= 0x2069) || (c >= 0x10800 && c < 0x11000) ||
         (c >= 0x1e800 && c < 0x1f000);
}

/* ---- keys ---- */

/* Returns the number up to `most` in a key like "q3_answers"; 0 if the key has another form. */
static int number_of(const char *key, const char *name, const char *behind, int most) {
  size_t n = strlen(name), digits = strncmp(key, name, n) ? 0 : strspn(key + n, "0123456789");
  if (digits < 1 || digits > 2 || key[n] == '0' || strcmp(key + n + digits, behind) != 0) return 0;
  int number = atoi(key + n);
  return number <= most ? number : 0;
}

char **ethd__questionnaire_at(ethd__questionnaire *q, const char *section, const char *key) {
  int k;
  ethd__asking when = ethd__asking_of(section);
  if (when < ETHD_ASKINGS) {
    if ((k = number_of(key, "q", "", ETHD_STUDY_QUESTIONS))) return &q->question[when][k - 1].text;
    if ((k = number_of(key, "q", "_answers", ETHD_STUDY_QUESTIONS))) return &q->question[when][k - 1].answers;
  }
  if (!strcmp(section, "pages")) {
    if (number_of(key, "consent", "", 99)) return &q->consent;
    if (number_of(key, "instruction", "", 99)) return &q->instruction;
  }
  for (k = 0; !strcmp(section, "words") && k < ETHD_PHRASES; k++)
    if (!strcmp(key, ethd__phrases[k].key)) return &q->phrase[k];
  return NULL;
}

bool ethd__questionnaire_fill(ethd__questionnaire *q) {
  ethd__question *list = q->question[ETHD_ASK_BLOCK];
  for (int i = 0; i < ETHD_STUDY_QUESTIONS; i++) q->own |= list[i].text || list[i].answers;
  if (q->own) return true;
  for (int i = 0; i < 3; i++) {
    list[i].text = strdup(ethd__paper_questions[i].text);
    list[i].answers = strdup(ethd__paper_questions[i].answers);
    if (!list[i].text || !list[i].answers) return false;
  }
  return true;
}

const ethd__question *ethd__questionnaire_fault(const ethd__questionnaire *q, const char **what, char name[24]) {
  for (int k = 0; k < ETHD_ASKINGS * ETHD_STUDY_QUESTIONS; k++) {
    int when = k / ETHD_STUDY_QUESTIONS, i = k % ETHD_STUDY_QUESTIONS;
    const ethd__question *question = &q->question[when][i];
    size_t count = ethd__question_count(q->question[when]);
    snprintf(name, 24, "%s.q%d", ethd__asking_sections[when], i + 1);
    size_t answers = ethd__answer_count(question);
    *what = answers == 1                   ? "one answer; \"this | that\", two to nine, or text are allowed"
            : answers > ETHD_STUDY_ANSWERS ? "over nine answers"
                                           : "stands there without the questions before it";
    bool stray = (size_t)i >= count && (question->text || question->answers);
    if (answers == 1 || answers > ETHD_STUDY_ANSWERS || stray) return question;
  }
  return NULL;
}

void ethd__questionnaire_free(ethd__questionnaire *q) {
  for (int i = 0; i < ETHD_ASKINGS * ETHD_STUDY_QUESTIONS; i++) {
    ethd__question *question = &q->question[i / ETHD_STUDY_QUESTIONS][i % ETHD_STUDY_QUESTIONS];
    free(question->text);
    free(question->answers);
  }
  free(q->consent);
  free(q->instruction);
  for (int i = 0; i < ETHD_PHRASES; i++) free(q->phrase[i]);
  *q = (ethd__questionnaire){0};
}
