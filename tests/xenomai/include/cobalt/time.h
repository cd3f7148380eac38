/* Stand-in: libc's, and the core's calls. */
#include_next <time.h>
#ifndef STANDIN_TIME_H
#define STANDIN_TIME_H
int __cobalt_clock_gettime(clockid_t clock, struct timespec *now);
int __cobalt_clock_nanosleep(clockid_t clock, int flags, const struct timespec *until, struct timespec *left);
#endif
