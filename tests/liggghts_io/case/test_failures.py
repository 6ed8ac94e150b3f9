"""A failure says its class, its reason and what the engine said last; only physics is for ever."""

import errno
import os
import stat
import time
from pathlib import Path

import pytest

from liggghts_io import (
    CaseError,
    Failure,
    execute,
    is_final,
    load_result,
    run_case,
    stored_result,
    write_case,
)
from liggghts_io.case import attempt, liggghts
from liggghts_io.case.failure import EngineStopped, failure_of
from minidem import DemError

FULL = OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
_FRAME = "ITEM: TIMESTEP\\n%d\\nITEM: NUMBER OF ATOMS\\n0\\nITEM: BOX BOUNDS ff ff ff\\n"
_HEAD = '"0 1\\n0 1\\n0 1\\nITEM: ATOMS id type x y z vx vy vz radius \\n"'
_NO_GRAINS = f"""
run=$(awk '/^run/{{print $2}}' in.script); every=$(awk '/^dump/{{print $5}}' in.script)
mark=$(awk -F'"' '/^print/{{print $2}}' in.script | sed "s/ step .*/ step $run/")
mkdir post
for step in $(seq 0 $every $run); do printf '{_FRAME}' $step > post/frame_$step.dump
printf {_HEAD} >> post/frame_$step.dump; done
for name in poured landing box1 box2 box3 box4; do echo '# ID' > $name.txt; done
echo "$mark" > log.liggghts; echo "$mark"
"""
"""What LIGGGHTS would leave behind if no grain were poured."""


def raised_from(cause, error):
    """Return an error that was raised because of another."""
    try:
        raise error from cause
    except type(error) as err:
        return err


@pytest.fixture
def failing(monkeypatch):
    """Let the engine raise an error instead of running."""

    def fail(error):
        def run(*_args, **_words):
            raise error

        monkeypatch.setattr(attempt, "run_engine", run)

    return fail


@pytest.fixture
def program(tmp_path, monkeypatch):
    """Put a shell script in the place of LIGGGHTS."""

    def install(body):
        path = tmp_path / "program"
        version = "LIGGGHTS (Version LIGGGHTS-PUBLIC 3.8.0, compiled)"
        path.write_text(f'#!/bin/sh\nif [ "$1" = -h ]; then echo "{version}"; exit; fi\n{body}\n')
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
        monkeypatch.setenv("BULKCAL_LIGGGHTS", str(path))

    return install


@pytest.mark.parametrize(
    ("error", "failure", "reason"),
    [
        (MemoryError(), Failure.KILLED, "memory ran out"),
        (FULL, Failure.DISK, "No space left on device"),
        (OSError(errno.EDQUOT, os.strerror(errno.EDQUOT)), Failure.DISK, "uota exceeded"),
        (raised_from(FULL, EngineStopped(Failure.DISK, "cannot write")), Failure.DISK, "cannot wr"),
        (ZeroDivisionError("oh"), Failure.BUG, "ZeroDivisionError: oh; this is a fault of bulkcal"),
        (ValueError("oh"), Failure.BUG, "ValueError: oh; this is a fault of bulkcal"),
        (EngineStopped(Failure.PHYSICS, "lost"), Failure.PHYSICS, "lost"),
    ],
)
def test_every_failure_has_its_class(small_spec, tmp_path, failing, error, failure, reason):
    failing(error)
    result = execute(small_spec(), tmp_path)
    assert (result.status, result.failure) == ("failed", failure)
    assert reason in result.reason
    assert load_result(result.path) == result
    assert is_final(result) == (failure == Failure.PHYSICS)
    assert (stored_result(tmp_path, result.case_id) is not None) == is_final(result)
    text = result.path / "traceback.txt"
    assert text.exists() == (failure == Failure.BUG)
    if text.exists():
        assert "Traceback" in text.read_text()
        assert str(text) in result.reason


def test_the_disk_is_found_below_other_errors():
    assert failure_of(raised_from(raised_from(FULL, ValueError("x")), DemError("y"))) == "disk"
    handling = DemError("raised while the other was handled")
    handling.__context__ = FULL
    assert failure_of(handling) == "disk"
    assert failure_of(DemError("lost grains")) is None
    assert failure_of(FileNotFoundError(errno.ENOENT, "x")) is None


