/* The drive of tests/servo/mock.h as a server of its own, on a TCP port or behind a pseudo terminal, that misbehaves
   now and then:

     trap_server [tcp|rtu] [KIND EVERY [WAIT_US]]     KIND: drop late half cut garble busy old reset

   Says "ready PORT", and ends with its stdin. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "servo/mock.h"

static const char *const kinds[] = {"", "drop", "late", "half", "cut", "garble", "busy", "old", "reset", NULL};
static mock_act trap;
static uint64_t every;

static mock_act act(void *user, uint64_t n, int function) {
  (void)user, (void)function;
  return n % every == every - 1 ? trap : (mock_act){MOCK_ANSWER, 0, 0};
}

int main(int argc, char **argv) {
  static mock drive;
  mock_start(&drive, argc > 1 && !strcmp(argv[1], "rtu"));
  for (int i = 0; argc > 3 && kinds[i]; i++)
    if (!strcmp(kinds[i], argv[2])) trap = (mock_act){(mock_kind)i, 6, argc > 4 ? atol(argv[4]) : 20000};
  every = argc > 3 ? strtoull(argv[3], NULL, 10) : 0;
  if (argc > 2 && (trap.kind == MOCK_ANSWER || !every)) {
    fprintf(stderr, "trap_server: %s: drop late half cut garble busy old reset, and every how many\n", argv[2]);
    return 2;
  }
  if (every) drive.act = act;
  printf("ready %s\n", drive.port);
  fflush(stdout);
  while (read(0, &(char){0}, 1) > 0) continue;
  printf("%llu requests, %llu connections\n", (unsigned long long)drive.requests,
         (unsigned long long)drive.connections);
  return 0;
}
