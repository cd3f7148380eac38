#ifndef ETHD__SETUP_H
#define ETHD__SETUP_H

/* Refuses a setup that ethd_setup_default didn't make. */
#define ETHD__SETUP_COOKIE 0x45544844u

#endif
