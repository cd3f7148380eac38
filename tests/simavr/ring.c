#include "ring.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <avr_extint.h>
#include <avr_ioport.h>
#include <avr_uart.h>
#include <sim_core.h>
#include <sim_elf.h>
#include <sim_io.h>

/* Registers of the ATmega328P by their data address. */
enum { PINB = 0x23, DDRB, PORTB, PINC, DDRC, PORTC, PIND, DDRD, PORTD, UCSR0A = 0xC0, UBRR0L = 0xC4, UBRR0H };
enum { LANE_SCL = 1, LINK_SDA = 1 << 4, LINK_SCL = 1 << 5, START = 1 << 2, STRAPS = 7 << 5, U2X = 2 };

/* Boards run one after the other for this long: what one does to a wire the others see that much later at most. */
enum { SLICE = 8 };

static void note(ring_range *range, uint64_t value) {
  if (!range->count++ || value < range->min) range->min = value;
  if (value > range->max) range->max = value;
  range->sum += value;
}

static void level(avr_t *avr, int pin_register, int mask, bool high) {
  uint8_t *pins = &avr->data[pin_register];
  *pins = (uint8_t)(high ? *pins | mask : *pins & ~mask);
}

/* ---- wires ---- */

static void note_begin(ring_board *b, int lane) {
  sensor *s = &b->sensor[lane];
  long board = b - b->ring->board;
  const sensor *facing = &b->ring->board[(board + 2) % RING_BOARDS].sensor[lane];
  if (!s->begun) return;
  note(&b->ring->begin[(lane + board / 2 * 2) % RING_LANES], s->began - b->ring->start);
  b->ring->faced += facing->measuring && s->began < facing->began + facing->convert;
  s->begun = false;
}

static void lane_wires(ring_board *b) {
  bool scl = !(b->ddr_b & LANE_SCL) && !b->scl_shorted;
  level(b->avr, PINB, LANE_SCL, scl);
  for (int lane = 0; lane < RING_LANES; lane++) {
    bool sda = !(b->ddr_c >> lane & 1);
    sensor_lines(&b->sensor[lane], b->avr->cycle, scl, sda);
    level(b->avr, PINC, 1 << lane, sda && !sensor_pulls(&b->sensor[lane]));
    note_begin(b, lane);
  }
}

static void link_wires(ring *r) {
  for (int n = 0; n < RING_BOARDS; n++) {
    level(r->board[n].avr, PINC, LINK_SDA, two_wire_sda(&r->link));
    level(r->board[n].avr, PINC, LINK_SCL, two_wire_scl(&r->link));
  }
}

static void start_wire(ring *r, uint64_t now) {
  bool low = false;
  for (int n = 0; n < RING_BOARDS; n++) low = low || r->board[n].ddr_d & START;
  if (low == r->started) return;
  r->started = low;
  if (low) {
    if (r->start) note(&r->period, now - r->start);
    r->start = now;
  }
  for (int n = 0; n < RING_BOARDS; n++)
    if (!r->board[n].deaf) avr_raise_irq(avr_io_getirq(r->board[n].avr, AVR_IOCTL_IOPORT_GETIRQ('D'), 2), !low);
}

static void ddr_b(struct avr_irq_t *irq, uint32_t value, void *param) {
  (void)irq;
  ring_board *b = param;
  b->ddr_b = (uint8_t)value;
  lane_wires(b);
}

static void ddr_c(struct avr_irq_t *irq, uint32_t value, void *param) {
  (void)irq;
  ring_board *b = param;
  uint8_t changed = b->ddr_c ^ (uint8_t)value;
  b->ddr_c = (uint8_t)value;
  lane_wires(b);
  if (!(changed & (LINK_SDA | LINK_SCL))) return;
  two_wire_pins(&b->ring->link, b->number, value & LINK_SDA, value & LINK_SCL);
  link_wires(b->ring);
}

static void ddr_d(struct avr_irq_t *irq, uint32_t value, void *param) {
  (void)irq;
  ring_board *b = param;
  b->ddr_d = (uint8_t)value;
  start_wire(b->ring, b->avr->cycle);
}

static void transmitted(struct avr_irq_t *irq, uint32_t value, void *param) {
  (void)irq;
  ring_board *b = param;
  if (!value) note(&b->ring->last_byte, b->avr->cycle - b->ring->start);
  b->ring->sent(b->ring->context, (uint8_t)value);
}

void ring_touch(ring *r) {
  for (int n = 0; n < RING_BOARDS; n++) lane_wires(&r->board[n]);
  link_wires(r);
}

/* ---- cores ---- */

static bool sleeps_until(const avr_t *avr, uint64_t until) {
  return avr->state == cpu_Sleeping && !avr->interrupt_state && avr->cycle_timers.timer &&
         avr->cycle_timers.timer->when > until;
}

/* As simavr's own, but a sleeping core doesn't leap over what the other boards may do to it. */
static void run_board(ring_board *b, uint64_t until) {
  avr_t *avr = b->avr;
  if (sleeps_until(avr, until) && avr->cycle < until) {
    avr->cycle = until;
    return;
  }
  avr->run_cycle_limit = SLICE;
  while (avr->cycle < until) {
    if (avr->run != b->run) { /* the watchdog's reset */
      avr->run(avr);
      continue;
    }
    if (avr->interrupt_state > 0) avr_service_interrupts(avr); /* raised by another board, or just enabled */
    uint64_t before = avr->cycle;
    avr_flashaddr_t pc = avr->state == cpu_Running ? avr_run_one(avr) : avr->pc;
    b->awake += avr->cycle - before;
    uint64_t idle = avr_cycle_timer_process(avr);
    avr->pc = pc;
    if (avr->state == cpu_Sleeping) {
      uint64_t left = until > avr->cycle ? until - avr->cycle : 1;
      avr->cycle += idle && idle < left ? idle : left;
    } else if (avr->state != cpu_Running) {
      fprintf(stderr, "ring_board: board %d's program has crashed at 0x%04x\n", b->number, (unsigned)avr->pc);
      exit(1);
    }
    if (avr->interrupt_state) avr_service_interrupts(avr);
  }
}

