"""The ``minidem`` command: any arguments and any script end with exit code 0, 2 or 130."""

from __future__ import annotations

import contextlib
import os
import resource
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from minidem import cli
from tests.minidem.script.test_acceptance import POUR, SCRIPT, after

MOST_BYTES = 2 * 1024**3
"""Memory that no number in a script may make the command take beyond what it has."""
LONGEST_S = 20
FULL = after(
    POUR.format(seed=32452843, target="particles_in_region 5")
    + """variable n equal count(all)
variable k loop 3
label again
group low region bc
compute c all reduce sum vz
fix pr all print 2 "at ${n}" file p.txt
fix g all gravity 9.81 vector 0 0 -1
dump d all custom 2 post/d_*.dump id x
thermo_style custom step atoms ke v_n c_c
thermo 2
restart 3 r.*
if "${n} > 1" then "print many" else "print few"
next k
jump SELF done
label done"""
)
"""A script with many words; its fuzzed children are short runs of few grains."""


@contextlib.contextmanager
def limited(folder: Path) -> Iterator[None]:
    """Work in a folder with a limit on memory."""
    before = resource.getrlimit(resource.RLIMIT_AS)
    used = int(Path("/proc/self/statm").read_text().split()[0]) * os.sysconf("SC_PAGE_SIZE")
    with contextlib.chdir(folder):
        resource.setrlimit(resource.RLIMIT_AS, (used + MOST_BYTES, before[1]))
        try:
            yield
        finally:
            resource.setrlimit(resource.RLIMIT_AS, before)


def run(folder: Path, arguments: list[str]) -> int:
    """Run the command as a shell would; return its exit code."""
    with limited(folder), contextlib.redirect_stdout(None):
        try:
            return cli.main(arguments)
        except SystemExit as stop:
            return int(stop.code or 0)


def case(top: Path, script: bytes = SCRIPT.encode()) -> Path:
    """Make a folder of its own with a script."""
    folder = top / "case"
    folder.mkdir()
    (folder / "in.s").write_bytes(script)
    return folder


# -- what it says ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["-in", "in.s", "-log", "../x"], "-log: '../x' leads out of the folder"),
        (["-in", "in.s", "-log", "/tmp/x"], "-log: '/tmp/x' is an absolute path"),
        (["-in", "in.s", "-screen", "../x"], "-screen: '../x' leads out of the folder"),
        (["-in", "in.s", "-log", "in.s/x"], "cannot write 'x'"),
        (["-in", "."], "it is a directory or a device"),
        (["-in", "nowhere"], "cannot open input script 'nowhere': no such file"),
        (["-in", "x" * 300], "File name too long"),
        (["-in", "nul.s"], "contains a zero byte"),
        (["-in", "in.s", "-var", "a"], "-var: variable a index needs at least one value"),
        (["-in", "in.s", "-threads", "9" * 30], "expected a whole number from 1 to 64"),
        (["-in", "in.s", "-echo", "loud"], "invalid choice"),
        (["-in", "in.s", "-folder", "deeper"], "-folder: 'deeper' is neither the current"),
        (["--check", "in.s", "-folder", "../../x"], "-folder: '../../x' is neither the current"),
    ],
)
def test_wrong_argument_is_named(tmp_path, capsys, arguments, message):
    folder = case(tmp_path)
    (folder / "nul.s").write_bytes(b"run\0 1\n")
    assert run(folder, arguments) == 2
    assert message in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["case"]
    assert not (folder / cli.TRACEBACK).exists()


def test_a_folder_above_may_be_allowed(tmp_path, capsys):
    """Scripts of repositories often have their meshes beside their own folder."""
    folder = case(tmp_path, b"print hello file ../seen\nlog ../second.log\n")
    assert run(folder, ["-in", "in.s"]) == 2
    assert "minidem -folder" in capsys.readouterr().err
    with contextlib.chdir(folder):
        assert cli.main(["--check", "in.s", "-folder", ".."]) == 0
    assert {path.name for path in tmp_path.iterdir()} == {"case"}
    assert run(folder, ["-in", "in.s", "-folder", ".."]) == 0
    assert (tmp_path / "seen").read_text() == "hello\n"
    assert {path.name for path in tmp_path.iterdir()} == {"case", "seen", "second.log"}
    assert (folder / "log.liggghts").is_file()
    (folder / "in.s").write_text("print hello file ../../seen\n")
    assert run(folder, ["-in", "in.s", "-folder", ".."]) == 2


