/* Any bytes, in any two pieces, at any state that the decoder can be in: nothing outside of its memory is touched, the
   position only goes forward and ends at the end, and what it holds stays within bounds. */
#include "../../drivers/proximity_ring/decoder.c"

#define BYTES 46

size_t nondet_size(void);

int main(void) {
  ethd__decoder d;
  uint8_t bytes[BYTES];
  ethd__ring_frame frame;
  size_t cut = nondet_size(), most = nondet_size();
  __CPROVER_assume(cut <= most && most <= BYTES);
  __CPROVER_assume(d.held <= ETHD__FRAME_WIRE);
  const uint8_t *at = bytes, *end = bytes + most;
  for (int k = 0; k < 2; k++) {
    const uint8_t *before = at;
    bool found = ethd__decoder_next(&d, &at, end, &frame);
    __CPROVER_assert(at >= before && at <= end, "forward, and not beyond the end");
    __CPROVER_assert(found || at == end, "all bytes are taken where there is no frame");
    __CPROVER_assert(d.held <= ETHD__FRAME_WIRE, "no more is held than fits");
    if (found) __CPROVER_assert(frame.type == ETHD__FRAME_TYPE, "a frame of the only type");
  }
  return 0;
}
