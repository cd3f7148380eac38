/* A process of its own that writes zero torque when the program is gone or its I/O thread is silent, for drives that
   hold their last torque for ever. It shares with the I/O thread the line and a page, in which that thread
   writes a beat in every cycle. If the loop hangs, the I/O thread itself sends zero (servo/io.c).

        ethd-run                             guardian
     I/O thread --- beat, armed --->  shared page  ---> looks every millisecond
         |                                                  |  silent for too long, or ethd-run is gone:
         '------ line, passed by a socket -----------------> takes the line, writes zero, then [disable]

   Any end of ethd-run closes its side of the socket; a stop without an end (a signal, a debugger, a deadlock) ends the
   beats. Zero torque is at the drive within ethd__guardian_bound of the last beat. It can't help if the whole
   computer fails, or if both are killed at once: ethd__guardian_limits. */
#ifndef ETHD__SERVO_GUARDIAN_H
#define ETHD__SERVO_GUARDIAN_H

#include <stdatomic.h>
#include <sys/types.h>

#include "servo/frame.h"
#include "servo/plan.h"

/* Who may write to the line. FREE: the guardian has finished; the next user of the line reconnects. */
enum { ETHD__GUARDIAN_OURS, ETHD__GUARDIAN_ITS, ETHD__GUARDIAN_FREE };

/* The shared page. */
typedef struct ethd__guardian_page {
  _Atomic int64_t beat_ns; /* CLOCK_MONOTONIC: the I/O thread's last beat */
  atomic_int armed;        /* 1: the drive may hold a torque */
  atomic_int line;         /* ETHD__GUARDIAN_OURS, ... */
  atomic_int closing;      /* 1: a normal end of the program, without work for the guardian */
  atomic_uint acts;        /* how many times it wrote zero */
  atomic_int spared;       /* 1: the kernel doesn't kill it when memory runs out */
} ethd__guardian_page;

/* The guardian, with its prepared frames for the drive. */
typedef struct ethd__guardian {
  const ethd__servo_map *map;
  ethd__guardian_page *page; /* NULL: there is none */
  int socket;                /* -1: closed */
  int line;                  /* descriptor in the guardian's process; -1: none yet */
  pid_t process;
  int64_t limit_ns;  /* a beat older than this is silence */
  uint64_t connects; /* the link's count of connections when the line was last passed on */
  bool passed;       /* the guardian holds a line of ours */
  uint32_t zero_count, disable_count;
  ethd__servo_frame zeros[ETHD__SERVO_WRITES_MAX], disables[ETHD__SERVO_STEPS_MAX];
} ethd__guardian;

/* ns from the I/O thread's last beat to zero torque at the drive: the larger of 20 ms and two message spacings. A
   spacing is an exchange, or the time that one unanswered message may take. [any] */
int64_t ethd__guardian_bound(const ethd__servo_map *map, int64_t exchange_ns);

/* If the guardian ends whenever this program ends, returns a sentence with the remedy; else NULL. [main] */
const char *ethd__guardian_ends(void);

/* Writes, for people, what else may end both processes at once here: a container, a control group that is killed as a
   whole if memory runs out, a service of systemd. "" if nothing is known. `root` is "" or, in tests,
   the folder in which proc and sys are; `spared`: the guardian's process isn't killed for memory. [main] */
void ethd__guardian_limits(const char *root, bool spared, char out[ETHD_MESSAGE_MAX]);

/* Prepares the frames and the limit; starts no process. `plan` is the map's. [main] */
void ethd__guardian_make(const ethd__servo_map *map, const ethd__servo_plan *plan, int64_t exchange_ns,
                         ethd__guardian *out);

/* Starts the process, and returns once it watches. The map outlives it. [main] */
ETHD_MUST_CHECK ethd_status ethd__guardian_start(ethd__guardian *guardian, char message[ETHD_MESSAGE_MAX]);

/* Called before each cycle of the link. Returns false when the guardian has taken the line; the link is then lost.
   `fd` is the present line, -1 for none; `connects` counts the lines so far. I/O side. */
bool ethd__guardian_enter(ethd__guardian *guardian, int64_t now_ns, int fd, uint64_t connects);

/* Sets whether the drive may hold a torque from now on. I/O side. */
void ethd__guardian_arm(ethd__guardian *guardian, bool armed);

/* True when the I/O thread has been silent for too long while a torque may act. [any] */
bool ethd__guardian_due(const ethd__guardian *guardian, int64_t now_ns);

/* Takes the line and brings the drive to rest: it writes zero and then [disable], each until it is answered or has used
   up its attempts. All units get zero once before any is tried again. Returns whether the drive has answered all. In
   the guardian's process. */
bool ethd__guardian_act(ethd__guardian *guardian);

/* Ends the process in order and waits for it; does nothing when there is none. [main] */
void ethd__guardian_end(ethd__guardian *guardian);

#endif
