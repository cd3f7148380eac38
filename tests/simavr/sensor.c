#include "sensor.h"

enum { ADDRESS = 0x13, COMMAND = 0x80, PRODUCT = 0x81, CURRENT = 0x83, HIGH = 0x87, LOW = 0x88, TIMING = 0x8A };
enum {
  MEASURE = 0x08,
  READY = 0x20,
  LOCK = 0x80,
  ID = 0x11,
  CURRENT_AT_START = 2,
  CURRENT_OF_LEVEL = 10,
  SLOW = 32000
};

void sensor_power(sensor *s, int number, bus_times *times) {
  uint16_t level = s->level;
  bool mute = s->mute, slow = s->slow;
  *s = (sensor){.level = level,
                .mute = mute,
                .slow = slow,
                .current = CURRENT_AT_START,
                .scl = true,
                .sda = true,
                .times = times};
  s->convert = 16 * (170 + (uint64_t)(number * 7 % 16) * 230 / 15);
}

bool sensor_pulls(const sensor *s) { return s->shorted || (!s->mute && (s->pulls || s->stuck > 0)); }

/* ---- registers ---- */

static void settle(sensor *s, uint64_t now) {
  if (!s->measuring || now < s->began + (s->slow ? SLOW : s->convert)) return;
  s->measuring = false;
  s->ready = true;
  s->result = s->seen;
}

static uint8_t get(sensor *s, uint64_t now) {
  settle(s, now);
  switch (s->pointer) {
  case COMMAND: return LOCK | (s->ready ? READY : 0);
  case PRODUCT: return ID;
  case CURRENT: return s->current;
  case TIMING: return s->timing;
  case HIGH: s->ready = false; return (uint8_t)(s->result >> 8);
  case LOW: s->ready = false; return (uint8_t)s->result;
  default: return 0;
  }
}

static void put(sensor *s, uint8_t value, uint64_t now) {
  if (s->pointer == CURRENT) s->current = value & 0x3F;
  if (s->pointer == TIMING) s->timing = value;
  if (s->pointer != COMMAND || !(value & MEASURE) || s->measuring) return;
  s->measuring = s->begun = true;
  s->ready = false;
  s->began = now;
  uint32_t seen = (uint32_t)s->level * s->current / CURRENT_OF_LEVEL;
  s->seen = seen > 0xFFFF ? 0xFFFF : (uint16_t)seen;
}

/* ---- bus ---- */

static void least(uint64_t *least, uint64_t value) {
  if (!*least || value < *least) *least = value;
}

static void most(uint64_t *most, uint64_t value) {
  if (value > *most) *most = value;
}

/* A byte has come in; whether it is acknowledged. */
static bool heard(sensor *s, uint64_t now) {
  int byte = s->byte++;
  if (byte == 0) {
    s->reads = s->shift & 1;
    return s->shift >> 1 == ADDRESS;
  }
  if (byte == 1)
    s->pointer = s->shift;
  else {
    put(s, s->shift, now);
    s->pointer++;
  }
  return true;
}

static void load(sensor *s, uint64_t now) {
  s->shift = get(s, now);
  s->pointer++;
  s->byte++;
}

static void fell(sensor *s, uint64_t now) {
  if (s->stuck > 0) s->stuck--;
  if (s->mode == SENSOR_LISTEN) {
    if (s->bit == 8) {
      s->pulls = heard(s, now);
      if (!s->pulls) s->mode = SENSOR_DEAF;
      s->bit++;
    } else if (s->bit == 9) {
      s->pulls = false;
      s->bit = 0;
      if (s->reads) s->mode = SENSOR_TALK;
    }
  }
  if (s->mode == SENSOR_TALK) {
    if (s->bit == 9) s->bit = 0;
    if (s->bit == 0) load(s, now);
    s->pulls = s->bit < 8 && !(s->shift >> (7 - s->bit) & 1);
  }
}

static void rose(sensor *s) {
  if (s->mode == SENSOR_LISTEN && s->bit < 8) {
    s->shift = (uint8_t)(s->shift << 1 | s->sda);
    s->bit++;
  } else if (s->mode == SENSOR_TALK) {
    if (s->bit == 8 && s->sda) s->mode = SENSOR_DEAF; /* not acknowledged: enough */
    s->bit++;
  }
}

static void start(sensor *s, uint64_t now) {
  bool again = s->mode != SENSOR_IDLE;
  if (!again) {
    if (s->stopped && now - s->stopped < BUS_FREE) s->times->hurried++;
    s->started = now;
  } else if (now - s->scl_rose < BUS_HOLD)
    s->times->hurried++;
  s->mode = SENSOR_LISTEN;
  s->byte = s->bit = 0;
  s->reads = s->pulls = false;
}

static void stop(sensor *s, uint64_t now) {
  bus_times *t = s->times;
  uint64_t spent = now - s->started;
  if (now - s->scl_rose < BUS_HOLD) t->hurried++;
  if (s->mode != SENSOR_IDLE && s->reads && s->byte >= 2) least(&t->get_min, spent), most(&t->get_max, spent);
  if (s->mode == SENSOR_LISTEN && s->byte == 3) least(&t->put_min, spent), most(&t->put_max, spent);
  s->mode = SENSOR_IDLE;
  s->pulls = false;
  s->stopped = now;
}

static void clock_times(sensor *s, uint64_t now, bool scl) {
  bus_times *t = s->times;
  if (s->mode != SENSOR_IDLE) {
    uint64_t since = now - (scl ? s->scl_fell : s->scl_rose);
    if (scl)
      least(&t->low_min, since);
    else if (s->scl_rose > s->started)
      least(&t->high_min, since);
    if (scl && s->scl_rose > s->started) least(&t->bit_min, now - s->scl_rose);
    if (since < (scl ? BUS_LOW : BUS_HIGH)) t->hurried++;
  }
  if (scl)
    s->scl_rose = now;
  else
    s->scl_fell = now;
}

void sensor_lines(sensor *s, uint64_t now, bool scl, bool sda) {
  bool before = s->sda, clocked = s->scl;
  s->sda = sda && !sensor_pulls(s);
  s->scl = scl;
  if (s->mute) return;
  if (scl != clocked) {
    clock_times(s, now, scl);
    if (scl)
      rose(s);
    else
      fell(s, now);
    s->sda = sda && !sensor_pulls(s);
  } else if (scl && s->sda != before) {
    if (before)
      start(s, now);
    else
      stop(s, now);
  }
}
