/* Loads drivers from shared objects, and checks any driver's table. All [main]. */
#ifndef ETHD__DEVICE_DRIVER_FILE_H
#define ETHD__DEVICE_DRIVER_FILE_H

#include "ethd/driver.h"

/* Checks the table against the rules of driver.h; if it breaks one, `what` gets one line. None of the table's functions
   is called. */
ETHD_MUST_CHECK ethd_status ethd__driver_check(const ethd_driver *driver, char what[ETHD_MESSAGE_MAX]);

/* Copies a checked table to one as large as ours; fields that an older header lacks become NULL. */
ethd_driver ethd__driver_whole(const ethd_driver *driver);

/* Makes a driver whose open is this one's prepare, so that it touches no device. Without a prepare its only content is
   a remark. */
ethd_driver ethd__driver_prepared(const ethd_driver *driver);

/* Loads the shared object, checks its table and copies it; it stays loaded. */
ETHD_MUST_CHECK ethd_status ethd__driver_load(const char *path, ethd_driver *out, char what[ETHD_MESSAGE_MAX]);

#endif
