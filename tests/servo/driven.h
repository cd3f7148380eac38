/* A servo in lock-step on a virtual clock, before a drive of our own behind a real connection: what its tests share. */
#ifndef ETHD_TESTS_SERVO_DRIVEN_H
#define ETHD_TESTS_SERVO_DRIVEN_H

#include "ethd/driver.h"
#include "servo/device.h"
#include "servo/mock.h"
#include "unit/rig.h"

#define COUNT (2 * 3.14159265358979323846 / (4000 * 9.8)) /* rad */
#define NM (1 / 9.8 / 1e-4)                               /* raw of 1 Nm at the joint */
#define TICK 1000000                                      /* ns */

extern const ethd_driver *const servo;
extern ethd_setup setup;
extern mock drive;
extern void *device;
extern char message[ETHD_MESSAGE_MAX], folder[];
extern int64_t now;
extern ethd_sense sense; /* of the last tick */
extern ethd_status last; /* of its read */
extern int is_virtual;

/* Opens the servo with these settings; on failure `device` is NULL. */
ethd_status open_with(ethd_setting *settings, uint32_t count);

/* Starts the drive and opens the servo with the plant's map; start_device enables it, too. close_device ends both. */
void open_device(void);
void start_device(void);
void close_device(void);

/* Makes one tick as the loop does. Returns the status of the read. */
ethd_status tick(double torque1, double torque2);

/* The text of the plant's map, which the caller frees. */
char *map_text(void);

/* Starts the drive and opens the servo with another map; `more`: a third setting, or NULL. */
ethd_status open_map(const char *text, const ethd_setting *more);

/* The same with the plant's map, after replacing `was` by `now_`. */
ethd_status open_changed(const char *was, const char *now_);

/* Whether the last tick shows a row of the fault table. */
int shows(ethd_fault row);

/* Ticks until a row shows; most + 1: it doesn't. */
int ticks_until(ethd_fault row, int most);

/* A word of the drive as a signed number. */
int32_t raw(int at);

/* The drive's answers to the next `count` requests go wrong in this way. */
void spoil(uint64_t count, mock_kind kind, int code);

/* For FIXTURE: the plant's map in a folder of its own. Its time limit for an answer is long, so that a busy machine isn't taken
   for a fault. */
void driven_set_up(void);
void driven_tear_down(void);

#endif