def test_what_may_go_better_is_run_again_and_the_result_is_right(small_spec, tmp_path, failing):
    truth = execute(small_spec(), tmp_path / "truth").observables
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(attempt, "run_engine", lambda *_: (_ for _ in ()).throw(MemoryError()))
        assert execute(small_spec(), tmp_path / "runs").failure == Failure.KILLED
    assert execute(small_spec(), tmp_path / "runs").observables == truth


def test_a_traceback_does_not_outlive_its_fault(small_spec, tmp_path):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(attempt, "run_engine", lambda *_: 1 / 0)
        failed = execute(small_spec(), tmp_path)
    assert (failed.path / "traceback.txt").is_file()
    assert execute(small_spec(), tmp_path).status == "ok"
    assert not (failed.path / "traceback.txt").exists()


def test_a_second_run_that_is_killed_keeps_the_first_result(small_spec, tmp_path, failing):
    case = write_case(small_spec(), tmp_path)
    first = run_case(case)
    failing(EngineStopped(Failure.KILLED, "killed"))
    assert run_case(case, again=True).failure == Failure.KILLED
    assert load_result(case) == first
    assert (case / "output" / "end.json").is_file()


def test_interrupting_a_run_stores_nothing(small_spec, tmp_path, failing):
    failing(KeyboardInterrupt())
    with pytest.raises(KeyboardInterrupt):
        execute(small_spec(), tmp_path)
    assert not list(tmp_path.rglob("result.json"))


@pytest.mark.parametrize(
    ("body", "failure", "reason"),
    [
        ("kill -9 $$", Failure.KILLED, "liggghts was killed by SIGKILL"),
        ("exit 137", Failure.KILLED, "liggghts was killed by SIGKILL"),
        ("exit 3", Failure.PHYSICS, "liggghts: exit code 3"),
        ("echo ERROR: lost atoms", Failure.PHYSICS, "liggghts: ERROR: lost atoms"),
        ("echo ERROR on proc 0: Failed to allocate 80000 bytes for array x; exit 1",
         Failure.KILLED, "memory ran out: ERROR on proc 0: Failed to allocate"),
        ("echo '   100   5   1e-3'", Failure.KILLED, "the engine was stopped at step 100 of"),
        ("sleep 60", Failure.TIME, "stopped after 1 s, the limit of a run"),
        (_NO_GRAINS, Failure.PHYSICS, "no grain was poured"),
        (_NO_GRAINS + "truncate -s -5 post/frame_0.dump", Failure.DISK, "frame_0.dump: the head"),
        (_NO_GRAINS + "rm post/frame_0.dump", Failure.DISK, "frame_0.dump: missing"),
        (_NO_GRAINS + "truncate -s 0 log.liggghts", Failure.DISK, "the run stopped at step"),
        (_NO_GRAINS + "truncate -s 0 landing.txt", Failure.DISK, "landing.txt: empty or cut short"),
    ],
)  # fmt: skip
def test_liggghts_may_end_in_many_ways(
    small_spec, tmp_path, program, monkeypatch, body, failure, reason
):
    program(body)
    monkeypatch.setattr(liggghts, "_LIMIT_S", 1.0)
    result = execute(small_spec("plate_impact", engine="liggghts"), tmp_path / "runs")
    assert (result.status, result.failure) == ("failed", failure)
    assert reason in result.reason
    assert is_final(result) == (failure == Failure.PHYSICS)
    if failure == Failure.DISK:
        assert not (result.path / "output").exists()


def test_liggghts_out_of_time_ends_with_all_that_it_started(small_spec, tmp_path, program):
    child = tmp_path / "child"
    program(f"sleep 300 & echo $! > {child}; wait")
    result = execute(small_spec("plate_impact", engine="liggghts"), tmp_path, limit_s=0.6)
    assert result.reason == "liggghts was stopped after 0.6 s, the limit of a run"
    stat = Path(f"/proc/{int(child.read_text())}/stat")
    deadline = time.monotonic() + 10.0
    while stat.exists() and " Z " not in stat.read_text() and time.monotonic() < deadline:
        time.sleep(0.02)
    assert not stat.exists() or " Z " in stat.read_text()


