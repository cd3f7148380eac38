#include <stdio.h>
#include <string.h>

#include "cli/cli.h"
#include "study/session.h"

/* Simulated hands leave it empty; the paper's questions are about touch, which a mouse doesn't give. */
bool ethd__survey_due(const ethd__sitting *s, const ethd__turn *turn) {
  const ethd__protocol *p = &s->folder->protocol;
  const ethd__participant *who = &s->progress.person[turn->person];
  return p->survey && !turn->block.training && !who->at[turn->number - 1].surveyed &&
         who->standing == ETHD_STANDING_IN && (s->source.hand != ETHD_HAND_MOUSE || p->questionnaire.own);
}

static ethd_status put_survey(ethd__sitting *s, const char *id, const ethd__turn *turn, char *message) {
  const ethd__protocol *p = &s->folder->protocol;
  const int16_t *answer = s->progress.person[turn->person].at[turn->number - 1].answer;
  char row[160], cell[4];
  snprintf(row, sizeof row, "%s,%zu,%s,%s", id, turn->number, p->strategies.word[turn->block.strategy],
           p->speeds.word[turn->block.speed]);
  for (size_t i = 0; i < ethd__question_count(&p->questionnaire); i++) {
    snprintf(cell, sizeof cell, answer[i] > 0 ? ",%d" : ",", answer[i]);
    strcat(row, cell);
  }
  return ethd__sitting_put(s, "survey", row, message);
}

/* Each answer reaches the journal before the next question; who comes back goes on at the first that is missing. */
ethd_status ethd__survey_run(ethd__sitting *s, const char *id, const ethd__turn *turn, bool *stop,
                             char message[ETHD_MESSAGE_MAX]) {
  const int16_t *answer = s->progress.person[turn->person].at[turn->number - 1].answer;
  size_t count = ethd__question_count(&s->folder->protocol.questionnaire), i = 0;
  ethd_status status = ETHD_OK;
  char row[64];
  if (!ethd__hand_is_persons(s->source.hand)) return put_survey(s, id, turn, message);
  while (i < count && answer[i] != ETHD_ANSWER_UNASKED) i++;
  while (!status) {
    const ethd__asked asked = {id, turn, i, answer};
    int said = s->front.ask(s->front.self, &asked);
    *stop = said == ETHD_ANSWER_STOP || ethd__stop;
    s->unasked += said == ETHD_ANSWER_NOBODY;
    if (*stop || said == ETHD_ANSWER_NOBODY) return ETHD_OK;
    if (said == ETHD_ANSWER_BACK) {
      i -= i > 0;
    } else if (i < count) {
      snprintf(row, sizeof row, said > 0 ? "%s,%zu,%zu,%d" : "%s,%zu,%zu,", id, turn->number, ++i, said);
      status = ethd__sitting_put(s, "answer", row, message);
    } else {
      return put_survey(s, id, turn, message);
    }
  }
  return status;
}
