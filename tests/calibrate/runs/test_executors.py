"""Executors by name, their options, and executors that behave oddly."""

from __future__ import annotations

import os
import signal
import stat
import sys
from pathlib import Path

import pytest

from calibrate.errors import CalibrationError
from calibrate.executor_names import check_executor
from calibrate.runs.campaign import Campaign
from calibrate.runs.executors import clusters
from calibrate.runs.executors.choose import executor_of
from calibrate.runs.executors.clusters import job_script
from calibrate.runs.executors.options import job_options
from calibrate.runs.executors.run_options import RunOptions
from calibrate.runs.executors.workers import WorkerPool
from tests.calibrate.runs import dask_cluster as there
from tests.calibrate.runs.test_campaign import specs
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
    with pytest.raises(CalibrationError, match=r"^--executor: "):
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
    assert "--death-timeout 600" in command  # a loaded machine needs more than a minute to start


# The file of a job may be gone when `sbatch` returns: a queue keeps a copy, and so does this one.
SBATCH = """#!/bin/sh
for last; do :; done
cp "$last" {jobs}_$$
setsid sh {jobs}_$$ > /dev/null 2>&1 &
echo $! >> {jobs}
echo "Submitted batch job $!"
"""


@pytest.mark.timeout(300)  # a job that never starts is waited for
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
