/* Loads drivers from shared objects, and checks any driver's table. All [main]. */
#ifndef ETHD__DEVICE_DRIVER_FILE_H
#define ETHD__DEVICE_DRIVER_FILE_H

#include "ethd/driver.h"

/* Checks that the table keeps what driver.h says about it; otherwise `what` gets one line. None of the table's
   functions is called. */
ETHD_MUST_CHECK ethd_status ethd__driver_check(const ethd_driver *driver, char what[ETHD_MESSAGE_MAX]);

/* Copies a checked table to one as large as ours; what an older header didn't have is NULL in it. */
ethd_driver ethd__driver_whole(const ethd_driver *driver);

/* Makes a driver whose open is this one's prepare, and so touches nothing. Without a prepare, it only says that there
   is none. */
ethd_driver ethd__driver_prepared(const ethd_driver *driver);

/* Loads the shared object, checks its table and copies it; it stays loaded. */
ETHD_MUST_CHECK ethd_status ethd__driver_load(const char *path, ethd_driver *out, char what[ETHD_MESSAGE_MAX]);

#endif
