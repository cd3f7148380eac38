/* Containers can end a process that must outlive the program: when the first process (PID 1) of a PID namespace ends,
   the kernel kills all others in it (pid_namespaces(7)). An init as PID 1 ends with the program it started. */
#ifndef ETHD__DEVICE_CONTAINER_H
#define ETHD__DEVICE_CONTAINER_H

#include <stdbool.h>

/* True in a PID namespace other than the machine's own. [main] */
bool ethd__in_container(void);

/* Our distance from the first process of our container: 0: we are it; 1: it has started us; more: there are others in
   between. -1: it doesn't end with us, because there is no container, we were started from outside (docker exec), or it
   is systemd, which outlives its children. [main] */
int ethd__container_depth(void);

/* True when the kernel, out of memory, kills all processes of our control group: memory.oom.group of it, or of one
   around it, is 1. `root` is "" or, in tests, the folder of proc and sys. [main] */
bool ethd__group_dies_whole(const char *root);

/* True in the control group of a systemd service; `root` as above. [main] */
bool ethd__group_is_service(const char *root);

#endif
