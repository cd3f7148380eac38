/* Containers, as far as a process of ours must outlive the program: when the first process (PID 1) of a PID namespace
   ends, the kernel kills all others in it (pid_namespaces(7)). An init as PID 1 ends with what it has started. */
#ifndef ETHD__DEVICE_CONTAINER_H
#define ETHD__DEVICE_CONTAINER_H

#include <stdbool.h>

/* True in a PID namespace other than the machine's own. [main] */
bool ethd__in_container(void);

/* How far we are from the first process of our container: 0: we are it; 1: it has started us; more: there are others
   in between. -1: its end isn't ours, because there is no container, we were started from outside (docker exec), or it
   is systemd, which doesn't end with what it starts. [main] */
int ethd__container_depth(void);

/* True when the kernel, out of memory, kills all processes of our control group: memory.oom.group of it, or of one
   around it, is 1. `root` is "" or, in tests, the folder in which proc and sys are. [main] */
bool ethd__group_dies_whole(const char *root);

/* True in the control group of a systemd service; `root` as above. [main] */
bool ethd__group_is_service(const char *root);

#endif
