"""Executors by name, their options, and executors that behave oddly."""

from __future__ import annotations

import os
import signal
import stat
import sys
import threading
import time
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor
from pathlib import Path

import pytest

from calibrate.errors import CalibrationError
from calibrate.executor_names import check_executor
from calibrate.runs import campaign as campaign_module
from calibrate.runs.campaign import Campaign
from calibrate.runs.executors import clusters
from calibrate.runs.executors.choose import executor_of
from calibrate.runs.executors.clusters import job_script
from calibrate.runs.executors.options import job_options
from calibrate.runs.executors.run_options import RunOptions
from calibrate.runs.executors.workers import WorkerPool
from calibrate.runs.flight import Flight
from liggghts_io import CaseResult
from tests.calibrate import stand_in
from tests.calibrate.runs import dask_cluster as there
from tests.calibrate.runs import slow_sim
from tests.calibrate.runs.test_campaign import ran, specs
from tests.paths import ROOT


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("slrum", "unknown executor 'slrum'; did you mean 'slurm'? (known: local, dask-local"),
        ("", "unknown executor ''"),
        ("dask-locl", "unknown executor 'dask-locl'; did you mean 'dask-local'?"),
        ("dask://host", "write the scheduler of a Dask cluster as dask://HOST:PORT"),
        ("dask://host:99999", "dask://HOST:PORT"),
        ("dask://host:1/../x", "dask://HOST:PORT"),
        ("dask://a b:1", "dask://HOST:PORT"),
    ],
)
def test_unknown_executor_is_named_with_the_nearest(text: str, words: str):
    with pytest.raises(ValueError, match=r"known") as refused:
        check_executor(text)
    assert words in str(refused.value)
    with pytest.raises(CalibrationError, match=r"^--executor "):
        RunOptions(executor=text)


def test_names_are_read():
    assert check_executor("dask://login-1.cluster:08786") == ("dask", "login-1.cluster:8786")
    assert check_executor("dask://[::1]:1") == ("dask", "[::1]:1")
    assert check_executor("pbs") == ("pbs", "")
    with executor_of("local", 3) as pool:
        assert isinstance(pool, WorkerPool)
        assert pool.workers == 3


def test_missing_extra_is_one_line_with_the_command(monkeypatch):
    monkeypatch.setattr(clusters, "find_spec", lambda _name: None)
    with pytest.raises(CalibrationError) as refused:
        executor_of("slurm", 2)
    assert str(refused.value) == (
        "--executor slurm: needs the extra packages for clusters; run: "
        "python -m pip install 'bulkcal[cluster]'"
    )


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"quue": "short"}, "unknown name 'quue'; did you mean 'queue'?"),
        ({"cores": "many"}, "cores = 'many': give a whole number of cores"),
        ({"cores": 0}, "cores = 0: give a whole number"),
        ({"memory": "8"}, "memory = '8': give a size with its unit, for example 8GB"),
        ({"walltime": "a day"}, "walltime = 'a day': give hours, minutes and seconds"),
        ({"walltime": "12:30"}, "walltime = '12:30': give hours, minutes and seconds"),
        ({"queue": "short\n#SBATCH --uid=0"}, "give one line of text"),
        ({"setup": 3}, "give a line, or a list of lines"),
    ],
)
def test_wrong_options_are_refused(options, words: str):
    with pytest.raises(CalibrationError, match="--executor-option ") as refused:
        RunOptions(executor="slurm", options=options)
    assert words in str(refused.value)
    with pytest.raises(CalibrationError, match="the executor 'local' has no options"):
        RunOptions(options={"queue": "short"})


def test_words_say_the_same_again():
    how = RunOptions(4, "slurm", {"queue": "a b", "setup": ["x", "y"]}, 600.0)
    assert how.words == (
        " --workers 4 --executor slurm --executor-option 'queue=a b' --executor-option setup=x "
        "--executor-option setup=y --time-limit 600"
    )
    assert RunOptions().words == ""


SCRIPTS = {
    "slurm": ["#SBATCH -J bulkcal", "#SBATCH -p short", "#SBATCH -A dem", "#SBATCH -n 1",
              "#SBATCH --cpus-per-task=4", "#SBATCH --mem=8G", "#SBATCH -t 12:30:00",
              "#SBATCH --exclusive"],
    "pbs": ["#PBS -N bulkcal", "#PBS -q short", "#PBS -A dem",
            "#PBS -l select=1:ncpus=4:mem=7630MB", "#PBS -l walltime=12:30:00",
            "#PBS --exclusive"],
    "lsf": ["#BSUB -J bulkcal", "#BSUB -q short", '#BSUB -P "dem"', "#BSUB -n 4",
            '#BSUB -R "span[hosts=1]"', "#BSUB -W 12:30", "#BSUB --exclusive"],
}  # fmt: skip


