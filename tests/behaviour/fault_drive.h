/* The drive of a fault rig: its encoders' counts, its registers, what it answers, when it lets go. */
#ifndef ETHD_TESTS_FAULT_DRIVE_H
#define ETHD_TESTS_FAULT_DRIVE_H

#include "behaviour/fault_rig.h"

#define FAULT_RATIO 9.80
#define FAULT_TORQUE_UNIT 1e-4 /* Nm at the motor, of apps/config/plant.map */

void fault_drive_counts(fault_rig *r);    /* where the kernel's stand-in shows them */
void fault_drive_registers(fault_rig *r); /* of apps/config/plant.map */
mock_act fault_drive_act(void *rig, uint64_t n, int function);

/* A drive that isn't asked for a while lets go by itself. */
void fault_drive_watch(fault_rig *r);

/* Writes apps/config/plant.map with another patience. */
void fault_drive_map(const char *path);

#endif
