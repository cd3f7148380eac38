"""Sections of a report about recorded taps: single ones as tables and pictures, a whole encounter, the largest forces."""
import math
import os
from typing import Any, Dict, List, Optional, Tuple

import numpy as np
from numpy.typing import NDArray

from ethd_programs.cli import FAILED, Refusal
from ethd_programs.report.output import Cell as Text
from ethd_programs.report.pictures import Path
from ethd_programs.report.report import Report
from ethd_programs.report.statistics import NAN, Numbers, sd_of
from ethd_programs.report.study import Ticks
from ethd_programs.report.taps import QUANTITIES, Cell

_TICK = ("q", "state", "beta", "fe", "fd", "eps", "d_re", "tau_raw", "tau")
_TRUTH = ("t", "ring", "ring_v", "motor", "motor_v", "finger", "finger_v", "hand", "pad_force")
_HEADER = ("t_s,since_wall_s,ring_m,measured_m,finger_m,hand_m,offset_wall_m,v_ring_mps,v_finger_mps,state,beta,fe_N,fd_N,"
           "pad_force_N,tau1_Nm,tau2_Nm")
_SHOWN = 0.09  # s after the ring meets the wall: what tap.gp shows
_SINGULAR = 0.02  # below it, as a share, the inverse of the Jacobian is damped (include/ethd/arm.h)


def _recording(r: Report, name: str) -> Optional[str]:
    return next((path for path in (os.path.join(f, name) for f in r.recordings) if os.path.isdir(path) and not os.path.islink(path)), None)


def _read(r: Report, recording: str) -> Tuple[Ticks, Ticks]:
    tick, truth = r.folder.ticks(recording, "tick.npy", _TICK), r.folder.ticks(recording, "truth.npy", _TRUTH)
    if len(tick) != len(truth):
        raise Refusal(f"{recording}: {len(tick)} rows in tick.npy, {len(truth)} in truth.npy; the same number is allowed", FAILED)
    return tick, truth


# ---- torques and forces ----


def _force(facts: Dict[str, Any], q: Numbers, tau: Numbers) -> Numbers:
    """The size of the force at the ring that these torques make: J^-T tau, damped near the singularity as libethd does it."""
    serial = facts["mechanism"] == "serial"
    angle = np.stack((q[:, 0], q[:, 0] + q[:, 1] if serial else q[:, 1]))
    x, y = np.cos(angle) * [[facts["link1_m"]], [facts["link2_m"]]], np.sin(angle) * [[facts["link1_m"]], [facts["link2_m"]]]
    j = np.moveaxis(np.array([[-y[0] - y[1] * serial, -y[1]], [x[0] + x[1] * serial, x[1]]]), -1, 0)
    w0 = _SINGULAR * facts["link1_m"] * facts["link2_m"]
    damping = w0**2 / (j**2).sum(axis=(1, 2)) * np.maximum(0, 1 - np.abs(np.linalg.det(j)) / w0) ** 2
    damped = j @ j.swapaxes(1, 2) + damping[:, None, None] * np.eye(2)
    return np.asarray(np.linalg.norm(np.linalg.solve(damped, j @ tau[:, :, None]), axis=(1, 2)))


def _strongest(r: Report, tick: Ticks) -> List[float]:
    """What was asked for and what the guard let through: the largest force at the ring, N, and torque of either joint, Nm."""
    forces = [_force(r.folder.facts, tick["q"], tick[name]) for name in ("tau_raw", "tau")]
    return [float(np.max(v, initial=0)) for v in (*forces, np.abs(tick["tau_raw"]), np.abs(tick["tau"]))]


