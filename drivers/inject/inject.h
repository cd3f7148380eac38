/* Injects faults by a script: between the drivers of a device and its user it changes the samples and commands that
   pass, as a broken device would.

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

/* Takes over the script, of a device in space or in the plane. NULL: no memory, and the script stays the caller's.
   [main] */
ethd__inject *ethd__inject_create(const ethd__script *script, bool in_space);
void ethd__inject_free(ethd__inject *inject);

/* Begin anew: the script counts from the next sample. A failure is injected. [main] */
ETHD_MUST_CHECK ethd_status ethd__inject_start(ethd__inject *inject);

/* Before the drivers are read: empties *out and raises faults in it. A failure is injected; a positive status: the
   drivers aren't to be read. [rt] */
ETHD_MUST_CHECK ethd_status ethd__inject_before(ethd__inject *inject, int64_t now_ns, ethd__inject_sense *out) ETHD_RT;

/* After that, with the drivers' status: changes *sense, and returns true if it holds a sample, or faults that go with
   one. [rt] */
bool ethd__inject_after(ethd__inject *inject, ethd_status status, ethd__inject_sense *sense) ETHD_RT;

/* Changes a command. A failure is injected; a positive status: the command is dropped. [rt] */
ETHD_MUST_CHECK ethd_status ethd__inject_command(ethd__inject *inject, ethd__inject_order *command) ETHD_RT;

/* Returns what a unit's service returns in place of its work; ETHD_OK: it does its work. [any I/O thread] */
ETHD_MUST_CHECK ethd_status ethd__inject_service(const ethd__inject *inject, int64_t now_ns);

/* Returns how many faults were injected. [main] */
ethd_figure ethd__inject_figure(const ethd__inject *inject);

#endif
