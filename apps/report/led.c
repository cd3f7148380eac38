#include <string.h>

#include "report/report.h"

static const char *const words[ETHD_LED_KINDS] = {
    [ETHD_LED_DEVICE] = "device",
    [ETHD_LED_MOUSE] = "mouse",
    [ETHD_LED_RECORDED] = "recorded",
    [ETHD_LED_SIMULATED] = "simulated",
};

static bool on_device(const ethd__report *r) {
  return strcmp(r->folder->loaded.config->device, ethd_driver_sim.id) != 0;
}

/* Events have a clock only where people led the finger. */
static bool has_clock(const ethd__report *r) {
  const ethd__sheet *events = &r->table[ETHD_TABLE_EVENTS];
  int utc = ethd__sheet_column(events, "utc");
  bool found = false;
  for (size_t row = 0; row < events->rows; row++) found |= *ethd__sheet_cell(events, row, utc) != 0;
  return found;
}

/* Used for tables that don't say it for each tap. */
static ethd__leader asked_for(const ethd__report *r) {
  const ethd__folder *f = r->folder;
  if (f->protocol.hands == ETHD_HANDS_PEOPLE && on_device(r)) return ETHD_LED_DEVICE;
  if (has_clock(r)) return ETHD_LED_MOUSE;
  return f->protocol.hands == ETHD_HANDS_RECORDED || f->finger ? ETHD_LED_RECORDED : ETHD_LED_SIMULATED;
}

void ethd__report_led(ethd__report *r) {
  const ethd__data *d = &r->data;
  int column = ethd__sheet_column(&d->sheet, "hand");
  ethd__leader otherwise = asked_for(r);
  memset(r->led, 0, sizeof r->led);
  for (size_t g = 0; g < d->group_count; g++)
    for (size_t i = 0; i < d->group[g].cell.count; i++) {
      const char *word = ethd__sheet_cell(&d->sheet, d->group[g].row[i], column);
      int k = 0;
      while (k < ETHD_LED_KINDS && strcmp(word, words[k])) k++;
      r->led[k < ETHD_LED_KINDS ? k : (int)otherwise]++;
    }
}

bool ethd__report_only(const ethd__report *r, ethd__leader led) {
  for (int k = 0; k < ETHD_LED_KINDS; k++)
    if (k != (int)led && r->led[k]) return false;
  return r->led[led] > 0;
}

bool ethd__report_measured(const ethd__report *r) { return ethd__report_only(r, ETHD_LED_DEVICE) && on_device(r); }

const char *ethd__report_caveat(const ethd__report *r) {
  if (ethd__report_measured(r)) return "The p values and intervals speak about people like these on this device.";
  if (ethd__report_only(r, ETHD_LED_MOUSE))
    return "Device and fingertip are simulated: the p values and intervals speak about people like these who lead that "
           "simulation by hand.";
  if (ethd__report_only(r, ETHD_LED_RECORDED))
    return "Device and fingertips are simulated, and several simulated participants may move as the same recorded "
           "person "
           "did: the p values and intervals speak about the simulation. They say nothing certain about people.";
  if (ethd__report_only(r, ETHD_LED_SIMULATED))
    return "The participants are simulated: a p value says how sure the simulation's own answer is. More participants "
           "cost "
           "nothing and make any p small; none of them is evidence about people.";
  return "These taps come from several sources, which the report's head names: p values and intervals of such a "
         "mixture "
         "speak about none of them alone.";
}
