/* Prints the lists of `ethd-check --laws` and `--drivers`: every law, method and driver that a configuration can
   name. */
#ifndef ETHD__APPS_CHECK_LAWS_H
#define ETHD__APPS_CHECK_LAWS_H

#include <stdbool.h>

#define PLUGINS_MAX 64

/* The lists to print. */
typedef struct ethd__listing {
  bool laws, drivers;               /* the built-in ones */
  const char *plugins[PLUGINS_MAX]; /* files whose laws are listed with `laws` */
  int plugin_count;
  const char *driver; /* a driver's file; NULL: none */
  const char *csv;    /* a row for each parameter goes into this file; NULL: none */
} ethd__listing;

/* Prints the lists; exits with one line if a file can't be loaded or written. [main] */
void ethd__list(const ethd__listing *what);

#endif
