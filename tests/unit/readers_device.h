/* The readers of what a device says and of register maps, for the table in readers.c. */
#ifndef ETHD_TESTS_READERS_DEVICE_H
#define ETHD_TESTS_READERS_DEVICE_H

#include <stddef.h>

/* A stream of the proximity ring's frames: decoded whole and in pieces, which must agree; a frame that comes out encodes
   to its own bytes. */
int readers_frames(const char *text, size_t length);
extern const char *const readers_frame_words[];

/* A register map that is taken can be used: each cyclic register has its words, each torque stays within its limits. */
int readers_map(const char *text, size_t length);
extern const char *const readers_map_words[];

/* The table of an arm that is taken can be used: its limits are sound, and at its posture the tool has a place. */
int readers_arm(const char *text, size_t length);
extern const char *const readers_arm_words[];

#define ARM_TABLE                                                                                                   \
  "[arm]\nconvention = modified\nsafe = brakes\n[joint1]\nd = 0.3\nleast = -2\nmost = 2\nspeed = 2\n"               \
  "acceleration = 10\ntorque = 9\nposture = 0.5\n[joint2]\na = 0.2\nalpha = 1.5\noffset = 0.1\nleast = -1\n"        \
  "most = 1\nspeed = 2\nacceleration = 10\ntorque = 9\nposture = -0.5\n[base]\nx = 1\nyaw = 0.3\n[tool]\nz = 0.1\n" \
  "facing_z = -1\n[servo]\nfrequency = 100\ndamping = 0.7\ndelay = 0.03\nrate = 500\n"                              \
  "[inverse]\nsingular = 0.02\npull = 1\nturn = 5\n"

#define MAP_TORQUE "[register torque1]\ndirection=write\naddress=0\ntype=i16\nunit=Nm\nmin=-1\nmax=1\n"
#define MAP_INTEGER(name, address, more) "[register " name "]\ndirection=read\naddress=" address "\ntype=u16\n" more

/* Everything that an ordinary map has: a watchdog, steps, a finger's reading. */
#define MAP_TCP                                                                                                       \
  "[bus]\ntransport=tcp\nport=a:1\n[watchdog]\nkind=counter\ntime=0.1\nresumes=yes\n" MAP_TORQUE MAP_INTEGER(         \
      "position1", "65535",                                                                                           \
      "unit=rad\n") "[register counter]\ndirection=write\naddress=9\ntype=u16\n" MAP_INTEGER("measured1", "3",        \
                                                                                             "unit=A\ntorque_"        \
                                                                                             "constant=1\ntolerance=" \
                                                                                             "1\n")                   \
      MAP_INTEGER("bus_voltage", "4", "unit=V\nmin=1\nmax=9\n")                                                       \
          MAP_INTEGER("s", "2", "fault_mask=0xF1\nhealthy=0x10\nenabled_mask=2\nenabled=2\n") MAP_INTEGER(            \
              "reading_x", "5", "unit=m\n") MAP_INTEGER("reading_y", "6", "unit=m\n")                                 \
              MAP_INTEGER("reading_count", "7", "") MAP_INTEGER(                                                      \
                  "reading_age", "8",                                                                                 \
                  "unit=s\n") "[register c]\ndirection=write\naddress=10\ntype=u16\n[enable]\nstep1=write c 0x0F\n"   \
                              "step2=wait s 0x3 2 0.5\nstep3=pause 0.1\n[disable]\nstep1=write c 0\n[identify]\n"     \
                              "step1=wait s 1 0 1\n"

#define MAP_SERIAL                                                                                               \
  "[bus]\ntransport=rtu\nport=/dev/x\nbaud=400000\nformat=8E1\nbase=1\ngap=2\nexchange=combined\nsilence=0\n"    \
  "[register torque2]\ndirection=write\naddress=0x10\ntype=i32\norder=low-first\nunit=A\nscale=0.01\n"           \
  "torque_constant=0.04\nmin=-2\nmax=2\nratio=12\nsign=-1\necho=e\n[register e]\ndirection=read\naddress=0x10\n" \
  "type=i32\norder=low-first\n[register position2]\ndirection=read\naddress=20\ntype=i32\norder=high-first\n"    \
  "unit=count\ncounts=4000\nbits=24\n"

#define MAP_VALUES                                                                                                \
  "[bus]\ntransport=tcp\nport=a:1\naddressing=values\n[register torque1]\ndirection=write\naddress=1\ntype=f32\n" \
  "order=high-first\nunit=Nm\noffset=0.5\nmin=-1\nmax=1\n[register position1]\ndirection=read\nspace=input\n"     \
  "address=1\ntype=f32\norder=low-first\nunit=turn\n[register speed1]\ndirection=read\nspace=input\naddress=2\n"  \
  "type=u32\norder=high-first\nunit=rpm\n"

#endif
