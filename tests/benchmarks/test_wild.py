"""Scripts as people have them: the page says what the results say."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

from benchmarks.wild import survey
from benchmarks.wild.engines import Outcome, thermo
from benchmarks.wild.lines import comparable, harmless, output_folders, without
from benchmarks.wild.listing import PLAIN, Entry, Result, entries, results, store, what_is
from benchmarks.wild.page import PAGE, Book, filled
from benchmarks.wild.refusals import label, refusals
from benchmarks.wild.survey import agreement, rows

SCREEN = """Setting up run ...
Step Atoms KinEng
       0        2            0
     100        2        0.125
Loop time of 0.1
Step Atoms KinEng
     100        2        0.125
"""


def test_the_page_is_made_of_the_results() -> None:
    text = PAGE.read_text(encoding="utf-8")
    assert filled(text) == text


def test_every_result_is_of_a_listed_script() -> None:
    listed = {(entry.repository, entry.path) for entry in entries()}
    assert {(row.repository, row.path) for row in results()} <= listed


def test_results_are_stored_as_they_are(tmp_path: Path) -> None:
    row = Result("o/n", "in.a", "runs", "", "refuses", "no 'x', sorry", "x; y", "", 0, 5, 0.25)
    store([row], tmp_path / "results.csv")
    assert results(tmp_path / "results.csv") == [row]


def test_a_book_counts_every_word_of_a_script() -> None:
    entry = Entry("o/n", "in.a", "0" * 40, "", "plain spheres")
    row = Result("o/n", "in.a", "runs", "", "refuses", "", "fix heal; fix move", "", 0, 5, 0.0)
    words = Book([entry], [row]).words()
    assert words[2:] == ["| `fix heal` | 1 | 1 | 0 |", "| `fix move` | 1 | 1 | 0 |"]


def test_thermo_output_is_read_by_tables() -> None:
    outcome = Outcome(0, "", thermo(SCREEN))
    assert rows(outcome) == [(0, 100, 2, 0.125), (1, 100, 2, 0.125)]
    assert outcome.steps == 100
    assert outcome.verdict == "runs"
    behind = SCREEN.replace("Step Atoms", "Atoms Step").replace("100        2", "2        100")
    assert rows(Outcome(0, "", thermo(behind)))[0] == (0, 100, 2, 0.125)


def test_a_script_in_which_nothing_moves_is_compared_by_its_counts() -> None:
    still = SCREEN.replace("0.125", "0")
    here = rows(Outcome(0, "", thermo(still)))
    assert here == [(0, 0, 2, 0.0), (0, 100, 2, 0.0), (1, 100, 2, 0.0)]
    assert agreement(here, here) == ("same", 3, 0.0)
    assert agreement(here, rows(Outcome(0, "", thermo(SCREEN))))[0] == "differs"


@pytest.mark.parametrize(("code", "verdict"), [(-11, "fails"), (-9, "runs"), (1, "runs")])
def test_an_engine_that_crashes_runs_nothing(code: int, verdict: str) -> None:
    assert Outcome(code, "ended", thermo(SCREEN)).verdict == verdict


def test_a_script_that_ends_with_an_error_after_its_first_step_is_refused() -> None:
    screen = SCREEN.replace("  100 ", "    1 ")
    assert Outcome(1, "ERROR: no mesh", thermo(screen)).verdict == "refuses"
    assert Outcome(0, "", thermo(screen)).verdict == "runs"


@pytest.mark.parametrize(
    ("other", "verdict"),
    [(2.0, "same"), (2.0 + 1e-7, "same"), (2.001, "differs")],
)
def test_energies_agree_to_some_digits(other: float, verdict: str) -> None:
    assert agreement([(0, 100, 8, 2.0)], [(0, 100, 8, other)])[0] == verdict


def test_a_script_is_made_comparable_once_it_has_a_box() -> None:
    text = "thermo 7\ncreate_box 1 reg\nthermo_style custom &\n step ke\nrun 3"
    assert comparable(text).splitlines() == [
        "#thermo 7", "create_box 1 reg", "thermo_style custom step atoms ke", "thermo 100",
        "#thermo_style custom ", "# step ke", "run 3",
    ]  # fmt: skip


def test_nothing_of_a_script_reaches_a_shell() -> None:
    text = "shell mkdir post\nshell mkdir ../x\nif 1 then &\n 'shell rm x'\nrun 1"
    assert [line for line in harmless(text).splitlines() if not line.startswith("#")] == [
        "shell mkdir post",
        "run 1",
    ]


def test_a_statement_is_taken_out_with_its_continued_lines() -> None:
    assert without("a\nb &\n c\nd", 3).splitlines() == ["a", "#b ", "# c", "d"]


def test_folders_of_output_are_found() -> None:
    text = "dump d all custom 1 post/a/*.txt id\ninclude sub/in.x\nrestart 1 ${where}/x.rst"
    assert output_folders(text) == [Path("post/a")]


def test_features_out_of_scope_are_named() -> None:
    assert what_is("fix a all heat/gran 300 # bonds") == "heat"
    assert what_is("fix a all couple/lb/onetoone") == "couple/cfd"


def test_a_refusal_has_the_same_label_in_every_script() -> None:
    message = "fix 'heal/gran' exists in LIGGGHTS but not in minidem"
    assert label("fix a all heal/gran 1", message) == "fix heal/gran"


def test_a_script_names_what_is_run_before_it_and_its_variables() -> None:
    entry = Entry("o/n", "d/in.run", "0" * 40, "d", PLAIN, "d/in.init;d/in.fill", "N=5 R=1,2")
    assert entry.chain == ("d/in.init", "d/in.fill", "d/in.run")
    assert entry.variables == {"N": ["5"], "R": ["1", "2"]}
    row = Result("o/n", "d/in.run", "runs", "", "runs", "", "", "same", 6, 5, 0.0)
    assert (
        "(after in.init, after in.fill, -var N 5, -var R 1 2)" in Book([entry], [row]).scripts()[2]
    )


def _collected(folder: Path) -> Entry:
    """Return an entry of two scripts whose repository lies in a folder."""
    home = folder / "o+n" / "d"
    home.mkdir(parents=True)
    (home / "in.init").write_text(
        "processors 2 1 1\nwrite_restart ../d/post/a.restart\nlog ../../out/b\n"
    )
    (home / "in.run").write_text("read_restart post/a.restart\nrun 5\n")
    return Entry("o/n", "d/in.run", "0" * 40, "d", PLAIN, "d/in.init", "N=5")


@pytest.mark.parametrize(("fails", "runs"), [(False, ["in.init", "in.run"]), (True, ["in.init"])])
def test_scripts_are_run_one_after_the_other(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, fails: bool, runs: list[str]
) -> None:
    seen = []

    def run(command: Sequence[str], script: str, folder: Path, *_: object) -> Outcome:
        seen.append(script)
        assert command[-3:] == ("-var", "N", "5")
        assert (folder / "post").is_dir()
        assert not (folder / "../../out").is_dir()
        assert not (folder / "in.init").read_text().startswith("processors")
        return Outcome(1, "ERROR: no", []) if fails else Outcome(0, "", [])

    monkeypatch.setattr(survey.engines, "run", run)
    outcome = survey.liggghts(_collected(tmp_path), tmp_path)
    assert seen == runs
    assert outcome.message == ("in.init: ERROR: no" if fails else "")


def test_refused_words_are_found_with_values_of_variables(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "in.a").write_text("if '${N} > 3' then 'heal all'\nfix a all heal/gran 1\n")
    found = refusals(Path("in.a"), variables={"N": ["5"]})
    assert [word for word, _ in found] == ["if: heal", "fix heal/gran"]


def test_a_loop_that_waits_for_motion_is_no_refusal(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("minidem.script.control.MAX_COMMANDS", 50)
    waits = "label loop\nrun 5\nvariable a equal 1\nif '$a < 9' then 'jump SELF loop'\nheal all\n"
    (tmp_path / "in.a").write_text(waits)
    assert [word for word, _ in refusals(Path("in.a"))] == ["heal"]


def test_thermo_output_that_both_engines_refuse_is_refused_by_liggghts(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The script that is compared has thermo output of its own, which LIGGGHTS takes."""
    home = tmp_path / "o+n"
    home.mkdir()
    (home / "in.run").write_text("create_box 1 r\nthermo_style custom step numbonds\nrun 9\n")

    def run(command: Sequence[str], script: str, folder: Path, *_: object) -> Outcome:
        mine = "numbonds" in (folder / script).read_text().split("#")[0]
        return Outcome(1, "ERROR: Invalid keyword", []) if mine else Outcome(0, "", thermo(SCREEN))

    monkeypatch.setattr(survey.engines, "run", run)
    refused = [("thermo_style: numbonds", "Invalid keyword 'numbonds'")]
    monkeypatch.setattr(survey, "_refused", lambda _: (refused, {}))
    row = survey.survey(Entry("o/n", "in.run", "0" * 40, "", PLAIN), tmp_path)
    assert (row.liggghts, row.liggghts_says) == ("refuses", "ERROR: Invalid keyword")
    assert row.minidem == row.verdict == ""
