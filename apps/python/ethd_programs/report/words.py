"""What a report says about itself: its head, its methods, and where the data are."""
import functools
from typing import Tuple

import numpy as np

from ethd_programs.cli import plural
from ethd_programs.report.bootstrap import DRAWS, FEW_DRAWS
from ethd_programs.report import claims as paper
from ethd_programs.report.page import Page
from ethd_programs.report.report import LEADERS, Report
from ethd_programs.report.statistics import FEWEST_PEOPLE

_STRATEGIES = {
    "abrupt": "tracking stops at once where the ring meets the wall",
    "smooth": "the paper's VO-A: tracking fades near the wall",
    "offset": "the paper's VO-B: the ring brakes when it meets the wall, which is then rendered where the ring stopped",
    "predictive": "not the paper's: the ring brakes before the wall, so as to stand in it when the finger comes",
}
_LINKS = (("primary", "Primary outcomes"), ("table1", "Table 1"), ("claims", "The paper's sentences"), ("figures", "Figures"),
          ("delay", "Delay"), ("valid", "Valid taps"), ("pairs", "Comparison"), ("interaction", "Interaction"), ("survey", "Survey"), ("forces", "Forces"), ("traces", "Traces"),
          ("model", "Mixed model"), ("methods", "Methods"))


def _is(count: int) -> str:
    return "is" if count == 1 else "are"


def _numbers(r: Report) -> None:
    t = r.taps
    checked = f", {t.accepted} accepted by the experimenter, {t.rejected} rejected and left out" if t.accepted + t.rejected else ""
    r.page.put("<li><b>What was measured:</b> taps of a finger on a virtual wall, which a ring around the finger renders. %d test tap%s, %d of "
               "them valid%s, in %d cell%s, each a strategy at a speed (%s); %d training tap%s %s left out. Of each tap: the ring's speed as it "
               "meets the wall (v_rvo) and as the finger touches it (v_of), how far it rebounds first (d_max), its smallest (most negative) speed after the "
               "touch (v_rmin); for strategies that brake: the braking time (Delta_s) and the offset of the wall (eps). &quot;The paper&quot; is <em>A New Control "
               "Strategy for the Improvement of Contact Rendering with Encounter-type Haptic Displays</em>.</li>\n",
               t.count, plural(t.count), t.valid, checked, len(t.cells), plural(len(t.cells)), "; ".join(c.label for c in t.cells),
               t.training, plural(t.training), _is(t.training))


def _strategies(r: Report) -> None:
    laws = {c.law for c in r.taps.cells}
    between = "<li><b>Strategies:</b> "
    for law, words in _STRATEGIES.items():
        if law in laws:
            r.page.put(between + "<code>%s</code>, %s", law, words)
            between = "; "
    r.page.put(".</li>\n" if between == "; " else "")


def _task(r: Report) -> None:
    f = r.folder.facts
    speeds = {c.speed.word: c.speed for c in r.taps.cells}
    bands = {"low": f["band_low_mps"], "high": f["band_high_mps"]}
    asked = (f"{s.word}: {s.centre:.2g} ± {bands.get(s.word) or s.band:.2g} m/s" for s in speeds.values())
    r.page.put("<li><b>The task:</b> to tap once, at a speed that was asked for (" + "; ".join(asked).replace("±", "&#177;"))
    r.page.put("). A tap is valid when the hand comes at that speed, the finger doesn't touch the ring before it stands at the wall, and presses "
               "once.</li>\n" if f["valid_by_finger"] else
               "). A tap is valid when the ring meets the wall at that speed, before the finger touches it, and the finger presses once.</li>\n")


