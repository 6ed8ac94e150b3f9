"""Executors that raise, break, lose runs, answer late or never: nothing lost, nothing run twice."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor
from pathlib import Path

import pytest

from calibrate.errors import CalibrationError
from calibrate.runs import campaign as campaign_module
from calibrate.runs.campaign import Campaign
from calibrate.runs.flight import Flight
from liggghts_io import CaseResult
from tests.calibrate import stand_in
from tests.calibrate.runs import slow_sim
from tests.calibrate.runs.test_campaign import ran, specs


class Odd(Executor):
    """Runs every call at once, unless it is told to do something else with it."""

    def __init__(self, oddity: Callable[[int, Future, Callable], bool]) -> None:
        self.calls = 0
        self._oddity = oddity

    def submit(self, fn, /, *args, **kwargs):
        """Do as told, else call."""
        self.calls += 1
        future: Future = Future()
        if not self._oddity(self.calls, future, lambda: fn(*args, **kwargs)):
            future.set_result(fn(*args, **kwargs))
        return future


def on(executor: Executor, root: Path, told: list[str] | None = None, **words) -> Campaign:
    tell = (told if told is not None else []).append
    return Campaign(root, slow_sim.execute, workers=1, executor=executor, tell=tell, **words)


def test_executor_that_dies_at_submit_ends_the_campaign_with_a_remedy(tmp_path: Path):
    def die_third(call: int, _future: Future, _run: Callable) -> bool:
        if call == 3:
            msg = "cannot schedule new futures after shutdown"
            raise RuntimeError(msg)
        return False

    with (
        pytest.raises(CalibrationError, match=r"cannot schedule.*kept in.*start the same command"),
        on(Odd(die_third), tmp_path) as campaign,
    ):
        campaign(specs(1, 2, 3, 4), "dies")
    assert ran(tmp_path) == [1, 2]


def test_executor_that_breaks_or_gives_a_run_up_loses_nothing(tmp_path: Path):
    def lose_two(call: int, future: Future, _run: Callable) -> bool:
        if call == 1:
            future.set_exception(BrokenExecutor("node 7 went down"))
        if call == 2:
            future.cancel()
            future.set_running_or_notify_cancel()
        return call <= 2

    told: list[str] = []
    with on(Odd(lose_two), tmp_path, told) as campaign:
        table = campaign(specs(1, 2, 3), "gives up")
    assert table["status"].tolist() == ["ok"] * 3
    assert sorted(ran(tmp_path)) == [1, 2, 3]
    assert "node 7 went down; it is tried again" in told[0]
    assert "the executor gave this run up; it is tried again" in told[1]


def test_run_that_the_executor_always_loses_is_a_failure_with_its_words(tmp_path: Path):
    def lose(_call: int, future: Future, _run: Callable) -> bool:
        future.set_exception(BrokenExecutor("node 7 went down"))
        return True

    executor = Odd(lose)
    with on(executor, tmp_path) as campaign:
        (row,) = campaign(specs(1), "lost").to_dict("records")
    assert (row["status"], row["failure"], row["reason"]) == (
        "failed", "killed", "node 7 went down",
    )  # fmt: skip
    assert executor.calls == 2


@pytest.fixture
def impatient(monkeypatch):
    """Let campaigns look after silent runs within a moment."""

    def make(*args):
        return Flight(*args, look_s=0.05, lost_s=0.3)

    monkeypatch.setattr(campaign_module, "Flight", make)


def test_result_whose_message_is_lost_is_found_in_the_directory(tmp_path: Path, impatient):
    def swallow(_call: int, _future: Future, run: Callable) -> bool:
        run()
        return True  # the future is never done

    with on(Odd(swallow), tmp_path, stored=stand_in.stored) as campaign:
        table = campaign(specs(1, 2, 3), "silent")
    assert table["status"].tolist() == ["ok"] * 3
    assert sorted(ran(tmp_path)) == [1, 2, 3]


def test_run_that_began_and_vanished_is_tried_again(tmp_path: Path, impatient):
    at_work: list[float] = []

    def forget_first(call: int, _future: Future, _run: Callable) -> bool:
        if call == 1:
            at_work.append(time.monotonic() + 0.3)
        return call == 1

    def held(_spec, _root) -> str | None:
        return "a worker" if at_work and time.monotonic() < at_work[0] else None

    told: list[str] = []
    with on(Odd(forget_first), tmp_path, told, stored=stand_in.stored, held=held) as campaign:
        table = campaign(specs(1), "vanished")
    assert table["status"].tolist() == ["ok"]
    assert ran(tmp_path) == [1]
    assert "the executor lost this run; it is tried again" in told[0]


def test_late_answer_of_a_run_that_was_taken_from_the_directory_does_no_harm(
    tmp_path: Path, impatient
):
    late: list[threading.Timer] = []

    def answer(future: Future, result: CaseResult) -> None:
        if not future.cancelled():
            future.set_result(result)

    def answer_late(call: int, future: Future, run: Callable) -> bool:
        if call == 1:
            result = run()
            late.append(threading.Timer(0.6, answer, (future, result)))
            late[0].start()
        return call == 1

    with on(Odd(answer_late), tmp_path, stored=stand_in.stored) as campaign:
        table = campaign(specs(*range(1, 9)), "late")
        late[0].join()
    assert table["status"].tolist() == ["ok"] * 8
    assert sorted(ran(tmp_path)) == list(range(1, 9))


def test_pool_of_the_standard_library_that_broke_ends_the_campaign(tmp_path: Path):
    told: list[str] = []
    with (
        ProcessPoolExecutor(1) as pool,
        pytest.raises(CalibrationError, match="start the same command again"),
        on(pool, tmp_path, told) as campaign,
    ):
        campaign(specs(slow_sim.DIES_ONCE, 1), "broken pool")
    assert told[0].endswith("it is tried again")


def test_user_is_told_when_nothing_starts(tmp_path: Path, monkeypatch):
    from calibrate.runs import flight as flight_module

    monkeypatch.setattr(flight_module, "_STUCK_S", 0.2)
    waiting: list[tuple[Future, Callable]] = []

    def keep(_call: int, future: Future, run: Callable) -> bool:
        waiting.append((future, run))
        return True

    def release() -> None:
        future, run = waiting[0]
        future.set_result(run())

    monkeypatch.setattr(campaign_module, "Flight", lambda *args: Flight(*args, look_s=0.05))
    told: list[str] = []
    threading.Timer(1.5, release).start()
    with on(Odd(keep), tmp_path, told) as campaign:
        assert campaign(specs(1), "queued")["status"].tolist() == ["ok"]
    assert [line for line in told if "none has started" in line] == told[:1]
