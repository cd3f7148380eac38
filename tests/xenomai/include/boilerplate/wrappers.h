/* Stand-in: two names for a call, the core's and libc's; as in the real one, libc's is a __real_ that not each call
   has. */
#ifndef STANDIN_WRAPPERS_H
#define STANDIN_WRAPPERS_H
#ifdef __COBALT__
#define __RT(call) __cobalt_##call
#define __STD(call) __real_##call
#else
#define __RT(call) call
#define __STD(call) call
#endif
#endif
