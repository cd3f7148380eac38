/* Injects faults by a script: it changes samples and commands between the drivers of a device and their user, as a
   broken device would.

       [device]
       driver = servo, ring
       inject = broken.inject */
#ifndef ETHD__INJECT_INJECT_H
#define ETHD__INJECT_INJECT_H

#include "inject/script.h"
#include "inject/values.h"

typedef struct ethd__inject ethd__inject;

typedef union ethd__inject_order {
  ethd_command plane;
  ethd_space_command space;
} ethd__inject_order;

/* Takes ownership of the script, of a device in space or in the plane. NULL: no memory; the caller keeps the script.
   [main] */
ethd__inject *ethd__inject_create(const ethd__script *script, bool in_space);
void ethd__inject_free(ethd__inject *inject);

/* Begins anew: the script counts from the next sample. A failure is an injected one. [main] */
ETHD_MUST_CHECK ethd_status ethd__inject_start(ethd__inject *inject);

/* Before the drivers are read: empties *out and raises faults in it. A failure is an injected one; a positive status:
   don't read the drivers. [rt] */
ETHD_MUST_CHECK ethd_status ethd__inject_before(ethd__inject *inject, int64_t now_ns, ethd__inject_sense *out) ETHD_RT;

/* After the read, with the drivers' status: changes *sense, and returns true if it holds a sample, or faults of one.
   [rt] */
bool ethd__inject_after(ethd__inject *inject, ethd_status status, ethd__inject_sense *sense) ETHD_RT;

/* Changes a command. A failure is an injected one; a positive status: the command is dropped. [rt] */
ETHD_MUST_CHECK ethd_status ethd__inject_command(ethd__inject *inject, ethd__inject_order *command) ETHD_RT;

/* Returns an injected status of a unit's service; ETHD_OK: the service works as usual. [any I/O thread] */
ETHD_MUST_CHECK ethd_status ethd__inject_service(const ethd__inject *inject, int64_t now_ns);

/* Returns how many faults were injected. [main] */
ethd_figure ethd__inject_figure(const ethd__inject *inject);

#endif
