/* Checks whether a font has the letters of a study's own words. All [main]. */
#ifndef ETHD__APPS_SCREEN_LETTERS_H
#define ETHD__APPS_SCREEN_LETTERS_H

#include <SDL2/SDL_ttf.h>

#include "study/protocol.h"

/* Refuses a questionnaire with the first letter that the font lacks, and gives its place. */
ETHD_MUST_CHECK ethd_status ethd__letters_check(const ethd__questionnaire *q, const TTF_Font *font,
                                                char message[ETHD_MESSAGE_MAX]);

#endif
