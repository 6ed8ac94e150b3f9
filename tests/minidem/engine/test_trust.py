"""Full disks, damaged files, too little memory: said by name, and nothing half is left."""

from __future__ import annotations

import errno
import io
import os
from pathlib import Path

import pytest

from minidem import DemError, OutputError, ResourceError, ScriptError, memory, run_script
from minidem.files import append_text, whole_file
from tests.minidem.script.test_acceptance import POUR, SCRIPT, after

POURED = after(POUR.format(seed=32452843, target="particles_in_region {}"))
WRITER = after("dump d all custom 1 post/d_*.dump id x\nrestart 2 r.*")


def put(folder: Path, script: str) -> Path:
    (folder / "in.s").write_text(script)
    return folder / "in.s"


def no_room(*args, **kwargs):
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


@pytest.fixture
def full_disk(monkeypatch):
    """Make every write of a whole or appended file fail, as a full disk does."""

    class FullRaw(io.FileIO):
        def write(self, data):
            super().write(bytes(data)[:3])
            no_room()

    usual = Path.open

    def open_full(path, mode="r", buffering=-1, **options):
        if "b" in mode and "r" not in mode:
            raw = FullRaw(path, mode.replace("b", ""))
            return raw if buffering == 0 else io.BufferedRandom(raw)
        return usual(path, mode, buffering, **options)

    monkeypatch.setattr(Path, "open", open_full)


@pytest.mark.parametrize(
    ("line", "name"),
    [
        ("dump d all custom 1 post/d_*.dump id x", "d_0.dump"),
        ("dump d all custom 1 all.dump id x", "all.dump"),
        ("restart 2 r.*", "r.2"),
        ("fix p all print 1 hello file p.txt", "p.txt"),
        ("print hello file p.txt", "p.txt"),
        ("write_restart r", "r"),
    ],
)
def test_full_disk_is_named_and_leaves_nothing_half(tmp_path, full_disk, line, name):
    with pytest.raises(OutputError, match=f"cannot write '{name}': No space left") as caught:
        run_script(put(tmp_path, after(line)), root=tmp_path)
    assert isinstance(caught.value.__cause__, OSError)
    assert caught.value.__cause__.errno == errno.ENOSPC
    left = [path for path in tmp_path.rglob("*") if path.is_file() and path.name != "in.s"]
    assert all(path.name == "log.liggghts" or path.stat().st_size == 0 for path in left), left
    assert not list(tmp_path.rglob("*.part"))


def test_full_disk_for_the_screen_is_no_fault_of_the_engine(tmp_path):
    class Screen(io.StringIO):
        def write(self, text):
            no_room()

    with pytest.raises(OutputError, match="cannot write 'screen': No space left"):
        run_script(put(tmp_path, SCRIPT), root=tmp_path, screen=Screen(), log=None)


def test_appended_text_stands_behind_what_was_there(tmp_path):
    target = tmp_path / "a.txt"
    append_text(target, "one\n", anew=True)
    append_text(target, "two\n")
    assert target.read_text() == "one\ntwo\n"


