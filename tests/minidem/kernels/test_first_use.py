"""A script runs at once: on the loop of all models, until that of its own is there."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from minidem import run_script, ship
from minidem.kernels.machine import cache, native
from minidem.kernels.machine.cache import FREE, MADE_FOR, SHIPPED, shipped_folder
from minidem.kernels.machine.library import LIBRARY
from minidem.kernels.machine.native import Native
from minidem.kernels.step.phases import Model
from minidem.run import code as module
from minidem.run.code import Code, LoopCode, code_of
from minidem.ship import SCRIPT, SURFACE
from tests.minidem.loops import general_loops, own_loops
from tests.paths import ROOT

HERTZ = Model((0, 1, 0, 0, 0, 0, 0, 0, 0), periodic=False)
machine_code = pytest.mark.skipif(not FREE, reason="kernels are not machine code in this process")


class Loop(LoopCode):
    """A loop of which a test says whether it is there."""

    ready = False
    provided = 0

    def is_ready(self, tables):
        """Whether the test says so."""
        return self.ready

    def provide(self, tables):
        """Count how often it was to be compiled."""
        object.__setattr__(self, "provided", self.provided + 1)


@pytest.fixture
def code(monkeypatch):
    """Return the loops of a model, neither of which is compiled, and count compilers."""
    started = []

    def compiling(*words):
        started.append(SimpleNamespace(done=None, poll=lambda: started[-1].done))
        return started[-1]

    monkeypatch.setattr(module, "_compiling", compiling)
    found = Code(HERTZ, False, Loop(None, None), Loop(None, None))
    found.started = started
    return found


def test_a_short_run_is_that_of_the_general_loop(code):
    assert code.pick(None) is code.general
    code.worked(0.5 * code.patience, None)
    assert code.pick(None) is code.general
    assert not code.started


def test_a_loop_that_is_there_is_taken_at_once(code):
    object.__setattr__(code.own, "ready", True)
    assert code.pick(None) is code.own


def test_a_loop_is_provided_before_its_work_is_timed(code):
    for _ in range(3):
        code.pick(None)
    assert (code.general.provided, code.own.provided) == (1, 0)


def test_in_a_long_run_the_loop_of_the_model_takes_over_when_it_is_made(code):
    for _ in range(4):
        assert code.pick(None) is code.general
        code.worked(code.patience, None)
    assert len(code.started) == 1
    object.__setattr__(code.own, "ready", True)
    assert code.pick(None) is code.general  # the file may not be whole yet
    code.started[0].done = 0
    assert code.pick(None) is code.own


def test_a_loop_that_cannot_be_compiled_is_not_asked_for_again(code):
    for _ in range(2):
        code.pick(None)
        code.worked(code.patience, None)
    code.started[0].done = 1
    for _ in range(3):
        assert code.pick(None) is code.general
        code.worked(code.patience, None)
    assert len(code.started) == 1


@pytest.mark.parametrize(
    ("word", "started"), [("", 1), ("never", 0), ("first", 0), ("something else", 1)]
)
def test_who_asks_for_it_has_no_other_process_compile(word, started, code, monkeypatch):
    monkeypatch.setenv("MINIDEM_COMPILE", word)
    monkeypatch.setattr(module, "_loop", lambda model, several: Loop(None, None))
    asked = code_of.__wrapped__(HERTZ, several=False)
    asked.pick(None)
    asked.worked(1e9, None)
    assert len(code.started) == started
    assert (asked.own.provided, asked.general.provided) == ((1, 0) if word == "first" else (0, 1))


@machine_code
def test_another_process_compiles_what_a_long_run_asks_for(monkeypatch):
    """The compiler's arguments arrive: what it makes is what this process then finds."""
    asked = []
    monkeypatch.setattr("subprocess.Popen", lambda words, **_: asked.append(words))
    seen = []
    monkeypatch.setattr(Native, "make", lambda self, codes: seen.append((self, codes)))
    tables = (1.0,)
    module._compiling(HERTZ, False, tables)
    monkeypatch.setattr(sys, "argv", asked[0])
    monkeypatch.setattr(module.os, "nice", lambda by: None)
    module.compile_asked()
    own = code_of(HERTZ, several=False).own.advance
    assert seen == [(own, own.codes(tables))]


