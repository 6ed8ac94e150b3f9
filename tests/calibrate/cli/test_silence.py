"""The real program in a pipe: something is said at least every two seconds, for both engines."""

from __future__ import annotations

import functools
import os
import subprocess
import sys
import time

import pytest

from tests.calibrate.cli.words import PAIRS

SILENCE_S = 2.0
SLACK_S = 3.0  # threads of a busy machine wake up late
COMMAND = [sys.executable, "-c", "from calibrate.cli.main import main; main()"]


def listen(words: list[str]) -> tuple[list[float], str]:
    """Run the command; return the pauses, without the start of Python, and what it said."""
    process = subprocess.Popen(
        [*COMMAND, *words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, bufsize=0
    )
    assert process.stdout is not None
    with process:
        last, found, said = time.monotonic(), [], []
        while part := os.read(process.stdout.fileno(), 65536):
            found.append(time.monotonic() - last)
            said.append(part)
            last = time.monotonic()
    assert process.returncode == 0
    return found[1:], b"".join(said).decode()


@pytest.fixture(scope="module")
def heard(tmp_path_factory):
    """Return a function that runs and draws a heap, once with each engine, and listens."""

    @functools.cache
    def run(engine: str) -> dict[str, tuple[list[float], str]]:
        case = str(tmp_path_factory.mktemp(engine) / "case")
        listen(["generate", "heap", *PAIRS, "--engine", engine, "--out", case])
        return {word: listen([word, case]) for word in ("run", "render")}

    return run


@pytest.mark.slow
@pytest.mark.parametrize(
    "engine", ["minidem", pytest.param("liggghts", marks=pytest.mark.liggghts)]
)
def test_a_run_is_never_silent(engine: str, heard):
    for word, (gaps, _) in heard(engine).items():
        assert max(gaps, default=0.0) < SILENCE_S + SLACK_S, word


@pytest.mark.liggghts
def test_a_run_of_liggghts_says_how_far_it_is(heard):
    """It was 0 % from the first to the last line."""
    _, text = heard("liggghts")["run"]
    shares = [line.partition(" %")[0].rpartition(" ")[2] for line in text.splitlines()]
    numbers = [int(share) for share in shares if share.isdecimal()]
    assert numbers == sorted(numbers)
    assert any(0 < number < 100 for number in numbers), text
