#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "report/report.h"
#include "statistics/coverage.h"

static void print_numbers(ethd__report *r) {
  const ethd__data *d = &r->data;
  size_t valid, taps = ethd__data_taps(d, &valid);
  ethd__html_print(&r->page,
                   "<li><b>What was measured:</b> taps of a finger on a virtual wall, which a ring around the "
                   "finger renders. %zu test taps, %zu of them valid, in %zu cells (",
                   taps, valid, d->group_count);
  for (size_t i = 0; i < d->group_count; i++) {
    char label[80];
    ethd__html_print(&r->page, "%s%s", i ? "; " : "", ethd__group_label(&d->group[i], label));
  }
  ethd__html_print(
      &r->page,
      "); %zu training taps are left out. Of each tap: the ring's speed as it meets the wall (v_rvo) and as the "
      "finger touches it (v_of), how far it rebounds first (d_max), its smallest speed after the touch (v_rmin); "
      "of strategies that brake how long (Delta_s) and how far (eps) they do. &quot;The paper&quot; is <em>A New "
      "Control "
      "Strategy for the Improvement of Contact Rendering with Encounter-type Haptic Displays</em>.</li>\n",
      d->training);
}

/* The strategies that have a name in the paper, or here. */
static void print_strategies(ethd__report *r) {
  static const char *const known[][2] = {
      {"abrupt", "tracking stops at once where the ring meets the wall"},
      {"smooth", "the paper's VO-A: tracking fades near the wall"},
      {"offset",
       "the paper's VO-B: the ring brakes when it meets the wall, which is then rendered where the ring stopped"},
      {"predictive", "not the paper's: the ring brakes before the wall, so as to stand in it when the finger comes"}};
  const char *between = "<li><b>Strategies:</b> ";
  for (size_t k = 0; k < sizeof known / sizeof *known; k++)
    for (size_t i = 0; i < r->data.group_count; i++) {
      if (strcmp(r->data.group[i].cell.law, known[k][0])) continue;
      ethd__html_markup(&r->page, between);
      ethd__html_print(&r->page, "<code>%s</code>, %s", known[k][0], known[k][1]);
      between = "; ";
      break;
    }
  ethd__html_markup(&r->page, *between == ';' ? ".</li>\n" : "");
}

/* Who they are that led so. */
static void print_led(ethd__report *r, ethd__leader led) {
  const ethd__folder *f = r->folder;
  switch (led) {
  case ETHD_LED_DEVICE: ethd__html_markup(&r->page, "people, with their fingers in the device's ring"); break;
  case ETHD_LED_MOUSE:
    ethd__html_markup(&r->page,
                      "people, who led the hand with a pointer; the finger that touches the ring is simulated");
    break;
  case ETHD_LED_RECORDED:
    ethd__html_print(
        &r->page,
        "simulated participants who move as <b>recorded people</b> did: movements of <code>%s</code>. They "
        "didn't feel this ring: the movements were recorded elsewhere, and the fingertip is simulated",
        f->protocol.motion ? f->protocol.motion : "movement.csv, the same one for all");
    break;
  default:
    ethd__html_markup(
        &r->page, "<b>simulated participants, no person</b>: plausible hands and fingers, whose spread between people "
                  "is assumed");
  }
}

static void print_people(ethd__report *r) {
  const char *between = "";
  ethd__html_print(&r->page, "<li><b>On whom:</b> %zu ", r->data.people_count);
  for (int k = 0; k < ETHD_LED_KINDS; k++) {
    if (!r->led[k]) continue;
    ethd__html_markup(&r->page, between);
    if (!ethd__report_only(r, (ethd__leader)k)) ethd__html_print(&r->page, "(%zu taps) ", r->led[k]);
    print_led(r, (ethd__leader)k);
    between = "; ";
  }
  ethd__html_markup(&r->page, ".</li>\n");
}

/* Each station that was merged has left an event. */
static size_t count_stations(const ethd__report *r) {
  const ethd__sheet *events = &r->table[ETHD_TABLE_EVENTS];
  int event = ethd__sheet_column(events, "event");
  size_t n = 0;
  for (size_t row = 0; row < events->rows; row++) n += !strcmp(ethd__sheet_cell(events, row, event), "merged");
  return n;
}