def forces(r: Report) -> None:
    if not r.recordings:
        return
    r.page.heading("forces", "What was asked of the motors, and what they gave")
    r.page.put("<p>The laws ask for a torque; the guard lets through what the limits of device and configuration allow. Only the second reaches "
               "the motors, and what a finger feels. The largest of each tap, in Nm of a joint and as the force at the ring that these torques "
               "make (a device's friction and inertia not counted). The largest force that the wall asks for, in the table of all figures, is "
               "also what the law asks for.</p>\n")
    r.page.table("Valid recorded test taps: median over taps (largest)",
                 ("cell", "recorded taps", "asked for, N", "let through, N", "asked for, Nm", "let through, Nm"), 1)
    rows: List[List[Text]] = []
    for cell in r.taps.cells:
        found = [_recording(r, name) for name in cell.name[cell.valid].tolist()]
        strongest = np.array([_strongest(r, _read(r, path)[0]) for path in found if path])
        if not len(strongest):
            continue
        middle, most = np.median(strongest, axis=0), strongest.max(axis=0)
        r.page.row(cell.label, str(len(strongest)), *(f"{a:.{d}f} ({b:.{d}f})" for a, b, d in zip(middle, most, (1, 2, 2, 3))))
        rows.append([cell.law, cell.speed.word, len(strongest), *np.stack((middle, most), axis=1).ravel().tolist()])
    r.page.end_table()
    r.output.table("forces.csv", "transition,speed,taps,asked_N_median,asked_N_max,let_N_median,let_N_max,asked_Nm_median,asked_Nm_max,"
                   "let_Nm_median,let_Nm_max", rows)


# ---- single taps ----


def _typical(cell: Cell, there: NDArray[np.bool_]) -> int:
    """The valid tap nearest to the means of these, each figure measured in its standard deviation."""
    distance = np.zeros(cell.count)
    for key in ("v_rvo", "v_of", "d_max", "v_rmin"):
        values = np.where(there, QUANTITIES[key].of(cell.figures), NAN)
        known = values[~np.isnan(values)]
        sd = sd_of(known)
        if sd > 0:
            distance += ((values - known.mean()) / sd) ** 2
    distance[~there | np.isnan(distance)] = math.inf
    return int(np.argmin(distance)) if np.isfinite(distance).any() else int(np.argmax(there))


def _choose(r: Report, cell: Cell) -> Optional[int]:
    """The tap to draw; None: no ticks are there."""
    if r.tap:
        named = np.flatnonzero(cell.name == r.tap)
        return int(named[0]) if len(named) and _recording(r, r.tap) else None
    there = np.array([bool(v) and _recording(r, name) is not None for v, name in zip(cell.valid, cell.name.tolist())], bool)
    return _typical(cell, there) if there.any() else None


def _meeting(r: Report, tick: Ticks, truth: Ticks, along: NDArray[np.float64]) -> int:
    """The first tick with the ring in the wall. A recorded movement may start there: the tap then begins once the ring is
    clear of it, and would be if it were centred on the hand, both by more than d_beta."""
    f, inside = r.folder.facts, tick["d_re"] < 0
    meet = f["wall_m"] - f["ring_radius_m"]
    clear = (np.isnan(tick["d_re"]) | (tick["d_re"] > f["d_beta_m"])) & (truth["hand"] @ along < meet - f["d_beta_m"])
    clear[:1] |= ~inside[:1]
    met = inside & np.logical_or.accumulate(clear)
    return int(np.argmax(met)) if met.any() else len(tick)


def _write(r: Report, name: str, tick: Ticks, truth: Ticks, finger_radius: float) -> str:
    """Writes a tap's table; depths are those of ring, finger and hand behind the wall. Returns a sentence that says how far
    the ring went into the wall within the picture, and which forces acted; "" if it met no wall."""
    f = r.folder.facts
    n = np.array([f["normal_x"], f["normal_y"]])
    meeting = _meeting(r, tick, truth, n)
    side = "motor" if f["speed_of_motor_side"] else "ring"
    ring, measured = (truth[which] @ n + f["ring_radius_m"] - f["wall_m"] for which in ("ring", side))
    finger, hand = (truth[who] @ n + finger_radius - f["wall_m"] for who in ("finger", "hand"))
    since = truth["t"] - (truth["t"][meeting] if meeting < len(tick) else NAN)
    offset = np.where(tick["eps"] != 0, tick["eps"], NAN)
    speed = truth[side + "_v"] @ n
    columns = (truth["t"], since, ring, measured, finger, hand, offset, speed, truth["finger_v"] @ n, tick["state"], tick["beta"], tick["fe"] @ n,
               tick["fd"] @ n, truth["pad_force"], tick["tau"][:, 0], tick["tau"][:, 1])
    r.output.table(name, _HEADER, zip(*(c.tolist() for c in columns)))
    if meeting == len(tick):
        return ""
    shown = slice(0, meeting + int(_SHOWN / f["period_s"]))
    asked, let, _, _ = _strongest(r, tick[shown])
    deepest = max(0.0, float(ring[shown][meeting:].max()))
    return (f" The ring goes {1e3 * deepest:.1f} mm into the wall that is asked for. The laws ask for up to {asked:.0f} N at the ring, for "
            f"braking and wall together; the limits let through at most {let:.1f} N.")


