/* The participant's instructions and questions, in the study's own words. [main] unless stated.

     [before], [survey], [after]                  [pages]                          and [words], see phrases.h
     q1 = How did the touch feel?                 consent1 = The study takes an hour. You may end it at any time.
     q1_answers = natural | neither | unnatural   instruction1 = Tap once on the green wall.

   The questions of [survey] are asked after each block, the others once, before the first tap and after the last one.
   Questions are q1 to q9 without a gap; answers are numbered from 1, two to nine of them, five bare numbers without
   q1_answers. "q1_answers = text" asks for a line in the participant's own words. Consent and instruction are
   paragraphs, consent1 to consent99 and instruction1 to instruction99, in the order of the file; each is a line of any
   length. Other texts have at most ETHD_STUDY_WORDS_MAX bytes. " ;" is no comment in these sections. */
#ifndef ETHD__APPS_STUDY_QUESTIONNAIRE_H
#define ETHD__APPS_STUDY_QUESTIONNAIRE_H

#include <stdbool.h>
#include <stddef.h>

#include "study/phrases.h"

#define ETHD_STUDY_QUESTIONS 9
#define ETHD_STUDY_ANSWERS 9
#define ETHD_STUDY_WORDS_MAX 190

typedef struct ethd__question {
  char *text, *answers; /* answers: "this|that", blanks around the bars; "text"; NULL: the numbers 1 to 5 */
  int line;             /* of the file */
} ethd__question;

/* The times of questions. */
typedef enum ethd__asking { ETHD_ASK_BEFORE, ETHD_ASK_BLOCK, ETHD_ASK_AFTER, ETHD_ASKINGS } ethd__asking;

/* Their sections; the prefix of q1 and so on in the tables. [any] */
extern const char *const ethd__asking_sections[ETHD_ASKINGS], *const ethd__asking_columns[ETHD_ASKINGS];

typedef struct ethd__questionnaire {
  ethd__question question[ETHD_ASKINGS][ETHD_STUDY_QUESTIONS];
  char *consent, *instruction; /* paragraphs, a line each; NULL: none */
  char *phrase[ETHD_PHRASES];  /* NULL: the default */
  bool own;                    /* [survey] has questions of the study's own, not the paper's */
} ethd__questionnaire;

/* The number of questions, and of numbered answers to one of them: 0 for an answer in words. [any] */
size_t ethd__question_count(const ethd__question *list);
size_t ethd__answer_count(const ethd__question *question);
bool ethd__question_is_text(const ethd__question *question);

/* Writes the words of an answer, which counts from 1; its number without words. [any] */
void ethd__answer_words(const ethd__question *question, int answer, char *out, size_t room);

/* Returns words of the screen: the study's own or the default. [any] */
const char *ethd__phrase_of(const ethd__questionnaire *q, ethd__phrase_name name);

/* Returns when the questions of a section are asked; ETHD_ASKINGS: it has none. [any] */
ethd__asking ethd__asking_of(const char *section);

/* Returns where the text of a key of these sections, [pages] or [words] is; NULL: there is no such key. */
char **ethd__questionnaire_at(ethd__questionnaire *q, const char *section, const char *key);

/* Puts in the paper's questions, in our own words, if the study has none. False: no memory. */
bool ethd__questionnaire_fill(ethd__questionnaire *q);

/* Returns a question that has too few or too many answers, or none before it, and *what says which; NULL: all is well.
   name: its key, such as survey.q2. */
const ethd__question *ethd__questionnaire_fault(const ethd__questionnaire *q, const char **what, char name[24]);

void ethd__questionnaire_free(ethd__questionnaire *q);

#endif
