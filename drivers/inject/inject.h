/* Injects faults by a script: this device wraps any other, between that device and the loop, and changes the samples
   and commands that pass as a broken device would.

       [device]
       driver = servo, ring
       inject = broken.inject        ethd_device_open puts this driver around those

   Its device is made by ethd__inject_around, not by open. */
#ifndef ETHD__INJECT_INJECT_H
#define ETHD__INJECT_INJECT_H

#include "inject/script.h"

extern const ethd_driver ethd__driver_inject;

/* Takes over the open `device` of `driver` and the script; when it fails, with ETHD_E_MEMORY, it has closed and freed
   them. [main] */
ETHD_MUST_CHECK ethd_status ethd__inject_around(const ethd_driver *driver, void *device, ethd__script *script,
                                                void **out);

#endif