def _who(r: Report, leader: str) -> Tuple[str, str]:
    if leader == "recorded":
        return ("<b>simulated</b>, with hands that move as those of <b>recorded people</b> did: movements of <code>%s</code>. They didn't feel this "
                "ring: the movements were recorded elsewhere, and the fingertip is simulated", r.folder.facts["motion"] or "movement.csv, the same one for all")
    simulated = r.folder.facts["is_simulated"]
    return {"device": "<b>no person</b>: a rehearsal, with the finger that the simulated device has" if simulated
                      else "people, with their fingers in the device's ring",
            "mouse": "people, who led the hand with a pointer; the finger that touches the ring is simulated",
            "simulated": "<b>simulated, no person</b>: plausible hands and fingers, whose spread between people is assumed"}[leader], ""


def _people(r: Report) -> None:
    t = r.taps
    whole = functools.reduce(np.logical_and, (~np.isnan(t.by_person(c, np.where(c.valid, 1.0, np.nan), "mean")) for c in t.cells))
    r.page.put("<li><b>On whom:</b> %d participant%s: ", len(t.people), plural(len(t.people)))
    between = ""
    for leader in (k for k in LEADERS if r.led[k]):
        words, name = _who(r, leader)
        r.page.put(between)
        if not r.only(leader):
            r.page.put("(%d tap%s) ", r.led[leader], plural(r.led[leader]))
        r.page.put(words, *([name] if name else []))
        between = "; "
    r.page.put("; with a valid tap in every cell: %d.</li>\n", np.count_nonzero(whole))


def _left_out(r: Report) -> None:
    if r.absent:
        r.page.put("<li><b>Left out:</b> %d test tap%s of %d participant%s who %s not analysed; participants.csv says why.</li>\n",
                   r.taps.left_out, plural(r.taps.left_out), r.absent, plural(r.absent), _is(r.absent))
    stations = sum(event == "merged" for (event,) in r.events.cells("event"))  # each has left one when it was merged
    if stations > 1:
        r.page.put("<li><b>Where:</b> at %d stations of one study, each with participants of its own.</li>\n", stations)


def _device(r: Report) -> None:
    f = r.folder.facts
    if r.measured:
        r.page.put("<li><b>With what:</b> measured on the device <code>%s</code> of config.ini: the ring as the encoders have it, the finger as its "
                   "filter has it. A finger counts as touching %.2g mm from the ring on.", f["device"], 1e3 * f["slack_m"])
    else:
        r.page.put("<li><b>With what:</b> <b>Simulated, not measured</b>: a simulated device and fingertip (plant <code>%s</code>), fitted to Table 1 "
                   "of the paper.", f["plant"])
    r.page.put(" Laws and gains are those of the configuration, the paper's unless it says otherwise.</li>\n")


def _certainty(r: Report) -> None:
    n = len(r.taps.people)
    r.page.put("<li><b>How sure it is:</b> the sample is %d participant%s, not the taps. ", n, plural(n))
    if n < FEWEST_PEOPLE:
        r.page.put("That is too few for any test (the smallest two-sided p would be %.3g): differences are given with wide intervals, and nothing of "
                   "this study is called significant. ", min(1, 2 / 2**n))
    else:
        r.page.put("Tests are made within participants and corrected by Holm. ")
    r.page.put("%s</li>\n", r.caveat)
    if r.beside:
        b, people = r.beside, len(r.beside.people)
        r.page.put("<li><b>Beside it:</b> <code>%s</code>, %d participant%s with %d tap%s (%d valid). The paper's table and sentences are judged by it, "
                   "since it is larger.</li>\n", r.beside_name, people, plural(people), b.count, plural(b.count), b.valid)


def _found(r: Report) -> None:
    sentences = sum(r.verdicts.values())
    if len(r.taps.people) < FEWEST_PEOPLE or not r.differences + sentences:
        return
    r.page.put("<li><b>What came out:</b> ")
    if r.differences:
        r.page.put('of %d <a href="#pairs">difference%s between strategies</a> %d %s significant (p under 0.05 after Holm\'s correction)',
                   r.differences, plural(r.differences), r.significant, _is(r.significant))
    if sentences:
        shown, left = r.verdicts[paper.SHOWN], r.verdicts[paper.OPEN] + r.verdicts[paper.TOO_FEW]
        r.page.put('%sof %d <a href="#claims">sentences of the paper</a> %d %s shown, of %d the contrary is shown, %d %s not shown',
                   "; " if r.differences else "", sentences, shown, _is(shown), r.verdicts[paper.CONTRARY], left, _is(left))
    r.page.put(".</li>\n")


