"""One process at a time writes in a case directory, and a dead one leaves nothing in the way."""

import errno
import fcntl
import os
import signal
import threading

import pytest

from liggghts_io import CaseError, execute, post_case, run_case, write_case
from liggghts_io.case.lock import locked
from liggghts_io.errors import DiskFull
from tests.liggghts_io.case.processes import (
    alive,
    kill,
    kill_in_the_middle,
    result_of,
    start_holder,
    start_run,
    wait_for,
)

ENGINES = ["minidem", pytest.param("liggghts", marks=pytest.mark.liggghts)]


@pytest.fixture
def spec_of(timed_spec, small_spec):
    """Make a small spec of any experiment that gives numbers."""

    def make(experiment, **changes):
        return (
            timed_spec(**changes) if experiment == "conveyor" else small_spec(experiment, **changes)
        )

    return make


@pytest.mark.parametrize("engine", ENGINES)
def test_two_processes_run_a_case_once_and_both_have_its_result(timed_spec, tmp_path, engine):
    truth = execute(timed_spec(engine=engine), tmp_path / "truth").observables
    case = write_case(timed_spec(engine=engine), tmp_path / "case")
    first = start_run(case)
    wait_for(lambda: list(case.glob("attempt-*/post/frame_0.dump")), "the first never began")
    others = [start_run(case) for _ in range(2)]
    results = [result_of(one)[0] for one in (first, *others)]
    assert [dict(result.observables) for result in results] == [truth] * 3
    # One run: its duration and the digest of its output are in all three.
    assert len({(result.wall_s, result.output) for result in results}) == 1


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("experiment", ["conveyor", "plate_impact"])
def test_a_killed_run_is_no_result_and_the_next_run_is_right(spec_of, tmp_path, experiment, engine):
    spec = spec_of(experiment, engine=engine)
    truth = execute(spec, tmp_path / "truth").observables
    case = write_case(spec, tmp_path / "case")
    kill_in_the_middle(case)
    with pytest.raises(CaseError, match=r"the last run stopped at step \d+ of \d+; run it again"):
        post_case(case)
    assert not (case / "result.json").exists()
    # LIGGGHTS does not outlive the process that started it.
    wait_for(lambda: not alive(str(case)), "an engine outlived its parent")
    assert run_case(case).observables == truth
    assert not list(case.glob("attempt-*"))
    assert post_case(case).observables == truth


def test_a_run_killed_before_its_result_was_stored_is_not_run_again(timed_spec, tmp_path):
    spec = timed_spec()
    first = execute(spec, tmp_path)
    (first.path / "result.json").unlink()
    again = execute(spec, tmp_path)
    assert again == first  # with the duration and the output of the one run there was


def test_whoever_waits_says_for_whom(small_spec, tmp_path):
    write_case(small_spec(), tmp_path)
    said: list[str] = []
    with locked(tmp_path):
        thread = threading.Thread(target=lambda: run_case(tmp_path, tell=said.append))
        thread.start()
        wait_for(lambda: said, "nothing was said")
    thread.join()
    pid, host = os.getpid(), os.uname().nodename
    assert said[0].startswith(f"waiting for pid {pid} on host {host}, at work here since ")
    assert not (tmp_path / "lock.holder").exists()


def test_a_stopped_holder_keeps_the_lock_and_a_dead_one_loses_it(tmp_path):
    holder = start_holder(tmp_path)
    entered = threading.Event()

    def enter() -> None:
        with locked(tmp_path):
            entered.set()

    holder.send_signal(signal.SIGSTOP)
    thread = threading.Thread(target=enter)
    thread.start()
    assert not entered.wait(1.5)  # longer than the patience of the one who waits
    kill(holder)
    assert entered.wait(10.0)
    thread.join()


@pytest.mark.parametrize("number", [errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP])
def test_a_file_system_without_locks_is_refused(small_spec, tmp_path, monkeypatch, number):
    def flock(descriptor, how):
        raise OSError(number, os.strerror(number))

    monkeypatch.setattr(fcntl, "flock", flock)
    with pytest.raises(CaseError, match="this file system has no file locks; choose a directory"):
        write_case(small_spec(), tmp_path / "case")


def test_a_place_that_cannot_be_written_is_refused(small_spec, tmp_path):
    (tmp_path / "file").write_text("")
    for place in (tmp_path / "file" / "case", tmp_path / ("x" * 300), tmp_path / "file"):
        with pytest.raises(CaseError, match=r"cannot be written .*choose another directory"):
            write_case(small_spec(), place)
        with pytest.raises(CaseError, match="cannot be written"):
            execute(small_spec(), place)


def test_a_full_disk_is_said_and_leaves_no_temporary_file(small_spec, tmp_path, monkeypatch):
    def full(self, content):
        self.touch()
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr("pathlib.Path.write_bytes", full)
    with pytest.raises(DiskFull, match="No space left on device; free some space and try again"):
        write_case(small_spec(), tmp_path / "case")
    assert not (tmp_path / "case").exists()
    mine = tmp_path / "mine" / "notes.txt"
    mine.parent.mkdir()
    mine.write_text("mine")
    with pytest.raises(DiskFull):
        write_case(small_spec(), mine.parent)
    assert mine.read_text() == "mine"
    result = execute(small_spec(), tmp_path)
    assert (result.status, result.failure) == ("failed", "disk")
    assert not list(tmp_path.rglob("*.tmp"))
