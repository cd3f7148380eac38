/* What every header needs: attributes of functions, and the status that a function returns. Links from libethd.

   Thread tags close every contract in these headers:
     [main]  the thread that created the object; may allocate and block
     [rt]    the control thread: bounded work, no heap, lock, system call, errno or stdio
     [any]   any thread, as the contract says
   ETHD_RT marks prototypes and function-pointer types of the [rt] side; clang 20 and later
   checks it with -Wfunction-effects. */
#ifndef ETHD_BASE_H
#define ETHD_BASE_H

#include <stddef.h>

#ifdef __cplusplus
#define ETHD_BEGIN_DECLS extern "C" {
#define ETHD_END_DECLS }
#else
#define ETHD_BEGIN_DECLS
#define ETHD_END_DECLS
#endif

#define ETHD_API __attribute__((visibility("default")))
#define ETHD_MUST_CHECK __attribute__((warn_unused_result))

#if defined(__clang__) && __clang_major__ >= 20
#define ETHD_RT __attribute__((nonblocking))
#else
#define ETHD_RT
#endif

ETHD_BEGIN_DECLS

/* One enum for every function that can fail: 0 ok, negative failure, positive condition. X(name, value, sentence) */
#define ETHD_STATUSES(X)                                                         \
  X(OK, 0, "done")                                                               \
  X(STATUS_BUSY, 1, "the receiver has not taken the last one yet")               \
  X(STATUS_STALE, 2, "no newer value has come")                                  \
  X(STATUS_EMPTY, 3, "nothing is waiting")                                       \
  X(E_ARGUMENT, -1, "an argument is missing or contradicts another")             \
  X(E_RANGE, -2, "a value is out of its range")                                  \
  X(E_NOT_FINITE, -3, "a value is not a finite number")                          \
  X(E_MEMORY, -4, "no memory")                                                   \
  X(E_UNKNOWN, -5, "an unknown name")                                            \
  X(E_DUPLICATE, -6, "a name or key occurs twice")                               \
  X(E_SYNTAX, -7, "text that cannot be read")                                    \
  X(E_GEOMETRY, -8, "an impossible shape: degenerate or self-intersecting")      \
  X(E_UNREACHABLE, -9, "out of the arm's reach")                                 \
  X(E_ABI, -10, "a plugin of another ABI; rebuild it against these headers")     \
  X(E_SIZE, -11, "a struct of other headers; compile again with this version's") \
  X(E_STATE, -12, "a law's state is over 512 bytes")                             \
  X(E_TABLE, -13, "a bad parameter table")                                       \
  X(E_SYMBOL, -14, "a plugin without the symbol ethd_plugin")                    \
  X(E_LOAD, -15, "a file that cannot be loaded as a plugin")                     \
  X(E_LAW, -16, "a law reported a failure")                                      \
  X(E_BUDGET, -17, "a law ran over its time budget")                             \
  X(E_FULL, -18, "no room is left")                                              \
  X(E_FILE, -19, "a file that cannot be read or written")                        \
  X(E_DEVICE, -20, "the device refused or failed")                               \
  X(E_DIFFERS, -21, "a replay that differs from its recording")                  \
  X(E_UNFINISHED, -22, "a recording that its program did not close")             \
  X(E_FENCE, -23, "a law wrote outside of its state block")                      \
  X(E_FENV, -24, "a law changed rounding or flushing of numbers")

typedef enum ethd_status {
#define ETHD_STATUS_VALUE(name, value, sentence) ETHD_##name = (value),
  ETHD_STATUSES(ETHD_STATUS_VALUE)
#undef ETHD_STATUS_VALUE
} ethd_status;

/* Returns the sentence of a status, or "an unknown status" for any other number. [any, rt-safe] */
ETHD_API const char *ethd_status_sentence(ethd_status status) ETHD_RT;

#define ETHD_MESSAGE_MAX 512 /* bytes of a one-line message to the user about a failure */

/* A failure as data: the library formats no text. `name` is the parameter, word or file that caused the failure
   ("contact.k_e"), cut to fit; `line` is 1-based, 0 without text; `found`, `min` and `max` are NaN for a failure
   without numbers. */
typedef struct ethd_error {
  ethd_status status;
  int line;
  char name[64];
  double found;
  double min, max;
} ethd_error;

ETHD_END_DECLS

#endif
