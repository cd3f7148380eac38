#include "screen/letters.h"

#include <stdio.h>

#include "text/error_text.h"
#include "text/text.h"

static ethd_status check_text(const char *section, const char *key, const char *text, const TTF_Font *font,
                              char *message) {
  for (uint32_t letter; text && *text;) {
    size_t n = ethd__letter_of(text, &letter);
    if (!n) return ethd__say(message, ETHD_E_SYNTAX, "[%s] %s: a byte that isn't UTF-8", section, key);
    if (letter != '\t' && letter != '\n' &&
        !TTF_GlyphIsProvided32((TTF_Font *)font, letter)) /* SDL only lacks the const */
      return ethd__say(message, ETHD_E_RANGE,
                       "[%s] %s: the font %s has no letter \"%.*s\" (U+%04X); ETHD_FONT names another font file",
                       section, key, TTF_FontFaceFamilyName(font), (int)n, text, (unsigned)letter);
    text += n;
  }
  return ETHD_OK;
}

static ethd_status check_questions(const ethd__questionnaire *q, ethd__asking when, const TTF_Font *font,
                                   char *message) {
  const char *section = ethd__asking_sections[when];
  char key[24];
  ethd_status status = ETHD_OK;
  for (int i = 0; !status && i < ETHD_STUDY_QUESTIONS; i++) {
    snprintf(key, sizeof key, "q%d", i + 1);
    status = check_text(section, key, q->question[when][i].text, font, message);
    snprintf(key, sizeof key, "q%d_answers", i + 1);
    if (!status) status = check_text(section, key, q->question[when][i].answers, font, message);
  }
  return status;
}

ethd_status ethd__letters_check(const ethd__questionnaire *q, const TTF_Font *font, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = check_text("pages", "consent", q->consent, font, message);
  if (!status) status = check_text("pages", "instruction", q->instruction, font, message);
  for (int i = 0; !status && i < ETHD_ASKINGS; i++) status = check_questions(q, (ethd__asking)i, font, message);
  for (int i = 0; !status && i < ETHD_PHRASES; i++)
    status = check_text("words", ethd__phrases[i].key, q->phrase[i], font, message);
  return status;
}