def test_time_out_stands_until_more_time_is_given(small_spec, tmp_path):
    spec = small_spec("heap")
    late = execute(spec, tmp_path, limit_s=0.001)
    assert (late.status, late.failure) == ("failed", Failure.TIME)
    assert late.reason == "minidem was stopped after 0.001 s, the limit of a run"
    assert stored_result(tmp_path, late.case_id, 0.001) == late
    assert execute(spec, tmp_path, limit_s=0.001) == late  # not run again
    assert stored_result(tmp_path, late.case_id) is None
    assert stored_result(tmp_path, late.case_id, late.wall_s + 1.0) is None
    assert execute(spec, tmp_path, limit_s=600.0).status == "ok"
    assert execute(spec, tmp_path, limit_s=0.001).status == "ok"  # what is known stays


@pytest.mark.liggghts
def test_liggghts_on_a_full_disk_is_stopped(small_spec, tmp_path, monkeypatch):
    """It goes on without a word when a write fails."""
    monkeypatch.setattr(liggghts, "_LEAST_FREE", 1 << 62)
    result = execute(small_spec("plate_impact", engine="liggghts"), tmp_path)
    assert (result.failure, result.reason[:16]) == ("disk", "the disk is full")
    assert not list(result.path.glob("attempt-*"))  # it would keep the disk full
    monkeypatch.undo()
    assert execute(small_spec("plate_impact", engine="liggghts"), tmp_path).status == "ok"


@pytest.mark.liggghts
def test_liggghts_shows_its_steps_while_it_runs(small_spec, tmp_path):
    case = write_case(small_spec(engine="liggghts"), tmp_path)
    seen: list[tuple[int, int]] = []
    run_case(case, progress=lambda step, total: seen.append((step, total)))
    steps = [step for step, _ in seen]
    assert steps == sorted(steps)
    assert len(set(steps)) > 90  # a hundredth each, whatever the number of frames
    assert {total for _, total in seen} == {steps[-1]}


def test_a_program_that_is_no_liggghts_is_refused(small_spec, tmp_path, program, monkeypatch):
    program("exit 0")
    (tmp_path / "program").write_text("#!/bin/sh\nexit 0\n")
    with pytest.raises(CaseError, match="names no version; mend BULKCAL_LIGGGHTS"):
        execute(small_spec(engine="liggghts"), tmp_path / "runs")
    monkeypatch.setenv("BULKCAL_LIGGGHTS", str(tmp_path / "nowhere"))
    with pytest.raises(CaseError, match="nowhere: cannot be run"):
        execute(small_spec(engine="liggghts"), tmp_path / "runs")


def test_a_killed_question_for_the_version_is_asked_again(tmp_path):
    path, mark = tmp_path / "program", tmp_path / "asked"
    answer = "echo 'Version LIGGGHTS-PUBLIC 3.8.0, compiled'"
    path.write_text(f"#!/bin/sh\ntest -e {mark} && {answer} && exit 0\ntouch {mark}\nkill -9 $$\n")
    path.chmod(0o755)
    assert liggghts.liggghts_version(str(path)) == "LIGGGHTS-PUBLIC 3.8.0"


@pytest.mark.liggghts
def test_the_question_for_the_version_leaves_no_log(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    liggghts.liggghts_version.cache_clear()
    assert liggghts.liggghts_version(liggghts.find_liggghts()).startswith("LIGGGHTS")
    assert list(tmp_path.iterdir()) == []


def test_another_version_of_liggghts_is_refused(small_spec, tmp_path, program):
    case = write_case(small_spec(engine="liggghts"), tmp_path / "case")
    program("exit 0")
    path = tmp_path / "program"
    path.write_text(path.read_text().replace("3.8.0", "3.9.0"))
    liggghts.liggghts_version.cache_clear()
    with pytest.raises(CaseError, match=r"engine: LIGGGHTS-PUBLIC 3.8.0, now LIGGGHTS-PUBLIC 3.9"):
        run_case(case)