#: The paper's figures of single taps, by strategy and speed.
_FIGURES = {("smooth", "low"): 9, ("offset", "low"): 10, ("smooth", "high"): 11, ("offset", "high"): 12}


def traces(r: Report) -> None:
    r.page.heading("traces", "Traces of single taps")
    r.page.put("<p>The ring goes into the virtual wall; each caption says how far. The drawing is right: a ring that comes at this speed can't stop "
               "at once, the limits of the device cap its force, and after the touch the hand keeps pushing. d<sub>max</sub> is the first "
               "rebound alone, from the ring's first peak to the valley after it, and often begins before the finger touches; v<sub>r min</sub> is "
               "the ring's smallest (most negative) speed in the 0.1 s after the touch. d<sub>max</sub> and the ring's speed are of the side that "
               "the study measures: the encoders', where the drive's transmission gives way.</p>\n"
               "<p>In the pictures n points into the wall; x<sub>e</sub> is the wall that is asked for, x<sub>&epsilon;</sub> the one that is "
               "rendered once a strategy has braked behind it. A strategy is transparent while the ring follows the finger, brakes, and then "
               "renders the virtual wall (vo); &beta; says how strongly the ring still follows the finger (1: fully).</p>\n")
    drawn: List[Cell] = []
    for cell in r.taps.cells:
        chosen = _choose(r, cell)
        if chosen is None:
            continue
        tap, table = str(cell.name[chosen]), f"trace-{cell.law}-{cell.speed.word}"
        recording = _recording(r, tap)
        assert recording
        depth = _write(r, f"{table}.csv", *_read(r, recording), float(cell.figures["finger_radius_m"][chosen]))
        which = "" if r.tap else ", the recorded valid tap that is closest to the mean"
        number = _FIGURES.get((cell.law, cell.speed.word))
        like = f"As figure {number} of the paper, a tap of one participant" if number else "In the manner of figures 9 to 12 of the paper"
        r.draw("tap.gp", f"{table}.png", f"{like}: {cell.label}, tap {tap}{which}.{depth}",
               {"in": Path(f"{table}.csv"), "title": f"{cell.label} speed", "plant": "" if r.measured else r.folder.facts["plant"]})
        drawn.append(cell)
    if not drawn and r.tap:
        raise Refusal(f"--tap: no test tap {r.tap} is recorded here", FAILED)
    if not drawn:
        r.page.put("<p>No ticks were recorded: there is nothing to draw.</p>\n")
        return
    r.draw("report-states.gp", "states.png",
           "Of the same taps: the active state, and the weight of the tracking torque, which stays continuous while the wall moves. Where a "
           "strategy has no states, vo stands for the ring in the wall. The recordings end soon after the touch.",
           {"in": " ".join(f"trace-{c.law}-{c.speed.word}.csv" for c in drawn), "titles": " ".join(f'"{c.label}"' for c in drawn),
            "note": "the taps above; dashed: ring's front; orange: the wall; grey: x_e"})


def encounter(r: Report) -> None:
    laws = []
    for law in dict.fromkeys(c.law for c in r.taps.cells):
        table = r.folder.encounter(law)
        if table is not None:
            r.output.write(f"encounter-{law}.csv", table.encode())
            laws.append(law)
    if laws:
        r.draw("report-states.gp", "encounter.png",
               "As figure 6 of the paper, which shows a typical encounter under VO-B (vo: the virtual object is rendered), with \u03b2, the active state and the offset \u03b5 of the wall; here under each strategy: "
               "approach at 0.4 m/s, touch, 0.12 s of pressing, retreat, until the ring follows the finger freely again. Simulated for this picture with the study's configuration and plant, no tap of the study, whose recordings "
               "end soon after the touch.",
               {"in": " ".join(f"encounter-{law}.csv" for law in laws), "titles": " ".join(laws), "from": "-60",
                "note": "simulated for this picture; dashed: ring's front; orange: the wall; grey: x_e"})
