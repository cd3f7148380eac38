"""The section of a study's questionnaire: counts, tests within people by ranks, words. Answers count as ordered."""
from dataclasses import dataclass
from itertools import combinations, groupby
from typing import Any, Dict, List, Sequence

import numpy as np

from ethd_programs.cli import Refusal, quoted
from ethd_programs.report.output import Cell as Text
from ethd_programs.report.page import interval_text, mean_text, number_text, p_text
from ethd_programs.report.pictures import Path
from ethd_programs.report.report import Report
from ethd_programs.report.statistics import FEWEST_PEOPLE, NAN, Numbers, friedman, holm, summarise, wilcoxon

_CLIPPED = 32  # bytes of an answer's words under a picture


@dataclass
class _Question:
    number: int
    text: str
    answers: List[str]  #: none where words are asked for
    has_words: bool  #: False: the answers are bare numbers
    given: Dict[int, Numbers]  #: by cell, of each person; NaN: none
    words: List[List[str]]  #: person, cell, answer

    @property
    def caption(self) -> str:
        return f"Q{self.number}: {self.text}"


def _number(answer: str) -> float:
    try:
        return float(answer)
    except ValueError:
        return NAN


def _read(r: Report) -> List[_Question]:
    questions = [_Question(k, q["text"], q["answers"], q["has_words"], {}, []) for k, q in enumerate(r.folder.facts["questions"], 1)]
    cells = {(c.law, c.speed.word): i for i, c in enumerate(r.taps.cells)}
    people = {p: i for i, p in enumerate(r.taps.people)}
    for q in questions:
        q.given = {i: np.full(len(people), NAN) for i in cells.values()}
    columns = ("participant", "transition", "speed", *(f"q{q.number}" for q in questions))
    for row, (who, law, speed, *answers) in enumerate(r.survey.cells(*columns)):
        cell, person = cells.get((law, speed)), people.get(who)
        for q, answer in zip(questions, answers):
            if not answer:
                continue
            chosen = _number(answer)
            if q.answers and chosen not in range(1, len(q.answers) + 1):
                raise Refusal(f"{r.survey.path}:{row + 2}: q{q.number}: found {quoted(answer)}, a whole number from 1 to {len(q.answers)} is "
                              "allowed")
            if cell is None or person is None:
                continue
            if q.answers:
                q.given[cell][person] = chosen
            else:
                q.words.append([who, r.taps.cells[cell].label, answer])
    return questions


# ---- counts ----


def _count(r: Report, q: _Question, columns: int) -> List[List[Text]]:
    n = len(q.answers)
    heads = [f"{k} {words}" if q.has_words else str(k) for k, words in enumerate(q.answers, 1)]
    r.page.table(q.caption, ("cell", "n", *heads, "median", "quartiles", "mean (sd)"), 1)
    rows: List[List[Text]] = []
    for i, cell in enumerate(r.taps.cells):
        values = q.given[i][~np.isnan(q.given[i])]
        s, counts = summarise(values), [int(np.count_nonzero(values == k)) for k in range(1, n + 1)]
        r.page.row(cell.label, str(s.n), *map(str, counts), number_text(s.median, 1), interval_text(s.q1, s.q3, 1),
                   mean_text(s.n, s.mean, s.sd, 2))
        rows.append([q.number, cell.law, cell.speed.word, i + 1, s.n, *counts, *[None] * (columns - n), s.median, s.q1, s.q3, s.mean, s.sd, n])
    r.page.end_table()
    return rows


def _clipped(words: str) -> str:
    """Shortens long words, between letters, and ends them with an ellipsis."""
    data = words.encode()
    return words if len(data) <= _CLIPPED else data[:_CLIPPED].decode(errors="ignore") + "…"


