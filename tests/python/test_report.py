"""Parts of ethd-report that its tables can't show: exact tests against every case, what is escaped and refused."""
import csv
import io
import itertools
import math
import os

import pytest

np = pytest.importorskip("numpy")
pytest.importorskip("scipy")

from ethd_programs.cli import Refusal  # noqa: E402
from ethd_programs.report import bootstrap  # noqa: E402
from ethd_programs.report import statistics as st  # noqa: E402
from ethd_programs.report.claims import threshold  # noqa: E402
from ethd_programs.report.output import ReportFolder, harmless  # noqa: E402
from ethd_programs.report.page import Page  # noqa: E402
from ethd_programs.report.pictures import _path, _string  # noqa: E402
from ethd_programs.report.study import Table  # noqa: E402
from ethd_programs.report import taps  # noqa: E402


def test_wilcoxon_tries_all_signs():
    for x in ([1.0, -2, 3, 0, 3, -1], [0.0, 0, 1, 1, 1, -1, 2], [2.0, 4, 6]):
        x = np.array(x)
        from scipy.stats import rankdata

        ranks = rankdata(np.abs(x))[x != 0]
        sums = [np.dot(signs, ranks) for signs in itertools.product((0, 1), repeat=len(ranks))]
        here = ranks[x[x != 0] > 0].sum()
        p = min(1, 2 * min(np.mean([s <= here + 1e-9 for s in sums]), np.mean([s >= here - 1e-9 for s in sums])))
        assert st.wilcoxon(x)[1] == pytest.approx(p, abs=1e-12)
    assert math.isnan(st.wilcoxon(np.zeros(8))[1])
    assert st.wilcoxon(np.arange(1.0, 251))[1] < 1e-30


def test_sign_flip_of_many_people_is_drawn_near_the_exact_one():
    x = np.random.default_rng(3).normal(0.35, 1, 17)
    sums = np.zeros(1)
    for v in x:
        sums = np.concatenate((sums - v, sums + v))
    exact = np.mean(np.abs(sums) >= abs(x.sum()) - 1e-12)
    assert abs(st.sign_flip(x, 1) - exact) < 5 * math.sqrt(exact * (1 - exact) / 20000) + 1e-4
    assert st.sign_flip(np.ones(6), 1) == pytest.approx(2 / 64)


def test_holm_keeps_what_was_not_made():
    assert st.holm([0.01, math.nan, 0.04, 0.03])[:1] == [0.03] and math.isnan(st.holm([0.01, math.nan])[1])
    assert st.holm([0.01, 0.04, 0.03]) == pytest.approx([0.03, 0.06, 0.06])
    assert st.holm([]) == []


def test_bootstrap_draws_people_then_their_taps():
    value, person = np.array([1.0, 2, 3, 10, 20, 30]), np.array([0, 0, 0, 1, 2, 2])
    clusters = bootstrap.Clusters(value, person, np.zeros(6, int))
    weight = clusters._weights(np.random.default_rng(1), 20000)
    # each person is drawn once on average, and in a draw as often as the taps say
    assert weight.mean(axis=0) == pytest.approx(np.ones(6), abs=0.03)
    assert set(np.unique(weight[:, 3])) == {0, 1, 2, 3} and np.all(weight[:, :3].sum(axis=1) % 3 == 0)
    three = weight[:, 3] == 3
    assert np.mean(three) == pytest.approx(1 / 27, abs=0.006) and np.all(weight[three][:, [0, 1, 2, 4, 5]] == 0)
    assert math.isnan(clusters.interval(bootstrap.median, 1).low)  # too few people
    assert clusters.here(bootstrap.median) == 6.5


def test_figures_of_weighted_taps():
    clusters = bootstrap.Clusters(np.array([1.0, 1, 2, 3]), np.array([0, 1, 0, 1]), np.array([0, 1, 1, 0]))
    weight = np.array([[1, 1, 1, 1], [2, 0, 3, 1], [1, 0, 0, 1]], np.int32)
    assert bootstrap.median(clusters, weight).tolist() == [1.5, 2, 2]
    found = bootstrap.cliff(clusters, weight)
    assert found[:2].tolist() == pytest.approx([(1 - 2) / 4, (2 * 3 - 3) / 9]) and math.isnan(found[2])
    early = bootstrap.Clusters(np.array([0.3, 0.4, 0.5, 0.6]), np.zeros(4, int), np.array([0, 0, 1, 1]))
    found = threshold(early, np.array([[1, 1, 1, 1], [1, 0, 0, 1], [1, 1, 0, 0]], np.int32))
    assert found[:2].tolist() == pytest.approx([0.45, 0.45]) and math.isnan(found[2])


def simulate(people, runs, seed):
    """Shares of simulated studies whose 95 % intervals hold the truth: of a median, of Cliff's delta, of a mean difference, of d_z.

    People, their responses to the strategy and their three taps a cell are normal with standard deviations 1, 0.5 and 1; the
    strategy shifts the mean by 1. The first two stay valid when any increasing function stretches the values; the others need
    differences that are about normal."""
    taps_each, move, answer = 3, 1.0, 0.5
    # the median of three standard normal numbers has the variance 1 - sqrt(3)/pi
    truths = (0.0, math.erf(move / math.sqrt(4 + answer**2) / math.sqrt(2)), move, move / math.sqrt(answer**2 + 2 * (1 - math.sqrt(3) / math.pi)))
    person = np.repeat(np.arange(people), taps_each)
    hits = np.zeros(4)
    for run in range(runs):
        rng = np.random.default_rng((seed, run))
        own, moved = rng.normal(size=people), move + answer * rng.normal(size=people)
        taps = own[:, None] + rng.normal(size=(2, people, taps_each))
        taps[1] += moved[:, None]
        both = bootstrap.Clusters(taps.ravel(), np.tile(person, 2), np.repeat([0, 1], people * taps_each))
        found = st.compare(np.median(taps[1], axis=1) - np.median(taps[0], axis=1), seed)
        intervals = (bootstrap.Clusters(taps[0].ravel(), person, 0 * person).interval(bootstrap.median, seed + 1 + run, 2),
                     both.interval(bootstrap.cliff, seed + 1 + run, 2), found.interval, found.effect)
        hits += [i.low <= truth <= i.high for i, truth in zip(intervals, truths)]
    return hits / runs


