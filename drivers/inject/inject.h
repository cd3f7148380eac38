/* A device that does wrong by a script: it stands around any other, between it and the loop, and does to the
   samples and commands that pass what a broken device would.

       [device]
       driver = servo, ring
       inject = broken.inject        ethd_device_open puts this driver around those

   Its device is made by ethd__inject_around, not by open. */
#ifndef ETHD_INJECT_INJECT_H
#define ETHD_INJECT_INJECT_H

#include "inject/script.h"

extern const ethd_driver ethd__driver_inject;

/* Takes the open `device` of `driver` and the script, also when it fails: closes and frees them then.
   ETHD_E_MEMORY. [main] */
ETHD_MUST_CHECK ethd_status ethd__inject_around(const ethd_driver *driver, void *device, ethd__script *script,
                                                void **out);

#endif
