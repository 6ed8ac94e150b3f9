"""Dumps of numbers, ``.bin``: read as the text that they would be, cut ones, and without names."""

from __future__ import annotations

import gzip
from pathlib import Path

import numpy as np
import pytest

from liggghts_io.errors import CaseError
from liggghts_io.foreign import read_output
from liggghts_io.measure.text_dump import blocks
from minidem.output.text.binary import binary_frame
from tests.liggghts_io.foreign.grains import frame_text, known

NAMES = ("id", "x", "y", "z", "radius")
BOX = np.array([[-0.1, -0.1, -0.2], [0.1, 0.1, 0.2]])
COMMAND = "run 5\ndump a all custom 100 post/{} id x y &\n z radius\n"


def content(*steps: int) -> bytes:
    """Return frames as minidem and LIGGGHTS 3.8.0 write them, the same byte for byte."""
    return b"".join(
        binary_frame(step, BOX, ("ff", "pp", "fm"), [known(4, step)[name] for name in NAMES])
        for step in steps
    )


@pytest.mark.parametrize("packed", [False, True], ids=["plain", "gzip"])
def test_numbers_are_those_of_the_text(tmp_path: Path, packed: bool):
    (tmp_path / "log.liggghts").write_text(COMMAND.format("a.bin"))
    data = content(0, 100)
    (tmp_path / "post").mkdir()
    (tmp_path / "post" / "a.bin").write_bytes(gzip.compress(data) if packed else data)
    (tmp_path / "text.dump").write_text(
        "".join(frame_text(k, known(4, k), NAMES) for k in (0, 100))
    )
    mine = list(read_output(tmp_path / "post").frames())
    theirs = list(read_output(tmp_path / "text.dump").frames())
    assert [frame.step for frame in mine] == [0, 100]
    for one, other in zip(mine, theirs, strict=True):
        assert one.grains.equals(other.grains)


def test_a_frame_that_is_cut_is_left_out(tmp_path: Path):
    (tmp_path / "in.run").write_text(COMMAND.format("a*.bin"))
    whole = content(0, 100)
    for end in range(len(whole) // 2 + 1, len(whole), 13):
        (tmp_path / "a7.bin").write_bytes(whole[:end])
        output = read_output(tmp_path)
        assert [frame.step for frame in output.frames()] == [0]
        assert "this frame is left out" in output.notes[0]


@pytest.mark.parametrize(
    "command", ["", COMMAND.format("b.bin"), COMMAND.format("a.bin").replace("z", "z vx")]
)
def test_names_that_nobody_tells_are_asked_for(tmp_path: Path, command: str):
    (tmp_path / "log.liggghts").write_text(command)
    (tmp_path / "a.bin").write_bytes(content(0))
    with pytest.raises(CaseError, match=r"a.bin: a dump of numbers \(5 columns\) does not hold"):
        list(read_output(tmp_path).frames())


def test_two_commands_that_name_the_file_are_none(tmp_path: Path):
    text = COMMAND.format("a.bin")
    (tmp_path / "log.liggghts").write_text(text + text.replace("x y", "y x"))
    (tmp_path / "a.bin").write_bytes(content(0))
    with pytest.raises(CaseError, match="or several do"):
        list(read_output(tmp_path).frames())


def test_a_count_that_lies_is_told(tmp_path: Path):
    (tmp_path / "log.liggghts").write_text(COMMAND.format("a.bin"))
    lying = bytearray(content(0))
    lying[100:104] = (2**31 - 1).to_bytes(4, "little")
    (tmp_path / "a.bin").write_bytes(lying)
    with pytest.raises(CaseError, match="a part of 2147483647 numbers in 5 columns"):
        list(read_output(tmp_path).frames())


def test_a_small_compressed_file_takes_no_memory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(blocks, "_MOST_BYTES", 1 << 24)
    text = frame_text(0, known(4)).encode()
    (tmp_path / "a.dump").write_bytes(gzip.compress(text + b"0 " * (1 << 24)))
    with pytest.raises(CaseError, match=r"a.dump: a frame of more than .* write fewer columns"):
        list(read_output(tmp_path).frames())


def test_many_parts_of_a_compressed_file_take_no_memory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    """Each part is as large as a frame may be; together they are not."""
    monkeypatch.setattr(blocks, "_MOST_BYTES", 1 << 20)
    (tmp_path / "log.liggghts").write_text(COMMAND.format("a.bin"))
    head = bytearray(content(0)[:100])
    head[8:16] = (10**9).to_bytes(8, "little")
    head[96:100] = (1000).to_bytes(4, "little")
    part = (40_000).to_bytes(4, "little") + bytes(8 * 40_000)
    (tmp_path / "a.bin").write_bytes(gzip.compress(bytes(head) + 3 * part))
    with pytest.raises(CaseError, match=r"a.bin: a frame of more than .* write fewer columns"):
        list(read_output(tmp_path).frames())


def test_a_log_that_ends_within_a_command_is_no_fault(tmp_path: Path):
    (tmp_path / "in.run").write_text(COMMAND.format("a.bin") + "run & # more\n &")
    (tmp_path / "log.liggghts").write_text(" # nothing &")
    (tmp_path / "a.bin").write_bytes(content(0))
    assert [frame.step for frame in read_output(tmp_path).frames()] == [0]
