/* Of a frame's bytes, whatever they are: undoing COBS touches nothing outside of the frame and ends. Of a piece of any
   length, at any state: no more is held than fits. */
#include "../../drivers/proximity_ring/decoder.c"

size_t nondet_size(void);

int main(void) {
  ethd__decoder d;
  uint8_t coded[CODED], raw[ETHD__FRAME_SIZE], bytes[ETHD__FRAME_WIRE + 4];
  size_t count = nondet_size();
  for (int i = 0; i < CODED; i++) __CPROVER_assume(coded[i] != 0); /* a piece holds no zero: zeros end it */
  (void)uncobs(coded, raw);
  __CPROVER_assume(count <= sizeof bytes && d.held <= ETHD__FRAME_WIRE);
  hold(&d, bytes, count);
  __CPROVER_assert(d.held <= ETHD__FRAME_WIRE, "no more is held than fits");
  return 0;
}