static void print_left_out(ethd__report *r) {
  const ethd__data *d = &r->data;
  if (d->absent.count)
    ethd__html_print(
        &r->page,
        "<li><b>Left out:</b> %zu test taps of %zu participants who are not analysed; participants.csv says "
        "why.</li>\n",
        d->left_out, d->absent.count);
  if (count_stations(r) > 1)
    ethd__html_print(&r->page,
                     "<li><b>Where:</b> at %zu stations of one study, each with participants of its own.</li>\n",
                     count_stations(r));
}

static void print_device(ethd__report *r) {
  const ethd__folder *f = r->folder;
  if (ethd__report_measured(r)) {
    ethd__html_print(
        &r->page,
        "<li><b>With what:</b> measured on the device <code>%s</code> of config.ini: the ring as the "
        "encoders have it, the finger as its filter has it. A finger counts as touching %.2g mm from the ring "
        "on.",
        f->loaded.config->device, 1e3 * f->protocol.slack);
  } else {
    ethd__html_print(&r->page,
                     "<li><b>With what:</b> <b>Simulated, not measured</b>: a simulated device and fingertip (plant "
                     "<code>%s</code>), fitted to Table 1 of the paper.",
                     f->protocol.plant ? f->protocol.plant : "n");
  }
  ethd__html_markup(&r->page,
                    " Laws and gains are those of the configuration, the paper's unless it says otherwise.</li>\n");
}

static void print_certainty(ethd__report *r) {
  size_t n = r->data.people_count;
  ethd__html_print(&r->page, "<li><b>How sure it is:</b> the sample is %zu participants, not the taps. ", n);
  if (n < ETHD_STATISTICS_PEOPLE)
    ethd__html_print(
        &r->page,
        "That is too few for any test (the smallest two-sided p would be %.3g): differences are given with "
        "wide intervals, and nothing of this study is called significant. ",
        fmin(1, 2 / exp2((double)n)));
  else
    ethd__html_print(
        &r->page,
        "Tests are made within participants and corrected by Holm; of simulated studies with %zu participants, "
        "%.1f %% (mean differences) and %.1f %% (medians) have the truth within the interval that is called 95 %%. ",
        ethd__coverage_known(n)->people, 100 * ethd__coverage_known(n)->mean, 100 * ethd__coverage_known(n)->median);
  ethd__html_print(&r->page, "%s</li>\n", ethd__report_caveat(r));
  if (!r->beside.group_count) return;
  size_t valid, taps = ethd__data_taps(&r->beside, &valid);
  ethd__html_print(
      &r->page,
      "<li><b>Beside it:</b> <code>%s</code>, %zu participants with %zu taps (%zu valid). The paper's table "
      "and sentences are judged by it, since it is larger.</li>\n",
      r->beside_name, r->beside.people_count, taps, valid);
}

void ethd__report_origin(ethd__report *r) {
  static const char *const links[][2] = {{"table1", "Table 1"},          {"claims", "The paper's sentences"},
                                         {"figures", "Figures"},         {"delay", "Delay"},
                                         {"valid", "Valid taps"},        {"pairs", "Comparison"},
                                         {"interaction", "Interaction"}, {"survey", "Survey"},
                                         {"forces", "Forces"},           {"traces", "Traces"},
                                         {"model", "Mixed model"},       {"methods", "Methods"}};
  ethd__html_markup(&r->page, "<ul class=\"note\">\n");
  print_numbers(r);
  print_strategies(r);
  print_people(r);
  print_left_out(r);
  print_device(r);
  print_certainty(r);
  ethd__html_markup(&r->page, "</ul>\n<nav>");
  for (size_t i = 0; i < sizeof links / sizeof *links; i++)
    ethd__html_print(&r->page, "<a href=\"#%s\">%s</a>", links[i][0], links[i][1]);
  ethd__html_markup(&r->page, "</nav>\n");
}