def head(r: Report, body: Page) -> None:
    r.page.put('<ul class="note">\n')
    for part in (_numbers, _strategies, _task, _people, _left_out, _device, _certainty, _found):
        part(r)
    r.page.put("</ul>\n<nav>")
    for name, title in (link for link in _LINKS if link[0] in body.names):
        r.page.put('<a href="#%s">%s</a>\n', name, title)
    r.page.put("</nav>\n")


_METHODS = (
    "Means and sample standard deviations (n - 1) of all valid taps are given as in the paper, to be read beside it; no test uses them, since taps "
    "of one person are no independent sample. Medians and quartiles: linear interpolation between order statistics (Hyndman and Fan, type 7).",
    "Every test is made within people: a participant's figure in a cell is the median of the valid taps there (shares and the figures of Table 1: "
    "the mean), and what is tested is the participants' differences. With fewer than six participants no test is made: the smallest two-sided p "
    "that five can have is 0.0625.",
    "p of a difference, and of a difference of differences: Fisher's sign-flip permutation test, two-sided, exact up to 16 participants, by drawn "
    "signs beyond. Interval of a mean difference: Student's t over participants, from three on. d_z: mean difference over the standard deviation "
    "of the differences, its interval from the noncentral t. Cliff's delta: the share of pairs of taps in which the second strategy has the larger "
    "value less the share in which it has the smaller, -1 to 1.",
    "Alike: equivalence within a margin that the study file names ([statistics]), by two one-sided t tests (TOST). That a difference isn't "
    "significant is never called alike.",
    "Holm's correction is made within the family that each table names.",
    "Bootstrap intervals (of medians and of Cliff's delta) are 95 % percentile intervals: participants are drawn with replacement, then taps of "
    "each. They are shown from six participants on: of simulated studies with six, 95 % have the true median within them, with three only 87 %.",
    "Survey answers are ordinal: counts, medians and quartiles; strategies are compared by Wilcoxon's signed rank test with Pratt's treatment of "
    "equal answers, exact; three or more by Friedman's test.",
    "n points into the wall: speeds are positive toward it, negative away. The instant of sight is the one at which the finger's front reaches the "
    "wall that a screen without delay would show.",
)


def methods(r: Report) -> None:
    r.page.heading("methods", "Methods")
    r.page.put("<ul>\n" + "".join(f"<li>{words}</li>\n" for words in _METHODS))
    r.page.put("<li>All random sampling uses seed %d: %d bootstrap samples, fewer (%d at least) of more than %d taps.</li>\n</ul>\n",
               r.seed, DRAWS, FEW_DRAWS, 10000)


def foot(r: Report, sums: Tuple[int, str]) -> None:
    """sums: of all files, and what is wrong with them, if anything. What was changed is named, and the page goes on: nothing
    here can tell which of the two is right."""
    r.page.heading("data", "Data")
    r.page.put("<p>The folder's README.md says what every file and column is. Study hash <code>%s</code>; libethd %s. Any recorded tap repeats bit for "
               "bit: <code>ethd-replay --verify DIR/taps/NAME</code>.</p>\n", r.folder.facts["hash"], r.folder.facts["version"])
    files, wrong = sums
    if wrong:
        r.page.put('<p class="note"><b>Check sums:</b> %s.</p>\n', wrong)
    else:
        r.page.put('<p class="note">%s as SHA256SUMS says.</p>\n', "The file is" if files == 1 else f"All {files} files are")