def test_intervals_hold_the_truth_about_as_often_as_they_say():
    for people, runs, shares in ((6, 300, (0.946, 0.960, 0.954, 0.955)), (3, 300, (0.872, 0.911, 0.951, 0.948))):
        for share, known in zip(simulate(people, runs, 1), shares):
            assert abs(share - known) < 5 * math.sqrt(known * (1 - known) / runs)


def test_equivalence_without_spread():
    assert st.equivalent(np.zeros(6), -1, 1).p == 0 and st.equivalent(np.full(6, 2.0), -1, 1).p == 1
    assert st.equivalent(np.full(6, 2.0), -1, 1).p_outside == 0 and math.isnan(st.equivalent(np.zeros(1), -1, 1).p)


# ---- words ----


def test_text_of_a_stranger_is_no_markup():
    page = Page()
    page.heading("x", '<script>"&\'')
    page.table("a & b", ("<i>", None), 1)
    page.row("\x1b[0m", "100 %")
    page.put("<p>%s at %d %%</p>", "%d", 3)
    text = page.whole("<t>").decode()
    assert "<script>" not in text and "&lt;script&gt;&quot;&amp;&#x27;" in text and "\x1b" not in text and "<t>" not in text
    assert "<p>%d at 3 %</p>" in text and text.endswith("</html>\n")


def test_cells(tmp_path):
    cells = ((math.nan, ""), (None, ""), (2.0, "2.0"), (2, "2"), (1e-9, "1e-09"), (np.float64(0.1), "0.1"), ("a\nb", "a b"), ('say "x"', '"say ""x"""'), ("a,b", '"a,b"'))
    with ReportFolder(str(tmp_path / "report"), (), False, None) as folder:
        folder.table("a.csv", "x,y", [(cell, 0) for cell, _ in cells])
    assert (tmp_path / "report/a.csv").read_text() == "x,y\n" + "".join(f"{text},0\n" for _, text in cells)
    assert [harmless(w) for w in ("=1+1", "-3.5e2", "@x", "a", "")] == ["'=1+1", "-3.5e2", "'@x", "a", ""]


def test_gnuplot_gets_strings():
    assert _string("a'; system('x'); b\n") == "'a''; system(''x''); b '" and _path("<x") == "'./<x'" and _path("/x") == "'/x'"


def test_tables_of_a_stranger():
    assert list(Table("x", 'a,b\n1,"p, ""q"""\r\n').cells("b", "c")) == [['p, "q"', ""]]
    assert list(Table("x", None).cells("a")) == [] and Table("x", None).names == []
    for text, what in (("", "x:1: a name for each column"), ("a,b\n1\n", "x:2: found 1 cell, 2 are allowed"), ('a\n"1\n', "x:2: a quote that isn't closed"),
                       ("a\n\0\n", "a byte 0"), ("a,a\n", "each once")):
        with pytest.raises(ValueError, match=what):
            Table("x", text)


def test_numbers_and_words_of_a_stranger():
    def read(column, cell):
        good = {"participant": "P01", "transition": "smooth", "speed": "0.3", "reason": "ok", column: cell}
        return taps.read(Table("taps.csv", ",".join(good) + "\n" + ",".join(good.values()) + "\n"), {})[column][0]

    assert read("eps_m", "-1.5e3") == -1500 and math.isnan(read("eps_m", "")) and read("by_ring", "") == "" and read("point", "") == 0
    for column, cells, allowed in (("eps_m", ("x", "1_0", "0x1", " 1", "inf", "1e"), "a number"), ("point", ("-1", "x", "1e9", "nan"), "a point of the grid"),
                                   ("speed", ("fast", "3", "nan", "../3"), "low, high or a number"), ("participant", ("", "a/b", ".."), "a word of up to 31"),
                                   ("reason", ("", "fine"), "ok, early-contact")):
        for cell in cells:
            with pytest.raises(Refusal, match=f"taps.csv:2: {column}: found .*{allowed}"):
                read(column, cell)


def test_a_folder_is_written_by_one_program(tmp_path):
    out = str(tmp_path / "report")
    with ReportFolder(out, ("*.csv",), False, None) as folder:
        folder.table("a.csv", "x,y", [[1, math.nan], ["p", 2.5]])
        with pytest.raises(Refusal, match="another program is writing there"):
            ReportFolder(out, ("*.csv",), True, None)
    assert list(csv.reader(io.StringIO((tmp_path / "report/a.csv").read_text()))) == [["x", "y"], ["1", ""], ["p", "2.5"]]
    assert os.listdir(out) == ["a.csv"]
    with pytest.raises(Refusal, match="holds a.csv already; --force"):
        ReportFolder(out, ("*.csv",), False, None)
    os.symlink("/dev/null", f"{out}/b.csv")
    with pytest.raises(Refusal, match="b.csv: isn't a file; remove it first"):
        ReportFolder(out, ("*.csv",), True, str(tmp_path))
    assert "b.csv" in os.listdir(out)
