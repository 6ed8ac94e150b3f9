"""How a calibration ends when something goes wrong: exit code, words, and what is left."""

from __future__ import annotations

import errno
import os
import signal
from pathlib import Path

import pytest

from calibrate.cli import running
from calibrate.report.record_file import read_record
from calibrate.report.sections import Section, add_section
from calibrate.runs import others
from liggghts_io import CaseResult, CaseSpec, Failure, OtherCode, case_id
from liggghts_io.case.lock import locked
from tests.calibrate import stand_in
from tests.calibrate.runs.test_campaign import specs
from tests.liggghts_io.own.folders import make_folder


@pytest.fixture
def out(tmp_path: Path) -> Path:
    return tmp_path / "result"


@pytest.fixture
def calibrate(bulkcal, small_study: Path, out: Path, on_stand_in):
    """Return a function that calibrates the small study on the stand-in."""
    return lambda: bulkcal("calibrate", str(small_study), "--out", str(out))


def instead(monkeypatch, action) -> None:
    """Let a campaign do something else than run cases."""
    monkeypatch.setattr(running.Campaign, "__call__", lambda *_: action())


@pytest.mark.parametrize(("number", "expected"), [(signal.SIGTERM, 143), (signal.SIGHUP, 129)])
def test_sigterm_and_sighup_end_as_ctrl_c_does(calibrate, monkeypatch, number, expected):
    before = signal.signal(number, signal.SIG_DFL)  # whoever runs the tests may ignore it (nohup)
    try:
        instead(monkeypatch, lambda: os.kill(os.getpid(), number))
        code, _, err = calibrate()
        assert code == expected
        assert "stopped; finished runs are kept. Continue with: bulkcal calibrate" in err
        assert signal.getsignal(number) is signal.SIG_DFL
    finally:
        signal.signal(number, before)


def test_what_nohup_started_goes_on(calibrate, monkeypatch, out):
    def hang_up():
        os.kill(os.getpid(), signal.SIGHUP)
        raise OSError(errno.EMFILE, os.strerror(errno.EMFILE))

    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        instead(monkeypatch, hang_up)
        assert calibrate()[0] == 2  # not 129: it came to its next line
    finally:
        signal.signal(signal.SIGHUP, before)


@pytest.mark.parametrize(
    ("number", "remedy"),
    [
        (errno.EMFILE, "raise the limit of open files (ulimit -n), or use fewer --workers"),
        (errno.EAGAIN, "raise the limit of processes (ulimit -u), or use fewer --workers"),
        (errno.EFBIG, "raise the limit of the size of files (ulimit -f), then start"),
    ],
)
def test_a_limit_of_the_shell_is_no_fault_of_bulkcal(calibrate, monkeypatch, out, number, remedy):
    def stumble():
        raise OSError(number, os.strerror(number))

    instead(monkeypatch, stumble)
    code, _, err = calibrate()
    assert code == 2
    assert remedy in err
    assert not (out / "traceback.txt").exists()


def test_unforeseen_error_leaves_a_traceback_and_asks_for_a_report(calibrate, monkeypatch, out):
    def stumble():
        msg = "matrix is singular"
        raise ValueError(msg)

    instead(monkeypatch, stumble)
    code, _, err = calibrate()
    assert code == 1
    assert "ValueError: matrix is singular. This is a fault of bulkcal" in err
    assert f"report it with the file {out / 'traceback.txt'}" in err
    assert "in stumble" in (out / "traceback.txt").read_text()
    assert "Traceback" not in err


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EDQUOT])
def test_full_disk_is_no_traceback_and_leaves_no_half_file(number, calibrate, monkeypatch, out):
    rename = os.replace

    def full(source, target):
        if Path(target).name == "runs.csv":
            raise OSError(number, os.strerror(number))
        rename(source, target)

    monkeypatch.setattr(os, "replace", full)
    code, _, err = calibrate()
    assert code == 2
    assert "the disk is full" in err
    assert "free some space, then start the same command again" in err
    assert list(out.rglob("*.tmp")) == []
    assert not (out / "runs.csv").exists()


@pytest.mark.parametrize("name", ["/proc/nobody/result", "x" * 300, "/dev/null/result"])
def test_directory_that_cannot_be_written_is_refused_before_any_run(
    name, bulkcal, small_study: Path, on_stand_in
):
    code, _, err = bulkcal("calibrate", str(small_study), "--out", name)
    assert code == 2
    assert "name another directory" in err
    assert err.count("\n") == 1
    assert on_stand_in == []


