/* Stand-in. */
#ifndef STANDIN_INIT_H
#define STANDIN_INIT_H
void xenomai_init(int *argcp, char *const **argvp);
#endif
