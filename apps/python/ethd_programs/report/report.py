"""What every section of a report has at hand: the taps, who made them, and where tables and pictures go."""
from collections import Counter
from dataclasses import dataclass, field
from typing import Dict, List, Optional, Union

from ethd_programs.report.output import ReportFolder
from ethd_programs.report.page import Page
from ethd_programs.report.pictures import Path, Pictures
from ethd_programs.report.study import Folder, Table
from ethd_programs.report.taps import Taps

#: Who led the hand: the finger in the device's ring (a simulated device has its own), a person with a pointer, a recorded
#: movement, nobody.
LEADERS = ("device", "mouse", "recorded", "simulated")

CAVEATS = {
    "device": "Device and finger are simulated: the p values and intervals say nothing about people.",
    "mouse": "Device and fingertip are simulated: the p values and intervals speak about people like these who lead that "
    "simulation by hand.",
    "recorded": "Device and fingertips are simulated, and several simulated participants may move as the same recorded person "
    "did: the p values and intervals speak about the simulation. They say nothing certain about people.",
    "simulated": "The participants are simulated: a p value says how sure the simulation's own answer is. More participants cost "
    "nothing and make any p small; none of them is evidence about people.",
}
_MIXED = ("These taps come from several sources, which the report's head names: p values and intervals of such a mixture "
          "speak about none of them alone.")


@dataclass
class Report:
    folder: Folder
    output: ReportFolder
    pictures: Pictures
    points: Dict[int, Taps]  #: the study's taps, by point of its grid
    point: int  #: that is shown
    absent: int  #: participants who aren't analysed
    events: Table
    survey: Table
    beside: Optional[Taps]  #: of another, larger folder; the paper's sentences are then judged by it
    beside_name: str
    tap: Optional[str]  #: a recording whose traces are drawn; None: the typical one of each cell
    seed: int
    page: Page = field(default_factory=Page)
    #: results, counted for the page's head: of differences between strategies, and of the paper's sentences
    differences: int = 0
    significant: int = 0
    verdicts: "Counter[str]" = field(default_factory=Counter)
    recordings: List[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.taps = self.points[self.point]
        self.recordings = self.folder.recordings()
        otherwise = self._asked_for()
        self.led = Counter(h if h in LEADERS else otherwise for c in self.taps.cells for h in c.hand.tolist())
        f = self.folder.facts
        #: how far two strategies may differ and still be called alike, by quantity
        self.margins = {"d_max": 1e3 * f["margin_d_max_m"], "v_of": f["margin_v_of_mps"], "v_rmin": f["margin_v_rmin_mps"]}

    def _asked_for(self) -> str:
        """Who led the hand in tables that don't say it for each tap."""
        f = self.folder.facts
        if f["hands"] == "people":
            return "device"
        if any(utc for (utc,) in self.events.cells("utc")):  # events have a clock only where people led the finger
            return "mouse"
        return "recorded" if f["hands"] == "recorded" or f["follows_movement"] else "simulated"

    def only(self, leader: str) -> bool:
        return set(self.led) == {leader}

    @property
    def measured(self) -> bool:
        """Whether people's fingers tapped on a real device, so that figures were measured and nothing was fitted."""
        return self.only("device") and not self.folder.facts["is_simulated"]

    @property
    def caveat(self) -> str:
        """A sentence that says what p values and intervals are about: people, or the assumptions of a simulation."""
        if self.measured:
            return "The p values and intervals speak about people like these on this device."
        return next((words for leader, words in CAVEATS.items() if self.only(leader)), _MIXED)

    # ---- the sample for the paper's sentences ----

    @property
    def judged(self) -> Taps:
        return self.beside or self.taps

    @property
    def judged_name(self) -> str:
        return self.beside_name if self.beside else "this study"

    # ---- what sections write ----

    def draw(self, script: str, name: str, caption: str, values: Dict[str, Union[str, Path]]) -> None:
        self.page.picture(self.pictures.draw(script, name, values), caption)