@machine_code
@pytest.mark.parametrize("threads", [1, pytest.param(2, marks=pytest.mark.long)])
def test_both_loops_give_the_same_bits(threads, tmp_path):
    dumps = []
    for loops in (general_loops, own_loops):
        folder = tmp_path / loops.__name__
        folder.mkdir()
        (folder / "plate.stl").write_text(SURFACE)
        (folder / "in.script").write_text(SCRIPT.replace("run 100", "run 3000"))
        with loops():
            run_script(folder / "in.script", root=folder, threads=threads)
        dumps.append({file.name: file.read_bytes() for file in folder.glob("dump.*")})
    assert dumps[0] == dumps[1]
    assert len(dumps[0]) == 61


@machine_code
def test_what_is_shipped_serves_a_new_machine(tmp_path):
    if shipped_folder() is None:
        pytest.skip("no machine code of these sources came with the package")
    (tmp_path / "plate.stl").write_text(SURFACE)
    (tmp_path / "in.script").write_text(SCRIPT)
    env = {**os.environ, "PYTHONPATH": str(ROOT), "XDG_CACHE_HOME": str(tmp_path)}
    for threads in ("1", "2"):
        done = subprocess.run(
            [sys.executable, "-X", "importtime", "-m", "minidem", "-in", "in.script",
             "-threads", threads],
            cwd=tmp_path, env=env, check=True, capture_output=True, text=True,
        )  # fmt: skip
        linked = any(SHIPPED.glob(f"*{LIBRARY}"))  # the installing machine had a linker
        assert ("llvmlite" in done.stderr) != linked
    assert not list(Path(tmp_path).glob("bulkcal/*/*.bin"))


@machine_code
def test_who_names_another_processor_gets_code_for_it(monkeypatch):
    monkeypatch.setenv("NUMBA_CPU_NAME", "x86-64")
    assert shipped_folder.__wrapped__() is None


@machine_code
def test_what_is_there_is_not_compiled_again(tmp_path, monkeypatch):
    started = []

    def no_process(*words, **_):
        started.append(words)
        raise OSError(words)

    monkeypatch.setattr(ship.subprocess, "Popen", no_process)
    with pytest.raises(OSError, match="minidem"):
        ship.ship(tmp_path)
    assert len(started) == 1
    (tmp_path / MADE_FOR).write_text(ship.note())
    ship.ship(tmp_path)
    assert len(started) == 1


def test_a_folder_with_other_things_is_left_alone(tmp_path):
    (tmp_path / "thesis.tex").write_text("years of work")
    with pytest.raises(FileExistsError, match=r"thesis\.tex.*name another folder"):
        ship.ship(tmp_path)
    assert (tmp_path / "thesis.tex").read_text() == "years of work"


@machine_code
def test_shipped_code_that_is_damaged_is_compiled_anew_elsewhere(tmp_path, monkeypatch):
    shipped, own = tmp_path / "shipped", tmp_path / "own"
    built = []

    def build(function, codes, path):
        built.append(path)

    kernel = Native(lambda x: None, build)
    name = kernel._file(kernel.codes(1.0))
    for folder in (shipped, own):
        folder.mkdir()
    (shipped / name).write_bytes(b"{} half a file")
    monkeypatch.setattr(native, "shipped_folder", lambda: shipped)
    monkeypatch.setattr(native, "cache_folder", lambda: own)
    assert not kernel.is_ready(1.0)
    with pytest.raises(OSError, match="is the disk full"):
        kernel.make(kernel.codes(1.0))  # this build writes nothing
    assert built == [own / name]
    assert (shipped / name).read_bytes() == b"{} half a file"


@pytest.mark.parametrize(
    ("change", "suits"),
    [
        ({}, True),
        ({"sources": "others"}, False),
        ({"system": "another"}, False),
        ({"features": ["a feature that no processor has"]}, False),
        ({"features": 3}, False),
    ],
)
def test_code_for_another_machine_or_other_sources_is_left_alone(
    change, suits, tmp_path, monkeypatch
):
    facts = {"sources": cache.sources(), "system": cache.system(), "features": []} | change
    (tmp_path / MADE_FOR).write_text(json.dumps(facts))
    monkeypatch.setattr(cache, "SHIPPED", tmp_path)
    assert shipped_folder.__wrapped__() == (tmp_path if suits else None)