def _draw(r: Report, q: _Question) -> None:
    first, last = (_clipped(q.answers[k]) if q.has_words else "" for k in (0, -1))
    paper = "" if r.folder.facts["own_questions"] else " Figure 18 of the paper shows the means of three participants' answers."
    r.draw("report-survey.gp", f"survey-q{q.number}.png", f"Q{q.number}: the answers by cell.{paper}",
           {"in": Path("survey-answers.csv"), "question": str(q.number), "answers": str(len(q.answers)),
            "scale": f"1 {first}{' ' if first else ''}to {len(q.answers)} {last}"})


# ---- tests ----


def _tests(r: Report, questions: Sequence[_Question]) -> List[List[Any]]:
    """For each question and speed all strategies together, where there are more than two, and each two: rows of the table without
    Holm's correction."""
    out: List[List[Any]] = []
    for q in questions:
        for speed, group in groupby(range(len(r.taps.cells)), lambda i: r.taps.cells[i].speed.word):
            cells: List[Any] = list(group)
            if len(cells) > 2:
                rows = np.stack([q.given[i] for i in cells], axis=1)
                rows = rows[~np.isnan(rows).any(axis=1)]
                out.append([q.number, "Friedman", "", "", speed, len(rows), None, None, *friedman(rows)])
            for a, b in combinations(cells, 2):
                d = q.given[b] - q.given[a]
                d = d[~np.isnan(d)]
                out.append([q.number, "Wilcoxon", r.taps.cells[a].law, r.taps.cells[b].law, speed, len(d), int(np.count_nonzero(d > 0)),
                            int(np.count_nonzero(d < 0)), *wilcoxon(d)])
    return out


def _put_tests(r: Report, questions: Sequence[_Question]) -> None:
    r.page.table("Answers compared within participants, by ranks. Family of Holm's correction: the p of this table",
                 ("question", "answers", "test", "n", "higher", "lower", "W or chi square", "p", "p, Holm"), 3)
    rows = _tests(r, questions)
    for row, corrected in zip(rows, holm([row[-1] if row[5] >= FEWEST_PEOPLE else NAN for row in rows])):
        row[-1:] = [row[-1] if row[5] >= FEWEST_PEOPLE else NAN, corrected]
        number, test, a, b, speed, n, higher, lower, statistic, p, _ = row
        r.page.row(f"Q{number}", f"{b} - {a}, {speed}" if a else f"all strategies, {speed}", test, str(n), *("-" if k is None else str(k) for k in (higher, lower)),
                   number_text(statistic, 2), p_text(p), p_text(corrected))
    r.page.end_table()
    r.output.table("survey-tests.csv", "question,test,transition_a,transition_b,speed,n,higher,lower,statistic,p,p_holm", rows)


# ---- the section ----


def survey(r: Report) -> None:
    questions = _read(r)
    numbered = [q for q in questions if q.answers]
    r.page.heading("survey", "Survey")
    if not any(q.words or any(not np.isnan(v).all() for v in q.given.values()) for q in questions):
        r.page.put("<p>%s</p>\n", "Nobody has answered. Simulated participants feel nothing: their answers are left empty, never made up."
                   if r.folder.facts["survey"] else "This study asked no questions.")
        return
    if not r.folder.facts["own_questions"]:
        r.page.put("<p>The questions are the paper's, in words of our own. The best answers are 3 (just then), 3 (stood still) and 1 (very "
                   "natural).</p>\n")
    if numbered:
        most = max(len(q.answers) for q in numbered)
        r.page.put("<p>How many participants gave each answer. Answers count as ordered, in the order in which they were offered.</p>\n")
        rows = [row for q in numbered for row in _count(r, q, most)]
        header = ["question,transition,speed,cell,n", *(f"n{k}" for k in range(1, most + 1)), "median,q1,q3,mean,sd,answers"]
        r.output.table("survey-answers.csv", ",".join(header), rows)
        for q in numbered:
            _draw(r, q)
        _put_tests(r, numbered)
    for q in questions:
        if not q.answers:
            r.page.table(q.caption, ("participant", "cell", "answer"), 3)
            for row in q.words:
                r.page.row(*row)
            r.page.end_table()