static uint64_t next_event(const ring *r, uint64_t until) {
  uint64_t next = until;
  for (int n = 0; n < RING_BOARDS; n++) {
    const avr_t *avr = r->board[n].avr;
    if (avr->state != cpu_Sleeping || avr->interrupt_state) return r->now + SLICE;
    if (avr->cycle_timers.timer && avr->cycle_timers.timer->when < next) next = avr->cycle_timers.timer->when;
  }
  return next > r->now ? next : r->now + SLICE;
}

void ring_run(ring *r, uint64_t until) {
  while (r->now < until) {
    uint64_t next = next_event(r, until);
    for (int n = 0; n < RING_BOARDS; n++) run_board(&r->board[n], next);
    r->now = next;
  }
}

/* The levels that the board's straps give; simavr tells them once and forgets them at a reset. */
static int straps(const ring_board *b) { return STRAPS & ~(b->number << 5 | (b->ring->slow ? 1 << 7 : 0)); }

static void was_reset(avr_io_t *io) {
  ring_board *b = (ring_board *)((char *)io - offsetof(ring_board, io));
  b->ddr_b = b->ddr_c = b->ddr_d = 0;
  two_wire_reset(&b->ring->link, b->number);
  level(b->avr, PIND, straps(b), true);
  level(b->avr, PIND, START, !b->ring->started);
  lane_wires(b);
  link_wires(b->ring);
  start_wire(b->ring, b->avr->cycle);
}

void ring_reset(ring *r, int n) {
  avr_t *avr = r->board[n].avr;
  avr_reset(avr);
  avr_regbit_set(avr, avr->reset_flags.extrf);
}

void ring_hang(ring *r, int n) {
  avr_t *avr = r->board[n].avr;
  avr->pc = avr->flashend - 1; /* where ring_create put an instruction that jumps to itself */
  avr->sreg[S_I] = 0;
  avr->interrupt_state = 0;
  avr->state = cpu_Running;
}

/* ---- set-up ---- */

static void connect(ring_board *b, uint32_t port, int irq, avr_irq_notify_t notify) {
  avr_irq_t *line = avr_io_getirq(b->avr, port, irq);
  line->flags &= (uint8_t)~IRQ_FLAG_FILTERED;
  avr_irq_register_notify(line, notify, b);
}

static void strap(ring_board *b) {
  avr_ioport_external_t pins = {.name = 'D', .mask = STRAPS, .value = (uint8_t)straps(b)};
  avr_ioctl(b->avr, AVR_IOCTL_IOPORT_SET_EXTERNAL('D'), &pins);
}

static bool make_board(ring *r, int n, elf_firmware_t *firmware) {
  ring_board *b = &r->board[n];
  avr_t *avr = avr_make_mcu_by_name("atmega328p");
  if (!avr) return false;
  b->ring = r, b->number = n, b->avr = avr;
  avr_init(avr);
  avr->log = LOG_ERROR;
  firmware->frequency = RING_FREQUENCY;
  avr_load_firmware(avr, firmware);
  avr->flash[avr->flashend - 1] = 0xFF, avr->flash[avr->flashend] = 0xCF; /* rjmp . */
  avr->codeend = avr->flashend;
  b->run = avr->run;
  for (int lane = 0; lane < RING_LANES; lane++) sensor_power(&b->sensor[lane], n * RING_LANES + lane, &r->times);
  two_wire_attach(&r->link, n, avr);
  connect(b, AVR_IOCTL_IOPORT_GETIRQ('B'), IOPORT_IRQ_DIRECTION_ALL, ddr_b);
  connect(b, AVR_IOCTL_IOPORT_GETIRQ('C'), IOPORT_IRQ_DIRECTION_ALL, ddr_c);
  connect(b, AVR_IOCTL_IOPORT_GETIRQ('D'), IOPORT_IRQ_DIRECTION_ALL, ddr_d);
  strap(b);
  uint32_t quiet = 0;
  avr_ioctl(avr, AVR_IOCTL_UART_SET_FLAGS('0'), &quiet);
  if (n == 0) connect(b, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT, transmitted);
  return true;
}

ring *ring_create(const char *path, bool slow) {
  static elf_firmware_t firmware;
  ring *r = calloc(1, sizeof *r);
  bool made = r && !access(path, R_OK) && !elf_read_firmware(path, &firmware);
  if (r) r->slow = slow;
  if (!made) fprintf(stderr, "ring_board: %s: found no firmware that can be loaded; make firmware\n", path);
  for (int n = 0; made && n < RING_BOARDS; n++) made = make_board(r, n, &firmware);
  if (!made) {
    free(r);
    return NULL;
  }
  for (int n = 0; n < RING_BOARDS; n++) {
    ring_board *b = &r->board[n];
    b->io = (avr_io_t){.kind = "ring", .reset = was_reset};
    avr_register_io(b->avr, &b->io);
    avr_raise_irq(avr_io_getirq(b->avr, AVR_IOCTL_IOPORT_GETIRQ('D'), 2), 1);
  }
  ring_touch(r);
  return r;
}

double ring_baud(const ring *r) {
  const uint8_t *data = r->board[0].avr->data;
  return (double)RING_FREQUENCY / ((data[UCSR0A] & U2X ? 8 : 16) * ((data[UBRR0H] << 8 | data[UBRR0L]) + 1));
}
