#include "report/report.h"
#include "statistics/coverage.h"

static const char *const methods[] = {
    "Means and sample standard deviations (n - 1) of all valid taps are given as in the paper, to be read beside it; "
    "no "
    "test uses them, since taps of one person are no independent sample. Medians and quartiles: linear interpolation "
    "between order statistics (Hyndman and Fan, type 7).",
    "Every test is made within people: a participant's figure in a cell is the median of the valid taps there (shares "
    "and the figures of Table 1: the mean), and what is tested is the participants' differences. With fewer than six "
    "participants no test is made: the smallest two-sided p that five can have is 0.0625.",
    "p of a difference, and of a difference of differences: Fisher's sign-flip permutation test, two-sided, exact up "
    "to "
    "16 participants, by drawn signs beyond. Interval of a mean difference: Student's t over participants, from three "
    "on. d_z: mean difference over the standard deviation of the differences, its interval from the noncentral t. "
    "Cliff's delta: the share of pairs of taps in which the second strategy has the larger value less the share in "
    "which "
    "it has the smaller, -1 to 1.",
    "Alike: equivalence within a margin that the study file names ([statistics]), by two one-sided t tests (TOST). "
    "That a "
    "difference isn't significant is never called alike.",
    "Holm's correction is made within the family that each table names.",
    "Bootstrap intervals (of medians and of Cliff's delta) are 95 % percentile intervals: participants are drawn with "
    "replacement, then taps of each. They are shown from six participants on.",
    "Survey answers are ordinal: counts, medians and quartiles; strategies are compared by Wilcoxon's signed rank test "
    "with Pratt's treatment of equal answers, exact; three or more by Friedman's test.",
    "Two heaps: Hartigan's dip, with a p by simulation of a uniform sample, the least favourable one with a single "
    "heap. "
    "Times are counted in ticks of 1 ms, so equal ones are spread evenly over their tick first. A p under 0.05 is "
    "marked: there the mean describes no typical tap.",
    "n points into the wall: speeds are positive toward it, negative away. The instant of sight is the one at which "
    "the "
    "finger's front reaches the wall that a screen without delay would show.",
};

static void print_coverage(ethd__report *r) {
  const ethd__coverage *c = ethd__coverage_known(r->data.people_count);
  size_t n = r->data.people_count;
  if (n < 3) return;
  ethd__html_print(&r->page,
                   "<li>What 95 %% means here: of simulated studies with %zu participants and %d taps a cell%s, the "
                   "intervals held the truth in %.0f %% (t of a mean difference), %.0f %% (d_z)",
                   c->people, ETHD_COVERAGE_TAPS,
                   c->people == n ? "" : ", the nearest smaller number that was simulated", 100 * c->mean,
                   100 * c->effect);
  if (n >= ETHD_STATISTICS_PEOPLE)
    ethd__html_print(&r->page, ", %.0f %% (bootstrap of a median) and %.0f %% (bootstrap of Cliff's delta)",
                     100 * c->median, 100 * c->cliff);
  ethd__html_markup(&r->page, ". <code>ethd-report --coverage 1000</code> simulates it again.</li>\n");
}

void ethd__report_methods(ethd__report *r) {
  ethd__html_heading(&r->page, "methods", "Methods");
  ethd__html_markup(&r->page, "<ul>\n");
  for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) ethd__html_print(&r->page, "<li>%s</li>\n", methods[i]);
  print_coverage(r);
  ethd__html_print(&r->page,
                   "<li>Whatever is drawn is drawn under seed %llu: %u bootstrap samples, fewer (%u at least) of more "
                   "than %d taps.</li>\n</ul>\n",
                   (unsigned long long)r->seed, ETHD_CLUSTERS_DRAWS, ETHD_CLUSTERS_FEW_DRAWS, 10000);
}
