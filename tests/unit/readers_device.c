#include "unit/readers_device.h"

#include <math.h>
#include <string.h>

#include "arm/motion.h"
#include "proximity_ring/decoder.h"
#include "servo/plan.h"
#include "servo/words.h"

/* ---- frames ---- */

typedef struct decoded {
  uint64_t sum, frames;
  ethd__decoder_counters counters;
} decoded;

static void add(decoded *d, const ethd__ring_frame *f) {
  uint64_t part = f->seq + ((uint64_t)f->t_us << 16) + ((uint64_t)f->lost << 48);
  for (int k = 0; k < ETHD__FRAME_SENSORS; k++) part = part * 31 + f->counts[k];
  d->sum = (d->sum ^ part) * 0x9e3779b97f4a7c15u;
  d->frames++;
}

/* Returns false if a frame came out that its bytes don't say. */
static bool decode(const uint8_t *bytes, size_t length, size_t piece, decoded *out) {
  ethd__decoder decoder = {0};
  ethd__ring_frame frame;
  bool good = true;
  memset(out, 0, sizeof *out);
  for (size_t from = 0; from < length; from += piece) {
    const uint8_t *at = bytes + from, *end = length - from < piece ? bytes + length : at + piece;
    while (ethd__decoder_next(&decoder, &at, end, &frame)) {
      uint8_t wire[ETHD__FRAME_WIRE];
      ethd__frame_encode(&frame, wire);
      good &= at >= bytes + sizeof wire && memcmp(wire, at - sizeof wire, sizeof wire) == 0;
      add(out, &frame);
    }
  }
  out->counters = decoder.counters;
  return good && out->counters.frames == out->frames;
}

int readers_frames(const char *text, size_t length) {
  decoded whole, parts;
  if (!decode((const uint8_t *)text, length, length + !length, &whole)) return -1;
  for (size_t piece = 1 + length % 7; piece < 100; piece += 7)
    if (!decode((const uint8_t *)text, length, piece, &parts) || memcmp(&whole, &parts, sizeof whole) != 0) return -1;
  return whole.frames > 0;
}

/* The last is a frame without the 0 at its end. */
const char *const readers_frame_words[] = {
    "\x01",
    "\x05zzzz",
    "\xff",
    "\x1f",
    "\x02\x01\x02\x01\x03\x05\x0d\x01\x02\x01\x21\xe9\x03\xd1\x07\xb9\x0b\xa1\x0f\x89\x13\x71"
    "\x17\x59\x1b\x41\x1f\x29\x23\x11\x27\xf9\x2a\xe1\x2e\xc9\x32\xb1\x36\x99\x3a\x7b\x55",
    NULL};

/* ---- maps ---- */

static ethd__servo_map map;

static bool torque_is_within(const ethd__servo_register *r, uint16_t *words) {
  for (double torque = -10; torque <= 10; torque += 10) {
    ethd__servo_pack(r, ethd__servo_raw(r, torque), words);
    double value = r->scale * ethd__servo_unpack(r, words) + r->offset, some = 1e-6 * (fabs(r->min) + fabs(r->max));
    if (!(value >= r->min - some && value <= r->max + some)) return false;
  }
  return true;
}

static bool can_be_used(void) {
  static ethd__servo_plan plan;
  ethd__servo_plan_make(&map, &plan);
  for (uint32_t i = 0; i < map.count; i++) {
    const ethd__servo_register *r = &map.registers[i];
    if (!r->cyclic) continue;
    if (plan.block[i] < 0) return false;
    uint16_t *words = ethd__servo_plan_words(&plan, &map, (int32_t)i);
    if (r->role == ETHD__SERVO_TORQUE1 || r->role == ETHD__SERVO_TORQUE2) {
      if (!torque_is_within(r, words)) return false;
    } else {
      (void)ethd__servo_joint(r, ethd__servo_unpack(r, words));
    }
  }
  for (uint32_t i = 0; ethd__servo_risk(&map, i); i++) continue;
  return true;
}

int readers_map(const char *text, size_t length) {
  char message[ETHD_MESSAGE_MAX] = "";
  ethd_status status = ethd__servo_map_parse(text, length, "x", &map, message);
  if (status == ETHD_OK) return can_be_used() ? 1 : -1;
  return status < 0 && message[0] == 'x' && message[1] == ':' && !strpbrk(message, "\n\r\033") ? 0 : -1;
}

const char *const readers_map_words[] = {"\n[register torque1]\n",
                                         "[register measured2]",
                                         "\n",
                                         "=",
                                         "0x",
                                         "[",
                                         "]",
                                         "nan",
                                         "65536",
                                         "; c",
                                         "-0.0",
                                         "1e999",
                                         "echo=e\n",
                                         "step1=",
                                         "wait s 1 1 1\n",
                                         "type=f32\n",
                                         "order=low-first\n",
                                         "min=-1e300\n",
                                         "max=",
                                         "direction=write\n",
                                         "unit=A\n",
                                         "scale=1e-9\n",
                                         "=0",
                                         "=1",
                                         "=-1",
                                         "=2",
                                         "=17",
                                         "=32",
                                         "=65535",
                                         "=0xFFFF",
                                         "=1e-9",
                                         "=-1e12",
                                         "=1e9",
                                         "=0.1",
                                         "=i16",
                                         "=u16",
                                         "=u32",
                                         "=f32",
                                         "=A",
                                         "=Nm",
                                         "=count",
                                         "=rad",
                                         "=input",
                                         "=read",
                                         "=write",
                                         "=rtu",
                                         "=low-first",
                                         "=silence",
                                         "=yes",
                                         "=combined",
                                         "=values",
                                         "=wait s 1 1 1",
                                         "=pause 1",
                                         "=write c 65535",
                                         "=torque1",
                                         NULL};

/* ---- arms ---- */

int readers_arm(const char *text, size_t length) {
  ethd__arm_table table;
  ethd__arm_motion motion;
  char message[ETHD_MESSAGE_MAX] = "";
  const ethd_status status = ethd__arm_table_parse(text, length, "x", &table, message);
  if (status != ETHD_OK)
    return status < 0 && message[0] == 'x' && message[1] == ':' && !strpbrk(message, "\n\r\033") ? 0 : -1;
  ethd__arm_motion_start(&table, NULL, &motion);
  (void)ethd__arm_motion_step(&motion, (ethd_vec3){0.1, -0.1, 0.1}, NULL);
  const ethd_vec3 x = motion.tool.x;
  return ethd_joint_limits_check(&table.limits, NULL) == ETHD_OK && isfinite(x.x + x.y + x.z) ? 1 : -1;
}

const char *const readers_arm_words[] = {"\n[joint3]\n", "[joint8]", "\n",     "=", "nan",      "inf",
                                         "1e999",        "-6.3",     "6.3",    "0", "[base]\n", "a = 3\n",
                                         "; c",          "standard", "1e-300", NULL};
