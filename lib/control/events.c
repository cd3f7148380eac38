#include "control/controller.h"

unsigned ethd__events_room(ethd__events *e) {
  return ETHD__EVENTS -
         (atomic_load_explicit(&e->head, memory_order_relaxed) - atomic_load_explicit(&e->tail, memory_order_acquire));
}

bool ethd__events_push(ethd__events *e, const ethd_event *event) {
  if (ethd__events_room(e) == 0) return false;
  unsigned head = atomic_load_explicit(&e->head, memory_order_relaxed);
  e->at[head % ETHD__EVENTS] = *event;
  atomic_store_explicit(&e->head, head + 1, memory_order_release);
  return true;
}

ethd_status ethd_control_poll(ethd_control *control, ethd_event *out) {
  ethd__events *e = &control->events;
  unsigned tail = atomic_load_explicit(&e->tail, memory_order_relaxed);
  if (tail == atomic_load_explicit(&e->head, memory_order_acquire)) return ETHD_STATUS_EMPTY;
  *out = e->at[tail % ETHD__EVENTS];
  atomic_store_explicit(&e->tail, tail + 1, memory_order_release);
  return ETHD_OK;
}
