/* A process of its own that writes zero torque when the program is gone or its I/O thread is silent, for drives that
   hold their last torque for ever. It shares with the I/O thread the line and a page, in which that thread notes at
   every turn that it lives. A loop that hangs is not its affair: then the I/O thread itself sends zero (servo/io.c).

        ethd-run                             guardian
     I/O thread --- beat, armed --->  shared page  ---> looks every millisecond
         |                                                  |  silent for too long, or ethd-run is gone:
         '------ line, passed by a socket -----------------> takes the line, writes zero, then [disable]

   Whatever ends ethd-run ends its side of the socket; what stops it without ending it (a signal, a debugger, a
   deadlock) ends the beats. Zero torque is at the drive within ethd__guardian_bound of the last beat. It can't help
   when the whole computer dies, or when both are killed at once: ethd__guardian_limits. */
#ifndef ETHD__SERVO_GUARDIAN_H
#define ETHD__SERVO_GUARDIAN_H

#include <stdatomic.h>
#include <sys/types.h>

#include "servo/frame.h"
#include "servo/plan.h"

/* Who may write to the line. FREE: the guardian has written and is done; the next user of the line connects anew. */
enum { ETHD__GUARDIAN_OURS, ETHD__GUARDIAN_ITS, ETHD__GUARDIAN_FREE };

/* The shared page. */
typedef struct ethd__guardian_page {
  _Atomic int64_t beat_ns; /* CLOCK_MONOTONIC: the I/O thread lived */
  atomic_int armed;        /* 1: the drive may hold a torque */
  atomic_int line;         /* ETHD__GUARDIAN_OURS, ... */
  atomic_int closing;      /* 1: the program ends in order, and the guardian has nothing to do */
  atomic_uint acts;        /* how often it wrote zero */
  atomic_int spared;       /* 1: the kernel doesn't kill it when memory runs out */
} ethd__guardian_page;

/* The guardian, with what it must know about the drive, ready to be sent. */
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

/* Returns a sentence with the way out where the guardian ends whenever this program ends; else NULL. [main] */
const char *ethd__guardian_ends(void);

/* Writes what else may end both at once where this process runs, for people: a container, a control group that is
   killed as a whole when memory runs out, a service of systemd. "" when nothing is known. `root` is "" or, in tests,
   the folder in which proc and sys are; `spared`: the guardian's process isn't killed for memory. [main] */
void ethd__guardian_limits(const char *root, bool spared, char out[ETHD_MESSAGE_MAX]);

/* Prepares the frames and the limit; starts no process. `plan` is the map's. [main] */
void ethd__guardian_make(const ethd__servo_map *map, const ethd__servo_plan *plan, int64_t exchange_ns,
                         ethd__guardian *out);

/* Starts the process, and returns when it watches. The map outlives it. [main] */
ETHD_MUST_CHECK ethd_status ethd__guardian_start(ethd__guardian *guardian, char message[ETHD_MESSAGE_MAX]);

/* Called before each turn of the link. Returns false when the guardian has taken the line; the link is then lost.
   `fd` is the line as it is now, -1 for none; `connects` counts the lines so far. I/O side. */
bool ethd__guardian_enter(ethd__guardian *guardian, int64_t now_ns, int fd, uint64_t connects);

/* Tells whether the drive may hold a torque from now on. I/O side. */
void ethd__guardian_arm(ethd__guardian *guardian, bool armed);

/* True when the I/O thread has been silent for too long while a torque may act. [any] */
bool ethd__guardian_due(const ethd__guardian *guardian, int64_t now_ns);

/* Takes the line and brings the drive to rest: it writes zero and then [disable], each until it is answered or was
   tried often enough; zeros go out to all units once before one is tried again. Returns whether the drive has answered
   all of it. In the guardian's process. */
bool ethd__guardian_act(ethd__guardian *guardian);

/* Ends the process in order and waits for it; does nothing when there is none. [main] */
void ethd__guardian_end(ethd__guardian *guardian);

#endif
