/* The README.md that every folder of a study brings along. */
#ifndef ETHD_STUDY_DICTIONARY_H
#define ETHD_STUDY_DICTIONARY_H

extern const char ethd__dictionary[];

/* The survey's questions, our own words for what the paper asks. */
extern const char *const ethd__questions[3];

#endif
