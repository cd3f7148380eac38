/* The count in a .npy's header, of any bytes: nothing outside of the text is read, and a count has at most 18
   digits. */
#include "../../drivers/runtime/record/npy_header.c"

#define BYTES 32

size_t nondet_size(void);

int main(void) {
  char text[BYTES];
  size_t from = nondet_size(), count = 0;
  __CPROVER_assume(from <= BYTES);
  if (read_count(text + from, text + BYTES, &count)) {
    __CPROVER_assert(count < 1000000000000000000u, "at most 18 digits");
    __CPROVER_assert(text[BYTES - 1] == '\n', "it ends with a newline");
  }
  return 0;
}
