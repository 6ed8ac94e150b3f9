"""The real program in a pipe: something is said at least every two seconds, for both engines."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.calibrate.cli.words import PAIRS

SILENCE_S = 2.0
SLACK_S = 3.0  # threads of a busy machine wake up late
COMMAND = [sys.executable, "-c", "from calibrate.cli.main import main; main()"]


def gaps(words: list[str]) -> list[float]:
    """Run the command and return the pauses between what it says, without the start of Python."""
    process = subprocess.Popen(
        [*COMMAND, *words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, bufsize=0
    )
    assert process.stdout is not None
    with process:
        last, found = time.monotonic(), []
        while os.read(process.stdout.fileno(), 65536):
            found.append(time.monotonic() - last)
            last = time.monotonic()
    assert process.returncode == 0
    return found[1:]


@pytest.mark.slow
@pytest.mark.parametrize(
    "engine", ["minidem", pytest.param("liggghts", marks=pytest.mark.liggghts)]
)
def test_a_run_is_never_silent(engine: str, tmp_path: Path):
    case = str(tmp_path / "case")
    gaps(["generate", "heap", *PAIRS, "--engine", engine, "--out", case])
    for words in (["run", case], ["render", case]):
        assert max(gaps(words), default=0.0) < SILENCE_S + SLACK_S


@pytest.mark.liggghts
def test_a_run_of_liggghts_says_how_far_it_is(tmp_path: Path, monkeypatch):
    """It was 0 % from the first to the last line."""
    case = str(tmp_path / "case")
    subprocess.run(
        [*COMMAND, "generate", "heap", *PAIRS, "--engine", "liggghts", "--out", case], check=True,
        stdout=subprocess.DEVNULL,
    )  # fmt: skip
    done = subprocess.run([*COMMAND, "run", case], check=True, capture_output=True, text=True)
    shares = [line.partition(" %")[0].rpartition(" ")[2] for line in done.stderr.splitlines()]
    numbers = [int(share) for share in shares if share.isdecimal()]
    assert numbers == sorted(numbers)
    assert any(0 < number < 100 for number in numbers), done.stderr
