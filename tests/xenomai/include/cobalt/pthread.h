/* Stand-in: libc's, and what Cobalt adds. */
#include_next <pthread.h>
#ifndef STANDIN_PTHREAD_H
#define STANDIN_PTHREAD_H
#define PTHREAD_WARNSW 0x4000
int pthread_setmode_np(int clear, int set, int *before);
int __cobalt_pthread_create(pthread_t *thread, const pthread_attr_t *attr, void *(*start)(void *), void *arg);
int __cobalt_pthread_join(pthread_t thread, void **value);
#endif