@pytest.mark.parametrize("kind", list(SCRIPTS))
def test_job_scripts_ask_the_queue_for_what_was_asked(kind: str):
    pytest.importorskip("dask_jobqueue")
    asked = job_options(
        {
            "queue": "short", "account": "dem", "walltime": "12:30:00", "memory": "8GB",
            "cores": "4", "setup": "module load gcc", "directive": ["--exclusive"],
        }
    )  # fmt: skip
    before = signal.getsignal(signal.SIGINT)
    lines = job_script(kind, asked).splitlines()
    assert signal.getsignal(signal.SIGINT) is before  # dask-jobqueue 0.9 changes it
    assert [line for line in SCRIPTS[kind] if line not in lines] == []
    assert lines.index("module load gcc") == len(lines) - 2
    command = lines[-1]
    assert command.startswith(f"{sys.executable} -m distributed.cli.dask_worker tcp://SCHEDULER")
    assert "--nthreads 1 " in command  # an engine has its process for itself
    assert "--nworkers 4 " in command


SBATCH = """#!/bin/sh
for last; do :; done
setsid sh "$last" > /dev/null 2>&1 &
echo $! >> {jobs}
echo "Submitted batch job $!"
"""


def test_campaign_through_a_queue_whose_jobs_run_here(tmp_path: Path, monkeypatch):
    """`sbatch` is a shell script that starts the job; `scancel` ends it."""
    pytest.importorskip("dask_jobqueue")
    programs, jobs, root = tmp_path / "bin", tmp_path / "jobs", tmp_path / "runs"
    programs.mkdir()
    texts = {"sbatch": SBATCH.format(jobs=jobs), "scancel": '#!/bin/sh\nkill -9 -- "-$1"\n'}
    for name, text in texts.items():
        (programs / name).write_text(text)
        (programs / name).chmod(stat.S_IRWXU)
    monkeypatch.setenv("PATH", f"{programs}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    options = {"cores": 1, "memory": "1GB", "interface": "lo", "local_directory": str(tmp_path)}
    with executor_of("slurm", 2, options) as executor, Campaign(
        root, there.execute, executor=executor, workers=executor.workers
    ) as campaign:  # fmt: skip
        assert campaign(specs(1, 2, 3, 4), "jobs")["status"].tolist() == ["ok"] * 4
    assert sorted(seed for seed, _ in there.starts(root)) == [1, 2, 3, 4]
    assert len(jobs.read_text().split()) == 2
    there.wait_until(lambda: not any(Path(f"/proc/{job}").exists() for job in alive(jobs)), 20.0)


def alive(jobs: Path) -> list[str]:
    """Return the jobs whose process is no zombie."""
    found = []
    for job in jobs.read_text().split():
        status = Path(f"/proc/{job}/stat")
        if status.exists() and status.read_text().rpartition(")")[2].split()[0] != "Z":
            found.append(job)
    return found


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


def test_command_refuses_before_anything_is_read(bulkcal, tmp_path: Path):
    study = str(tmp_path / "no.toml")
    code, _, err = bulkcal("calibrate", study, "--executor", "dask-locl")
    assert (code, "did you mean 'dask-local'?" in err) == (2, True)
    code, _, err = bulkcal("calibrate", study, "--executor", "pbs", "--executor-option", "quue=a")
    assert (code, "did you mean 'queue'?" in err) == (2, True)
    code, _, err = bulkcal("calibrate", study, "--executor-option", "queue")
    assert (code, "write --executor-option name=value" in err) == (2, True)
    code, _, err = bulkcal("calibrate", study, "--time-limit", "0")
    assert (code, "--time-limit" in err) == (2, True)


def test_dry_run_shows_the_job_script(bulkcal, small_study: Path, on_stand_in):
    pytest.importorskip("dask_jobqueue")
    code, out, _ = bulkcal(
        "calibrate", str(small_study), "--executor", "slurm", "--executor-option", "queue=short",
        "--dry-run",
    )  # fmt: skip
    assert code == 0
    assert "#SBATCH -p short" in out
    assert RunOptions(limit_s=600.0).facts()["time limit of a run"] == "600 s"
