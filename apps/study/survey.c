#include "study/survey.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "text/csv.h"

/* Simulated hands leave it empty; the paper's questions are about touch, which a mouse doesn't give. */
bool ethd__survey_due(const ethd__sitting *s, const ethd__turn *turn) {
  const ethd__protocol *p = &s->folder->protocol;
  const ethd__participant *who = &s->progress.person[turn->person];
  return p->survey && !turn->block.training && !who->at[turn->number - 1].surveyed &&
         who->standing == ETHD_STANDING_IN && (s->source.hand != ETHD_HAND_MOUSE || p->questionnaire.own);
}

static const char *words_of(const ethd__sitting *s, const ethd__turn *turn, size_t question) {
  return ethd__progress_words(&s->progress, &s->progress.person[turn->person].at[turn->number - 1], question);
}

static ethd_status put_survey(ethd__sitting *s, const char *id, const ethd__turn *turn, char *message) {
  const ethd__protocol *p = &s->folder->protocol;
  const int16_t *answer = s->progress.person[turn->person].at[turn->number - 1].answer;
  char *row = NULL;
  size_t length;
  FILE *file = open_memstream(&row, &length);
  if (!file) ethd__fail_memory();
  fprintf(file, "%s,%zu,%s,%s", id, turn->number, p->strategies.word[turn->block.strategy],
          p->speeds.word[turn->block.speed]);
  for (size_t i = 0; i < ethd__question_count(&p->questionnaire); i++) {
    putc(',', file);
    if (ethd__question_is_text(&p->questionnaire.question[i]))
      ethd__csv_put_word(file, words_of(s, turn, i));
    else if (answer[i] > 0)
      fprintf(file, "%d", answer[i]);
  }
  if (fclose(file)) ethd__fail_memory();
  ethd_status status = ethd__sitting_put(s, "survey", row, message);
  free(row);
  return status;
}

/* Writes the answer into the journal. */
static ethd_status put_answer(ethd__sitting *s, const ethd__asked *asked, int said, char *message) {
  const ethd__question *question = &s->folder->protocol.questionnaire.question[asked->number];
  char *row = NULL;
  size_t length;
  FILE *file = open_memstream(&row, &length);
  if (!file) ethd__fail_memory();
  fprintf(file, "%s,%zu,%zu,", asked->participant, asked->turn->number, asked->number + 1);
  if (said > 0 && ethd__question_is_text(question))
    ethd__csv_put_word(file, asked->words);
  else if (said > 0)
    fprintf(file, "%d", said);
  if (fclose(file)) ethd__fail_memory();
  ethd_status status = ethd__sitting_put(s, "answer", row, message);
  free(row);
  return status;
}

/* Each answer reaches the journal before the next question; who comes back goes on at the first that is missing. */
ethd_status ethd__survey_run(ethd__sitting *s, const char *id, const ethd__turn *turn, bool *stop,
                             char message[ETHD_MESSAGE_MAX]) {
  const int16_t *answer = s->progress.person[turn->person].at[turn->number - 1].answer;
  size_t count = ethd__question_count(&s->folder->protocol.questionnaire), i = 0;
  ethd_status status = ETHD_OK;
  char words[ETHD_MESSAGE_MAX];
  if (!ethd__hand_is_persons(s->source.hand)) return put_survey(s, id, turn, message);
  while (i < count && answer[i] != ETHD_ANSWER_UNASKED) i++;
  while (!status) {
    ethd__asked asked = {.participant = id, .turn = turn, .number = i, .answer = answer, .words = words};
    for (size_t k = 0; k < count; k++) asked.said[k] = words_of(s, turn, k);
    int said = s->front.ask(s->front.self, &asked);
    *stop = said == ETHD_ANSWER_STOP || ethd__stop;
    s->unasked += said == ETHD_ANSWER_NOBODY;
    if (*stop || said == ETHD_ANSWER_NOBODY) return ETHD_OK;
    if (said == ETHD_ANSWER_BACK) {
      i -= i > 0;
    } else if (i < count) {
      status = put_answer(s, &asked, said, message);
      i++;
    } else {
      return put_survey(s, id, turn, message);
    }
  }
  return status;
}