def test_failed_runs_are_told_on_screen_in_the_table_and_in_the_report(calibrate, monkeypatch, out):
    right = stand_in.execute

    def lose_some(spec: CaseSpec, root: Path) -> CaseResult:
        result = right(spec, root)
        if spec.experiment != "heap" or spec.seed % 5:
            return result
        reason = "step 12: particle 3 is lost"
        return CaseResult(
            result.case_id, result.path, "failed", reason, {}, 0.1, Failure.PHYSICS, "<last words>"
        )

    monkeypatch.setattr(stand_in, "execute", lose_some)
    code, _, err = calibrate()
    assert code == 0
    shown = " ".join(err.split())
    assert "of 24 runs failed:" in shown  # at the end of the stage
    assert "of 28 runs failed:" in shown  # at the end
    assert "physics: step 12: particle 3 is lost" in shown
    table = (out / "runs.csv").read_text()
    assert "status,failure,reason,wall_s" in table
    assert "failed,physics,step 12: particle 3 is lost," in table
    report = (out / "report.html").read_text()
    assert "<td>physics</td>" in report
    assert "&lt;last words&gt;" in report


def test_record_that_was_changed_or_cut_is_refused(calibrate, out, bulkcal, small_study: Path):
    calibrate()
    path = out / "calibration.json"
    text = path.read_text()
    value = f"{read_record(path)['parameters']['e_pp']!r}"
    for wrong in (text.replace(value, "0.123", 1), text[:-40], "", text.replace("sha256", "sha")):
        path.write_text(wrong)
        code, _, err = bulkcal("diagnose", str(small_study), "--out", str(out))
        assert code == 2
        assert "calibration.json: " in err
        assert "run 'bulkcal calibrate' again" in err


@pytest.mark.parametrize("name", ["runs.csv", "report.html", "posterior.npz", "diagnosis.png"])
def test_files_of_a_person_are_never_written_over(out, bulkcal, small_study, name):
    out.mkdir()
    mine = out / name
    mine.write_text("<p>mine: 36 degrees</p>")
    words = [str(small_study), "--out", str(out)]
    for command in (["calibrate", "--mode", "joint"], ["calibrate", "--dry-run"], ["diagnose"]):
        code, _, err = bulkcal(command[0], *words, *command[1:])
        assert code == 2
        assert f"holds {name}, not written by bulkcal" in err
        assert "move it away, or give another --out" in err
    assert mine.read_text() == "<p>mine: 36 degrees</p>"
    assert list(out.iterdir()) == [mine]


def test_damaged_files_of_ours_are_written_over_which_mends_them(calibrate, out):
    assert calibrate()[0] == 0
    for ours in (out / "calibration.json", out / "runs.csv", out / "report.html"):
        ours.write_text(ours.read_text()[:4000])
    assert calibrate()[0] == 0
    assert read_record(out / "calibration.json")["stages"]


def test_a_result_never_goes_into_the_folder_of_an_experiment(
    bulkcal, small_study, monkeypatch, on_stand_in
):
    """A study is easily called as the experiment that it is about, and names its directory."""
    monkeypatch.chdir(small_study.parent)
    folder = make_folder(Path(small_study.stem))
    there = sorted(folder.iterdir())
    for command in ("calibrate", "diagnose"):
        code, _, err = bulkcal(command, small_study.name, "--out", str(folder))
        assert (code, f"--out {folder}: is the folder of an experiment" in err) == (2, True)
        assert f"such as {folder}_result" in err
    assert on_stand_in == []
    assert bulkcal("calibrate", small_study.name)[0] == 0
    assert Path(f"{folder}_result", "report.html").is_file()
    assert sorted(folder.iterdir()) == there


def test_report_is_whole_when_adding_a_section_is_cut_short(calibrate, out, monkeypatch):
    calibrate()
    report = out / "report.html"
    before = report.read_bytes()

    def killed(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "replace", killed)
    with pytest.raises(KeyboardInterrupt):
        add_section(report, Section("More", "<p>more</p>"))
    assert report.read_bytes() == before


def test_runs_of_other_code_are_said(monkeypatch, tmp_path: Path):
    assert others.older_runs(tmp_path) == ""
    older = [OtherCode(tmp_path / str(i), ("engine",)) for i in range(40)]
    older.append(OtherCode(tmp_path / "x", ("engine", "observables")))
    monkeypatch.setattr(others, "other_code", lambda _root: older)
    assert others.older_runs(tmp_path) == (
        "41 stored runs were made by other code (engine: 41, observables: 1); they are kept in "
        f"{tmp_path} and not used"
    )


def test_case_that_somebody_runs_is_held_by_name(tmp_path: Path):
    (spec,) = specs(1)
    assert others.held_case(spec, tmp_path) is None
    with locked(tmp_path / case_id(spec)):
        assert f"pid {os.getpid()}" in (others.held_case(spec, tmp_path) or "")
    assert others.held_case(spec, tmp_path) is None
