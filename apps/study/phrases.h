/* The fixed phrases of the participant's screen, by name, with their English defaults. A study file's section
   [words] replaces any of them; ethd-study --words prints all of them as such a section, to be translated.

     [words]
     tap = Tippen
     achieved = {1} m/s, es zählen {2} bis {3} m/s

   {1}, {2} .. stand for what the default has there; a phrase may repeat them or leave them out. The keys stay what they
   are. A phrase of two words or more keeps the blanks between them. */
#ifndef ETHD__APPS_STUDY_PHRASES_H
#define ETHD__APPS_STUDY_PHRASES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define ETHD_PHRASE_LIST(X)                                                                                      \
  X(PART, "part", "part {1} of {2}")                                                                             \
  X(PRACTICE, "practice", "practice")                                                                            \
  X(REST, "rest", "Time for a rest. Go on when you like.")                                                       \
  X(PAGE, "page", "page {1} of {2}")                                                                             \
  X(TASK, "task", "Tap once on the green wall at the left,")                                                     \
  X(SPEED, "speed", "as fast as the white mark will move: {1} m/s")                                              \
  X(READY, "ready", "Bring the circle to the grey line, and wait")                                               \
  X(TAP, "tap", "Tap")                                                                                           \
  X(PAUSE, "pause", "Pause")                                                                                     \
  X(NOTE, "note", "A note")                                                                                      \
  X(END_ONE, "end_one", "End for this participant?")                                                             \
  X(STOPPED, "stopped", "The device has stopped itself")                                                         \
  X(CALL, "call", "Thank you. Please call the experimenter.")                                                    \
  X(HAND_OVER, "hand_over", "Experimenter: when {1} sits here, type {1} and press Enter")                        \
  X(OTHER_ONE, "other_one", "\"{1}\" was typed; it is the turn of {2}")                                          \
  X(ANSWERS, "answers", "Are these your answers?")                                                               \
  X(NO_ANSWER, "no_answer", "no answer")                                                                         \
  X(THANKS, "thanks", "That was all. Thank you!")                                                                \
  X(COUNT, "count", "({1} of {2})")                                                                              \
  X(ACHIEVED, "achieved", "{1} m/s; from {2} to {3} m/s count")                                                  \
  X(CHECK, "check", "Experimenter: why?")                                                                        \
  X(ACCEPTED, "accepted", "accepted")                                                                            \
  X(REJECTED, "rejected", "rejected")                                                                            \
  X(CHECKED, "checked", "accepted: {1}, rejected: {2}")                                                          \
  X(VALID, "valid", "valid")                                                                                     \
  X(FAULT, "fault", "the device stopped itself")                                                                 \
  X(EARLY_CONTACT, "early_contact", "touched the ring before the wall: keep the finger in the middle")           \
  X(TOO_SLOW, "too_slow", "too slow")                                                                            \
  X(TOO_FAST, "too_fast", "too fast")                                                                            \
  X(NO_CONTACT, "no_contact", "no contact: go on until the wall is felt")                                        \
  X(GRAZING, "grazing", "only grazed: press for a moment")                                                       \
  X(DOUBLE, "double", "tapped twice: once is enough")                                                            \
  X(KEYS_GO, "keys_go", "Space goes on   Esc stops")                                                             \
  X(KEYS_PAGE, "keys_page", "Space next page   Backspace page before   Esc stops")                               \
  X(KEYS_WAIT, "keys_wait", "P pause   N note   A end this participant   Esc stop")                              \
  X(KEYS_CHECK, "keys_check", "V accept this tap   R reject it   U undo")                                        \
  X(KEYS_NOW, "keys_now", "Space now")                                                                           \
  X(KEYS_NOTE, "keys_note", "Enter keeps it   Esc forgets it")                                                   \
  X(KEYS_SURE, "keys_sure", "Y yes   N goes back")                                                               \
  X(KEYS_SEEN, "keys_seen", "Space: I have seen to it   Esc stops")                                              \
  X(KEYS_BEGIN, "keys_begin", "Enter begins   Esc stops")                                                        \
  X(KEYS_UNDO, "keys_undo", "Enter begins   F2 undoes the end of the one before   Esc stops")                    \
  X(KEYS_CONSENT, "keys_consent", "Y I agree   N I don't   Esc stops")                                           \
  X(KEYS_QUESTION, "keys_question", "1 to {1} choose, 0 no answer   Enter goes on   Backspace back   Esc stops") \
  X(KEYS_TEXT, "keys_text", "Enter goes on   F2 back   Esc stops")                                               \
  X(KEYS_ANSWERS, "keys_answers", "Enter keeps them   Backspace changes them   Esc stops")                       \
  X(KEYS_THANKS, "keys_thanks", "Space ends")

typedef enum ethd__phrase_name {
#define ETHD_PHRASE_NAME(name, key, words) ETHD_PHRASE_##name,
  ETHD_PHRASE_LIST(ETHD_PHRASE_NAME)
#undef ETHD_PHRASE_NAME
      ETHD_PHRASES
} ethd__phrase_name;

typedef struct ethd__phrase {
  const char *key, *words;
} ethd__phrase;

/* By their names. */
extern const ethd__phrase ethd__phrases[ETHD_PHRASES];

/* Inserts the values at {1}, {2} ..; text without room is cut off. [any] */
void ethd__phrase_fill(char *out, size_t room, const char *phrase, const char *const *values, size_t count);

/* Returns a {..} of the phrase that its default lacks; NULL: none. *length: its bytes. [any] */
const char *ethd__phrase_fault(const char *phrase, const char *instead_of, size_t *length);

/* Of Hebrew, Arabic and the other scripts that are written from right to left. [any] */
bool ethd__letter_goes_left(uint32_t letter);

#endif
