#include "period.h"

#include <avr/interrupt.h>
#include <avr/sleep.h>
#include <util/atomic.h>

#include "board.h"

static bool leads;
static volatile uint8_t begun; /* periods that have begun since the last one was taken */
static volatile uint8_t rounds;
static volatile uint16_t start;
static volatile uint32_t time;

/* 3 periods = 160000 cycles = 10000 us. */
ISR(TIMER1_COMPA_vect) {
  static uint8_t third;
  START_DDR |= START_PIN;
  start = OCR1A;
  third = third == 2 ? 0 : third + 1;
  OCR1A += third == 2 ? 53334u : 53333u;
  time += third == 0 ? 3334u : 3333u;
  begun++;
}

ISR(INT0_vect) {
  start = TCNT1;
  begun++;
}

ISR(TIMER1_OVF_vect) { rounds++; }

EMPTY_INTERRUPT(TIMER1_COMPB_vect) /* wakes period_wait */

void period_open(bool leader) {
  leads = leader;
  EICRA = 1 << ISC01; /* INT0 on the falling edge */
  TCCR1A = 0;
  TCCR1B = 1 << CS10;
  OCR1A = TCNT1 + 53333u;
  if (leader) {
    TIMSK1 = 1 << OCIE1A;
  } else {
    TIMSK1 = 1 << TOIE1;
    EIFR = 1 << INTF0; /* forget a start that came before */
    EIMSK = 1 << INT0;
  }
  set_sleep_mode(SLEEP_MODE_IDLE);
  sleep_enable();
  sei();
}

bool period_next(period *out) {
  for (;;) {
    cli();
    if (begun || rounds) break;
    sei();
    sleep_cpu();
  }
  bool any = begun != 0;
  *out = (period){start, time, begun > 1};
  begun = 0;
  rounds = 0;
  sei();
  return any;
}

void period_wait(uint16_t instant) {
  ATOMIC_BLOCK(ATOMIC_FORCEON) {
    OCR1B = instant;
    TIMSK1 |= 1 << OCIE1B;
  }
  for (;;) {
    cli();
    if ((int16_t)(TCNT1 - instant) >= 0) break;
    sei();
    sleep_cpu();
  }
  TIMSK1 &= (uint8_t)~(1 << OCIE1B);
  TIFR1 = 1 << OCF1B;
  sei();
}

void period_release(void) { START_DDR &= (uint8_t)~START_PIN; }
