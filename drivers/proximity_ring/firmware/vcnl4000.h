/* The VCNL4000 as far as it is used here: proximity on demand. */
#ifndef VCNL4000_H
#define VCNL4000_H

#define VCNL4000_ADDRESS 0x13

#define VCNL4000_COMMAND 0x80
#define VCNL4000_MEASURE 0x08 /* start one proximity reading */
#define VCNL4000_READY 0x20   /* its result is there; reading the result clears it */

#define VCNL4000_PRODUCT 0x81
#define VCNL4000_PRODUCT_ID 0x10 /* high nibble; the low one is the revision */

#define VCNL4000_CURRENT 0x83 /* of the emitter, 10 mA a step, at most 20 */
#define VCNL4000_RESULT 0x87  /* high byte, then low */
#define VCNL4000_TIMING 0x8A  /* of the modulator */
#define VCNL4000_TIMING_ADVISED 0x81

#endif