def test_interrupted_write_leaves_the_file_that_was_there(tmp_path):
    target = tmp_path / "a"
    target.write_text("before")

    def interrupted():
        with whole_file(target) as file:
            file.write(b"half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert [path.name for path in tmp_path.iterdir()] == ["a"]
    assert target.read_text() == "before"


# -- restart files ---------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def restart_file(tmp_path_factory) -> bytes:
    folder = tmp_path_factory.mktemp("restart")
    run_script(put(folder, after("run 1\nwrite_restart r")), root=folder)
    return (folder / "r").read_bytes()


def read(folder: Path, data: bytes) -> None:
    (folder / "r").write_bytes(data)
    skipped = ("boundary", "region", "create_", "set ", "run")
    lines = [line for line in SCRIPT.splitlines() if not line.startswith(skipped)]
    at = lines.index("units si") + 1
    script = "\n".join([*lines[:at], "read_restart r", *lines[at:], "run 1", ""])
    run_script(put(folder, script), root=folder)


def test_intact_restart_file_is_read(tmp_path, restart_file):
    read(tmp_path, restart_file)


def test_cut_restart_files_are_refused(tmp_path, restart_file, rng):
    for size in {0, 10, 17, 30, 49, 50, *rng.integers(50, len(restart_file), 10).tolist()}:
        with pytest.raises(ScriptError, match=r"in\.s:\d+: .*(is damaged|is no|another version)"):
            read(tmp_path, restart_file[:size])


def test_restart_files_with_one_bit_changed_are_refused(tmp_path, restart_file, rng):
    for at in rng.integers(0, len(restart_file), 25).tolist():
        data = bytearray(restart_file)
        data[at] ^= 1 << int(rng.integers(8))
        with pytest.raises(ScriptError, match=r"is damaged|is no restart file|another version"):
            read(tmp_path, bytes(data))


@pytest.mark.parametrize("head", [b"PK\x03\x04", b"minidem restart 3\n"])
def test_restart_files_of_other_versions_are_named(tmp_path, restart_file, head):
    with pytest.raises(ScriptError, match="of another version of minidem; write it again"):
        read(tmp_path, head + restart_file[len(head) :])


# -- memory and steps ------------------------------------------------------------------------------


def test_more_grains_than_the_memory_holds_are_refused_before_the_first_step(tmp_path, monkeypatch):
    monkeypatch.setattr(memory, "available_bytes", lambda: 2 * 1024**3)
    with pytest.raises(ResourceError, match=r"fix ins: 1\d+ more .* need about .* 2 GiB are free"):
        run_script(put(tmp_path, POURED.format(100_000_000)), root=tmp_path)


def test_hundred_million_grains_are_not_even_drawn(tmp_path):
    """Drawing their sizes alone takes gigabytes."""
    free = memory.available_bytes()
    if free is None or free > 100_000_000 * memory.BYTES_PER_PARTICLE:
        pytest.skip("this machine might hold them")
    with pytest.raises(ResourceError, match="100000000 more particles need about 119 GiB"):
        run_script(put(tmp_path, POURED.format(100_000_000)), root=tmp_path)


def test_failed_allocation_has_numbers(tmp_path, monkeypatch):
    def allocate(self, wanted):
        raise MemoryError

    monkeypatch.setattr("minidem.world.state.State.reserve", allocate)
    with pytest.raises(ResourceError, match=r"step 0: .* not enough memory; 0 particles"):
        run_script(put(tmp_path, SCRIPT), root=tmp_path)


def test_available_memory_is_that_of_the_system():
    free = memory.available_bytes()
    if Path("/proc/meminfo").exists():
        assert free is not None
    assert free is None or 1024**2 < free < 1024**5


def test_many_types_are_refused_without_a_large_table(tmp_path):
    """A table of pairs of a hundred million types would take 10^17 bytes."""
    text = SCRIPT.replace("create_box 1 reg", "create_box 100000000 reg")
    with pytest.raises(DemError, match="atom types"):
        run_script(put(tmp_path, text), root=tmp_path)


# -- formulas and values that the engine does not have ---------------------------------------------


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("compute c all com\nthermo_style custom step c_c", "compute c has no such value"),
        ("compute c all com\nthermo_style custom step c_c[4]", "compute c has no such value"),
        ("compute c all reduce sum x\nthermo_style custom step c_c[2]", "compute c has no such"),
        ("thermo_style custom step c_thermo_temp[x]", "expected a whole number, found 'x'"),
        ("thermo_style custom step c_thermo_temp[1", "expected NAME or NAME[1]"),
        ("compute c all property/atom x\ndump d all custom 1 a c_c[2]", "no value per particle"),
        ("print $(xcm(all))", "expected xcm(GROUP,x), y, z"),
        ("print $(bound(all,q))", "expected bound(GROUP,xmin)"),
        ("print $(c_nix)", "'c_nix' is not known in a formula"),
        ("print $(logfreq(1e400,2,3))", "must be a finite number"),
        ("group g id 1:5:0", "K above zero"),
        ("group g id 1:2:3:4", "expected N, N:M or N:M:K"),
        ("thermo_modify format ² %g", "thermo_modify format needs"),
        ("neigh_modify once yes", "not supported"),
    ],
)
def test_what_is_not_there_is_a_mistake_with_a_place(tmp_path, line, message):
    with pytest.raises(ScriptError) as caught:
        run_script(put(tmp_path, after(line)), root=tmp_path)
    assert message in str(caught.value)
    assert caught.value.line >= 25
