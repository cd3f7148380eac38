#include "study/survey.h"

#include "cli/cli.h"

static ethd__asking asking_of(const ethd__turn *turn) {
  return !turn->number ? ETHD_ASK_BEFORE : turn->number > turn->of ? ETHD_ASK_AFTER : ETHD_ASK_BLOCK;
}

/* Simulated hands leave it empty; the paper's questions are about touch, which a mouse doesn't give. */
bool ethd__survey_due(const ethd__sitting *s, const ethd__turn *turn) {
  const ethd__protocol *p = &s->folder->protocol;
  ethd__asking when = asking_of(turn);
  if (!s->who.in || s->who.at[turn->number].surveyed) return false;
  if (when != ETHD_ASK_BLOCK)
    return ethd__hand_is_persons(s->source.hand) && ethd__question_count(p->questionnaire.question[when]);
  return p->survey && !turn->block.training && (s->source.hand != ETHD_HAND_MOUSE || p->questionnaire.own);
}

/* The answers are confirmed. */
static ethd_status put_survey(ethd__sitting *s, const ethd__turn *turn, char *message) {
  sqlite3_stmt *insert = ethd__store_query(&s->store, "INSERT INTO survey (participant, block) VALUES (?, ?)");
  sqlite3_bind_int64(insert, 1, turn->person + 1);
  sqlite3_bind_int64(insert, 2, (int64_t)turn->number);
  return ethd__sitting_put(s, insert, message);
}

/* Stores an answer, and replaces an earlier one. Words count as 1. */
static ethd_status put_answer(ethd__sitting *s, const ethd__turn *turn, const ethd__asked *asked, int said,
                              char *message) {
  const ethd__question *question = &asked->question[asked->number];
  sqlite3_stmt *insert = ethd__store_query(&s->store, "INSERT OR REPLACE INTO answer VALUES (?, ?, ?, ?, ?)");
  sqlite3_bind_int64(insert, 1, turn->person + 1);
  sqlite3_bind_int64(insert, 2, (int64_t)turn->number);
  sqlite3_bind_int64(insert, 3, (int64_t)asked->number + 1);
  sqlite3_bind_int(insert, 4, said > 0 ? said : ETHD_ANSWER_NONE);
  if (said > 0 && ethd__question_is_text(question)) sqlite3_bind_text(insert, 5, asked->words, -1, SQLITE_STATIC);
  return ethd__sitting_put(s, insert, message);
}

/* A returning participant continues at the first question without an answer. */
ethd_status ethd__survey_run(ethd__sitting *s, const char *id, const ethd__turn *turn, bool *stop,
                             char message[ETHD_MESSAGE_MAX]) {
  const ethd__question *question = s->folder->protocol.questionnaire.question[asking_of(turn)];
  size_t count = ethd__question_count(question), i = 0;
  ethd__said answers;
  char words[ETHD_MESSAGE_MAX];
  if (!ethd__hand_is_persons(s->source.hand)) return put_survey(s, turn, message);
  ethd_status status = ethd__said_of(&s->store, turn->person, turn->number, &answers, message);
  while (i < count && answers.number[i] != ETHD_ANSWER_UNASKED) i++;
  while (!status) {
    ethd__asked asked = {
        .participant = id, .question = question, .count = count, .number = i, .answer = answers.number, .words = words};
    for (size_t k = 0; k < count; k++) asked.said[k] = answers.words[k];
    int said = s->front.ask(s->front.self, &asked);
    *stop = said == ETHD_ANSWER_STOP || ethd__stop;
    s->unasked += said == ETHD_ANSWER_NOBODY;
    if (*stop || said == ETHD_ANSWER_NOBODY) return ETHD_OK;
    if (said == ETHD_ANSWER_BACK) {
      i -= i > 0;
    } else if (i < count) {
      status = put_answer(s, turn, &asked, said, message);
      if (!status) status = ethd__said_of(&s->store, turn->person, turn->number, &answers, message);
      i++;
    } else {
      return put_survey(s, turn, message);
    }
  }
  return status;
}
