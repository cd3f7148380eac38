#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "report/report.h"
#include "statistics/coverage.h"
#include "text/text.h"

static void print_numbers(ethd__report *r) {
  const ethd__data *d = &r->data;
  size_t valid, taps = ethd__data_taps(d, &valid);
  ethd__html_print(&r->page,
                   "<li><b>What was measured:</b> taps of a finger on a virtual wall, which a ring around the "
                   "finger renders. %zu test tap%s, %zu of them valid, in %zu cell%s, each a strategy at a speed (",
                   taps, ethd__s(taps), valid, d->group_count, ethd__s(d->group_count));
  for (size_t i = 0; i < d->group_count; i++) {
    char label[80];
    ethd__html_print(&r->page, "%s%s", i ? "; " : "", ethd__group_label(&d->group[i], label));
  }
  ethd__html_print(
      &r->page,
      "); %zu training tap%s %s left out. Of each tap: the ring's speed as it meets the wall (v_rvo) and as the "
      "finger touches it (v_of), how far it rebounds first (d_max), its smallest speed after the touch (v_rmin); "
      "of strategies that brake how long (Delta_s) and how far (eps) they do. &quot;The paper&quot; is <em>A New "
      "Control "
      "Strategy for the Improvement of Contact Rendering with Encounter-type Haptic Displays</em>.</li>\n",
      d->training, ethd__s(d->training), d->training == 1 ? "is" : "are");
}

/* Explains the strategies that are known by name. */
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

/* Says who led the hand in this way. */
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

static double one(const ethd__metrics *m) {
  (void)m;
  return 1;
}

/* Counts the people who have a valid tap in every cell. */
static size_t count_whole(const ethd__data *d) {
  double *own = malloc((d->people_count + 1) * sizeof *own), *all = calloc(d->people_count + 1, sizeof *all);
  size_t whole = 0;
  if (!own || !all) ethd__fail_memory();
  for (size_t g = 0; g < d->group_count; g++) {
    ethd__people_figure(&d->group[g].cell, one, ETHD_PERSON_MEAN, d->people_count, own);
    for (size_t p = 0; p < d->people_count; p++) all[p] += own[p];
  }
  for (size_t p = 0; p < d->people_count; p++) whole += !isnan(all[p]);
  free(own);
  free(all);
  return whole;
}

static void print_people(ethd__report *r) {
  const char *between = "";
  ethd__html_print(&r->page, "<li><b>On whom:</b> %zu ", r->data.people_count);
  for (int k = 0; k < ETHD_LED_KINDS; k++) {
    if (!r->led[k]) continue;
    ethd__html_markup(&r->page, between);
    if (!ethd__report_only(r, (ethd__leader)k))
      ethd__html_print(&r->page, "(%zu tap%s) ", r->led[k], ethd__s(r->led[k]));
    print_led(r, (ethd__leader)k);
    between = "; ";
  }
  ethd__html_print(&r->page, "; %zu of them have a valid tap in every cell.</li>\n", count_whole(&r->data));
}

/* Says which speeds were asked for and when a tap is valid. */
static void print_task(ethd__report *r) {
  const ethd__protocol *p = &r->folder->protocol;
  const char *between = "<li><b>The task:</b> to tap once, at a speed that was asked for (";
  for (size_t g = 0; g < r->data.group_count; g++) {
    const ethd__speed *speed = &r->data.group[g].speed;
    if (g && !strcmp(speed->word, r->data.group[g - 1].speed.word)) continue;
    double band = !strcmp(speed->word, "low") && !isnan(p->band_low)     ? p->band_low
                  : !strcmp(speed->word, "high") && !isnan(p->band_high) ? p->band_high
                                                                         : speed->band;
    ethd__html_markup(&r->page, between);
    ethd__html_print(&r->page, "%s: %.2g &#177; %.2g m/s", speed->word, speed->centre, band);
    between = "; ";
  }
  ethd__html_markup(&r->page, p->validity == ETHD_TAP_BY_FINGER
                                  ? "). A tap is valid when the hand comes at that speed, the finger doesn't touch the "
                                    "ring before it stands at the wall, and presses once.</li>\n"
                                  : "). A tap is valid when the ring meets the wall at that speed, before the finger "
                                    "touches it, and the finger presses once.</li>\n");
}

/* Counts the stations by the event that each of them has left when it was merged. */
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
        "<li><b>Left out:</b> %zu test tap%s of %zu participant%s who %s not analysed; participants.csv says "
        "why.</li>\n",
        d->left_out, ethd__s(d->left_out), d->absent.count, ethd__s(d->absent.count),
        d->absent.count == 1 ? "is" : "are");
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
  ethd__html_print(&r->page, "<li><b>How sure it is:</b> the sample is %zu participant%s, not the taps. ", n,
                   ethd__s(n));
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
      "<li><b>Beside it:</b> <code>%s</code>, %zu participant%s with %zu tap%s (%zu valid). The paper's table "
      "and sentences are judged by it, since it is larger.</li>\n",
      r->beside_name, r->beside.people_count, ethd__s(r->beside.people_count), taps, ethd__s(taps), valid);
}

/* The sections below it have counted this, since they are written first. */
static void print_found(ethd__report *r) {
  const ethd__report_counts *c = &r->counts;
  size_t sentences = 0;
  for (int i = 0; i < ETHD_TAP_VERDICTS; i++) sentences += c->verdict[i];
  if (r->data.people_count < ETHD_STATISTICS_PEOPLE || !(c->differences + sentences)) return;
  ethd__html_markup(&r->page, "<li><b>What came out:</b> ");
  if (c->differences)
    ethd__html_print(&r->page,
                     "of %zu <a href=\"#pairs\">differences between strategies</a> %zu are significant (p under 0.05 "
                     "after Holm's correction)",
                     c->differences, c->significant);
  if (sentences)
    ethd__html_print(&r->page,
                     "%sof %zu <a href=\"#claims\">sentences of the paper</a> %zu are shown, of %zu the contrary is "
                     "shown, %zu are not shown",
                     c->differences ? "; " : "", sentences, c->verdict[ETHD_TAP_SHOWN], c->verdict[ETHD_TAP_CONTRARY],
                     c->verdict[ETHD_TAP_OPEN] + c->verdict[ETHD_TAP_UNKNOWN]);
  ethd__html_markup(&r->page, ".</li>\n");
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
  print_task(r);
  print_people(r);
  print_left_out(r);
  print_device(r);
  print_certainty(r);
  print_found(r);
  ethd__html_markup(&r->page, "</ul>\n<nav>");
  for (size_t i = 0; i < sizeof links / sizeof *links; i++)
    ethd__html_print(&r->page, "<a href=\"#%s\">%s</a>", links[i][0], links[i][1]);
  ethd__html_markup(&r->page, "</nav>\n");
}
