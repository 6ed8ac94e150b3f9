"""The command as a whole: help, versions, and how it ends when something goes wrong."""

from __future__ import annotations

import errno
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from calibrate.cli import cases as cli_cases
from calibrate.cli.verbs import VERBS as EVERY
from liggghts_io import CaseError
from tests.calibrate.cli.words import PAIRS

COMMAND = [sys.executable, "-c", "from calibrate.cli.main import main; main()"]
VERBS = sorted(name for name, verb in EVERY.items() if not verb.is_group)


def test_bare_command_shows_help_on_stdout(bulkcal):
    code, out, err = bulkcal()
    assert (code, err) == (0, "")
    assert out.count("\n") > 10, "help has lines"
    for verb in VERBS:
        assert re.search(rf"^  {verb} ", out, re.MULTILINE)
    assert "..." not in out.partition("Commands:")[2], "what a command does is said in full"


def test_help_is_there_before_what_the_verbs_need_is_loaded():
    code = """
import sys
from calibrate.cli.main import main
try:
    main(["--help"])
except SystemExit:
    print(sorted({"numpy", "pandas", "liggghts_io.experiments"} & set(sys.modules)))
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("generte", "Did you mean 'generate', 'render'? (see: bulkcal --help)"),
        ("photo siz", "Did you mean 'size'? (see: bulkcal photo --help)"),
        ("photo size", "(see: bulkcal photo size --help)"),
    ],
)
def test_a_wrong_verb_is_told_with_the_one_that_was_meant(bulkcal, words: str, said: str):
    code, _, err = bulkcal(*words.split())
    assert code == 2
    assert said in err


@pytest.mark.parametrize("name", EVERY)
def test_every_verb_is_where_the_table_says(bulkcal, name: str):
    code, out, _ = bulkcal(name, "--help")
    assert code == 0
    assert f"Usage: bulkcal {name} " in out


def test_version_names_both_engines(bulkcal):
    code, out, _ = bulkcal("--version")
    assert code == 0
    assert re.match(r"bulkcal \d+\.\d+", out)
    assert "engine minidem" in out
    assert re.search("LIGGGHTS-PUBLIC 3|liggghts: not found", out)


def test_version_says_when_liggghts_is_missing(bulkcal, monkeypatch, tmp_path: Path):
    monkeypatch.delenv("BULKCAL_LIGGGHTS", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert "liggghts: not found" in bulkcal("--version")[1]


OUT_OF_REACH = {
    "proc": "/proc/nothing/here",
    "long name": "x" * 300,
    "long path": "/".join(["y" * 200] * 30),
    "empty": "",
    "blank": "  ",
    "below a file": "FILE/below",
}


@pytest.mark.parametrize("place", OUT_OF_REACH)
@pytest.mark.parametrize("verb", ["generate", "demo", "calibrate", "diagnose"])
def test_a_directory_out_of_reach_is_refused_before_any_work(
    verb: str, place: str, bulkcal, tmp_path: Path, monkeypatch, small_study: Path
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "FILE").write_text("")
    words = {"generate": ["heap", *PAIRS], "demo": []}.get(verb, [str(small_study)])
    code, out, err = bulkcal(verb, *words, "--out", OUT_OF_REACH[place])
    assert (code, out) == (2, "")
    assert err.splitlines()[-1].startswith("bulkcal: ")
    assert not list(tmp_path.rglob("case.json"))


def test_a_read_only_place_is_found_before_the_first_run(bulkcal, tmp_path: Path, monkeypatch):
    """Nobody computes for a minute what cannot be written; nor does root, whom no mode stops."""

    def read_only(*args, **kwargs):
        raise OSError(errno.EROFS, os.strerror(errno.EROFS))

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(tempfile, "TemporaryFile", read_only)
    code, _, err = bulkcal("demo")
    assert code == 2
    assert "--out demo: cannot be written (Read-only file system)" in err


ERRORS = {
    "disk full": (OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), "a/b"), 2, "free some space"),
    "permission": (PermissionError(errno.EACCES, "Permission denied", "a/b"), 2, "permission"),
    "memory": (MemoryError(), 2, "more memory than the machine has"),
    "our mistake": (ZeroDivisionError("no"), 1, "a fault of bulkcal, not of your study"),
    "our message": (CaseError("case: no good\x1b[31m"), 2, "case: no good\\x1b[31m"),
}


@pytest.mark.parametrize("name", ERRORS)
def test_every_error_is_one_message_without_a_traceback(
    name: str, bulkcal, tmp_path: Path, monkeypatch
):
    error, expected, words = ERRORS[name]

    def fail(*args, **kwargs):
        raise error

    bulkcal("generate", "heap", *PAIRS, "--out", str(tmp_path / "case"))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setattr(cli_cases, "run_case", fail)
    code, out, err = bulkcal("run", str(tmp_path / "case"))
    assert (code, out) == (expected, "")
    assert words in err
    assert "Traceback" not in err
    reports = list(tmp_path.glob("bulkcal-*.txt"))
    assert bool(reports) == (expected == 1)
    if reports:
        report = reports[0].read_text()
        assert "Traceback" in report
        assert "ZeroDivisionError" in report
        assert "command: bulkcal run" in report
        assert str(reports[0]) in err


def test_a_reader_that_goes_away_is_no_error(tmp_path: Path):
    """As in ``bulkcal apparatus heap | head -1``."""
    with subprocess.Popen(
        [*COMMAND, "apparatus", "heap", "--json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as process:
        assert process.stdout is not None
        process.stdout.close()
        _, err = process.communicate(timeout=60)
    assert err == b""
    assert process.returncode == 141  # as SIGPIPE ends other programs


@pytest.mark.parametrize(("stream", "code"), [("<&-", 0), (">&-", 0), ("2>&-", 0), ("2>&1 >&-", 0)])
def test_a_closed_stream_takes_nothing_and_harms_nothing(stream: str, code: int, tmp_path: Path):
    line = f'"$@" {stream}'
    words = ["generate", "heap", *PAIRS, "--out", str(tmp_path / "case")]
    done = subprocess.run(
        ["sh", "-c", line, "sh", *COMMAND, *words], capture_output=True, check=False
    )
    assert done.returncode == code
    assert b"Error" not in done.stderr
    assert (tmp_path / "case" / "case.json").read_text().startswith("{")


@pytest.mark.parametrize(
    ("encoding", "angle"), [("ascii", "28.9+-0.2 u2?"), ("latin-1", "28.9±0.2 µ²?")]
)
def test_letters_that_a_terminal_lacks_are_written_in_others(encoding: str, angle: str):
    code = (
        "from calibrate.cli.main import open_streams, Screen\n"
        "open_streams()\n"
        "Screen().result('28.9\\xb10.2 \\xb5\\xb2\\u7c92')\n"
        "Screen().remark('28.9\\xb10.2 \\xb5\\xb2\\u7c92')\n"
    )
    environment = os.environ | {"PYTHONIOENCODING": encoding}
    done = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, check=True
    )
    assert done.stdout.decode(encoding) == done.stderr.decode(encoding) == f"{angle}\n"


def test_an_interrupt_while_modules_are_loaded_leaves_no_traceback():
    code = (
        "import sys\n"
        "class Interrupt:\n"
        "    def find_spec(self, name, path=None, target=None):\n"
        "        if name == 'typer':\n"
        "            raise KeyboardInterrupt\n"
        "sys.meta_path.insert(0, Interrupt())\n"
        "from calibrate.cli.entry import main\n"
        "main()\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (130, b"", b"")


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completion_knows_experiments_and_apparatus(shell: str):
    def offered(*words: str) -> str:
        typed = " ".join(["bulkcal", *words])
        environment = os.environ | {
            "_BULKCAL_COMPLETE": f"complete_{shell}",
            "COMP_WORDS": typed, "COMP_CWORD": str(len(words)),
            "_TYPER_COMPLETE_ARGS": typed, "_TYPER_COMPLETE_FISH_ACTION": "get-args",
        }  # fmt: skip
        return subprocess.run(
            COMMAND, env=environment, capture_output=True, text=True, check=False, timeout=60
        ).stdout

    assert "heap" in offered("generate", "he")
    apparatus = offered("generate", "heap", "-a", "pour_")
    assert "pour_stages=" in apparatus
    assert "pour_depth_m=" not in apparatus, "that is a parameter of another experiment"
