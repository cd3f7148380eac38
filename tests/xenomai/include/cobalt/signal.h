/* Stand-in. */
#include_next <signal.h>
#ifndef STANDIN_SIGNAL_H
#define STANDIN_SIGNAL_H
#define SIGDEBUG SIGXCPU
#endif
