/* Stand-in: two names for a call, the core's and libc's. */
#ifndef STANDIN_WRAPPERS_H
#define STANDIN_WRAPPERS_H
#ifdef __COBALT__
#define __RT(call) __cobalt_##call
#else
#define __RT(call) call
#endif
#define __STD(call) call
#endif
