/* Text that doesn't depend on the process. A host that follows its user's language has called setlocale, as GTK, Qt and
   matplotlib do: then printf writes 0,5, strtod stops at the point of 0.5, and letters and their
   order are the language's. A host may also have set another rounding, or traps, which printf and strtod obey.

   The Makefile includes this file before each source of drivers and apps, so that the names below mean text in the C
   locale, rounded to nearest. Here alone is the C library asked (tests/symbols.sh). The thread has its locale and its
   floating-point environment back after each call. All [any]. */
#ifndef ETHD__TEXT_LOCALE_H
#define ETHD__TEXT_LOCALE_H

#include <ctype.h>
#include <dirent.h>
#include <fnmatch.h>
#include <glob.h>
#include <locale.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define ETHD__FORMAT(at, first) __attribute__((format(printf, at, first)))

extern locale_t ethd__c_locale;

double ethd__strtod(const char *text, char **end);
int ethd__sscanf(const char *text, const char *format, ...) __attribute__((format(scanf, 2, 3)));
int ethd__printf(const char *format, ...) ETHD__FORMAT(1, 2);
int ethd__vprintf(const char *format, va_list args) ETHD__FORMAT(1, 0);
int ethd__fprintf(FILE *file, const char *format, ...) ETHD__FORMAT(2, 3);
int ethd__snprintf(char *out, size_t room, const char *format, ...) ETHD__FORMAT(3, 4);
int ethd__vsnprintf(char *out, size_t room, const char *format, va_list args) ETHD__FORMAT(3, 0);
int ethd__asprintf(char **out, const char *format, ...) ETHD__FORMAT(2, 3);
int ethd__vasprintf(char **out, const char *format, va_list args) ETHD__FORMAT(2, 0);

/* File names in the order of their bytes. */
int ethd__alphasort(const struct dirent **a, const struct dirent **b);
int ethd__glob(const char *pattern, int flags, int (*failed)(const char *path, int reason), glob_t *out);
int ethd__fnmatch(const char *pattern, const char *name, int flags);

#define strtod(...) ethd__strtod(__VA_ARGS__)
#define sscanf(...) ethd__sscanf(__VA_ARGS__)
#define printf(...) ethd__printf(__VA_ARGS__)
#define vprintf(...) ethd__vprintf(__VA_ARGS__)
#define fprintf(...) ethd__fprintf(__VA_ARGS__)
#define snprintf(...) ethd__snprintf(__VA_ARGS__)
#define vsnprintf(...) ethd__vsnprintf(__VA_ARGS__)
#define asprintf(...) ethd__asprintf(__VA_ARGS__)
#define vasprintf(...) ethd__vasprintf(__VA_ARGS__)
#define alphasort ethd__alphasort
#define glob(...) ethd__glob(__VA_ARGS__)
#define fnmatch(...) ethd__fnmatch(__VA_ARGS__)

#undef isalnum
#undef isalpha
#undef isdigit
#undef isspace
#undef toupper
#define isalnum(c) isalnum_l(c, ethd__c_locale)
#define isalpha(c) isalpha_l(c, ethd__c_locale)
#define isdigit(c) isdigit_l(c, ethd__c_locale)
#define isspace(c) isspace_l(c, ethd__c_locale)
#define toupper(c) toupper_l(c, ethd__c_locale)
#define strcasecmp(a, b) strcasecmp_l(a, b, ethd__c_locale)
#define strncasecmp(a, b, n) strncasecmp_l(a, b, n, ethd__c_locale)
#define strerror(number) strerror_l(number, ethd__c_locale)

#endif