def test_mistake_in_a_script_has_file_and_line(tmp_path, capsys):
    assert run(case(tmp_path, SCRIPT.replace("run 3", "rnu 3").encode()), ["-in", "in.s"]) == 2
    assert "minidem: in.s:25: unknown command 'rnu'" in capsys.readouterr().err


def test_fault_of_the_engine_leaves_a_traceback_file(tmp_path, capsys, monkeypatch):
    def fail(*args, **options):
        raise IndexError("list index out of range")

    monkeypatch.setattr("minidem.simulate.run_script", fail)
    folder = case(tmp_path)
    assert run(folder, ["-in", "in.s"]) == 1
    said = capsys.readouterr().err
    assert "a fault of minidem, not of your script (IndexError: list index" in said
    assert "Traceback" not in said
    text = (folder / cli.TRACEBACK).read_text()
    assert "IndexError: list index out of range" in text
    assert "Python" in text


def test_screen_may_be_a_file_of_the_case(tmp_path):
    folder = case(tmp_path)
    assert run(folder, ["-in", "in.s", "-screen", "post/screen.txt", "-log", "none"]) == 0
    assert "Loop time" in (folder / "post" / "screen.txt").read_text()
    assert not (folder / "log.liggghts").exists()


# -- anything at all -------------------------------------------------------------------------------

VALUE = st.one_of(
    st.sampled_from(
        ["", "none", "..", "../x", "/etc/passwd", "in.s", "a/b", "-1", "0", "1e9", "é"]
    ),
    st.text(st.characters(exclude_characters="\0", exclude_categories=["Cs"]), max_size=12),
)
OPTION = st.sampled_from(
    ["-in", "-log", "-screen", "-echo", "-threads", "-var", "-strict", "-h", "--", "-x"]
)
NUMBER = st.sampled_from(
    ["0", "-1", "1e308", "1e-308", "nan", "inf", "9" * 20, "2147483648", "1e18", "-0.0", "1e9"]
)
FUZZ = settings(
    max_examples=40, deadline=1000 * LONGEST_S,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)  # fmt: skip


@st.composite
def mutated(draw: st.DrawFn) -> bytes:
    """Return a script that was cut, or of which bits, words or numbers were changed."""
    lines = [line.split(" ") for line in FULL.splitlines()]
    for _ in range(draw(st.integers(1, 3))):
        words = lines[draw(st.integers(0, len(lines) - 1))]
        at = draw(st.integers(0, len(words) - 1))
        kind = draw(st.sampled_from(["number", "swap", "drop", "double", "value"]))
        if kind == "number" and words[0] not in ("run", "jump", "next", "variable"):
            words[at] = draw(NUMBER)
        elif kind == "swap":
            other = draw(st.integers(0, len(words) - 1))
            words[at], words[other] = words[other], words[at]
        elif kind == "drop":
            del words[at]
            words.append("")
        elif kind == "double":
            words.insert(at, words[at])
        elif kind == "value":
            words[at] = draw(VALUE)
    data = bytearray("\n".join(map(" ".join, lines)).encode())
    if draw(st.booleans()):
        del data[draw(st.integers(0, len(data))) :]
    if data and draw(st.booleans()):
        data[draw(st.integers(0, len(data) - 1))] ^= 1 << draw(st.integers(0, 7))
    # a run that was made long is no fault; these stay short
    return bytes(data).replace(b"run 3", b"run 2")


def test_script_that_is_mutated_runs(tmp_path):
    folder = case(tmp_path, FULL.encode())
    assert run(folder, ["-in", "in.s", "-screen", "none"]) == 0
    assert (folder / "post" / "d_2.dump").exists()


@FUZZ
@given(words=st.lists(st.tuples(OPTION, st.lists(VALUE, max_size=2)), max_size=5))
def test_any_arguments_end_well(tmp_path_factory, words):
    top = tmp_path_factory.mktemp("arguments")
    folder = case(top, b'print "hello"\n')
    assert run(folder, [word for option, values in words for word in (option, *values)]) in (0, 2)
    assert [path.name for path in top.iterdir()] == ["case"]
    assert not (folder / cli.TRACEBACK).exists()


@FUZZ
@given(script=mutated())
def test_any_script_ends_well(tmp_path_factory, script):
    top = tmp_path_factory.mktemp("script")
    folder = case(top, script)
    code = run(folder, ["-in", "in.s", "-screen", "none"])
    fault = folder / cli.TRACEBACK
    assert not fault.exists(), fault.read_text()
    assert code in (0, 2)
    assert [path.name for path in top.iterdir()] == ["case"]
    assert not list(folder.rglob("*.part"))
