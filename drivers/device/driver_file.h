/* Drivers from shared objects, and what any driver's table must keep. All [main]. */
#ifndef ETHD__DEVICE_DRIVER_FILE_H
#define ETHD__DEVICE_DRIVER_FILE_H

#include "ethd/driver.h"

/* The table keeps what driver.h says of it; else one line in `what` and the status. Nothing of it is called. */
ETHD_MUST_CHECK ethd_status ethd__driver_check(const ethd_driver *driver, char what[ETHD_MESSAGE_MAX]);

/* A checked table, as large as ours: what an older header didn't have is NULL. */
ethd_driver ethd__driver_whole(const ethd_driver *driver);

/* The driver whose open is this one's prepare, and touches nothing; without a prepare it does nothing but say so. */
ethd_driver ethd__driver_prepared(const ethd_driver *driver);

/* Loads the shared object, checks its table and copies it; it stays loaded. */
ETHD_MUST_CHECK ethd_status ethd__driver_load(const char *path, ethd_driver *out, char what[ETHD_MESSAGE_MAX]);

#endif
