#include "core/mail.h"

#include "core/rows.h"

/* ---- events ---- */

static unsigned room(ethd__mail *m) {
  return ETHD__EVENTS -
         (atomic_load_explicit(&m->head, memory_order_relaxed) - atomic_load_explicit(&m->tail, memory_order_acquire));
}

void ethd__mail_push(ethd__mail *m, ethd__core *core, const ethd_event *event) {
  if (room(m) == 0) {
    core->counters.events_dropped++;
    return;
  }
  unsigned head = atomic_load_explicit(&m->head, memory_order_relaxed);
  m->at[head % ETHD__EVENTS] = *event;
  atomic_store_explicit(&m->head, head + 1, memory_order_release);
}

ethd_status ethd__mail_poll(ethd__mail *m, ethd_event *out) {
  unsigned tail = atomic_load_explicit(&m->tail, memory_order_relaxed);
  if (tail == atomic_load_explicit(&m->head, memory_order_acquire)) return ETHD_STATUS_EMPTY;
  *out = m->at[tail % ETHD__EVENTS];
  atomic_store_explicit(&m->tail, tail + 1, memory_order_release);
  return ETHD_OK;
}

/* ---- posts and acknowledgements ---- */

bool ethd__mail_take(ethd__mail *m, ethd__core *core, unsigned events) {
  if (!atomic_load_explicit(&m->posted, memory_order_acquire) || room(m) < events) return false;
  m->ruling = 1 - m->ruling;
  core->counters.swaps++;
  return true;
}

double ethd__core_clean_time(const ethd__core *core, double period) {
  if (!__atomic_load_n(&core->fault, __ATOMIC_RELAXED)) return (double)INFINITY;
  return (double)__atomic_load_n(&core->clean, __ATOMIC_RELAXED) * period;
}

/* The tolerance covers the rounding of a sum of periods. */
bool ethd__mail_clear(ethd__mail *m, ethd__core *core, double period, double clean_time) {
  if (!atomic_load_explicit(&m->clear, memory_order_relaxed)) return false;
  atomic_store_explicit(&m->clear, 0, memory_order_relaxed);
  if (!core->fault || !(ethd__core_clean_time(core, period) >= clean_time * (1 - 1e-9))) return false;
  ethd__mail_push(m, core, &(ethd_event){.kind = ETHD_EVENT_CLEARED, .tick = (int64_t)core->counters.ticks});
  return true;
}

/* ---- events of a tick ---- */

/* Clamps are frequent, so they make an event only when they last. */
#define TOLD_WHEN_GRAVE (ETHD_FAULT_BIT(ETHD_FAULT_TORQUE) | ETHD_FAULT_BIT(ETHD_FAULT_TORQUE_RATE))

void ethd__mail_report(ethd__mail *m, ethd__core *core, bool latches, int64_t tick) {
  const ethd__fault_rows *met = &core->met.rows;
  bool same = met->faults == core->before.faults && met->grave == core->before.grave;
  if (same && (latches || !ethd__rows_any(met))) return;
  ethd__fault_rows begun = ethd__rows_begun(core, latches);
  for (int64_t left = begun.faults | begun.grave; left; left &= left - 1) {
    int32_t row = __builtin_ctzll((uint64_t)left);
    int64_t bit = left & -left;
    double value = core->met.valued & bit ? core->met.value[row] : (met->grave & bit) != 0;
    if (begun.faults & bit) core->counters.faults[row]++;
    if (begun.grave & bit || !(bit & TOLD_WHEN_GRAVE))
      ethd__mail_push(m, core, &(ethd_event){.kind = ETHD_EVENT_FAULT, .code = row, .tick = tick, .value = value});
  }
  core->before = *met;
}
