"""Files are replaced as a whole, and what fails is told by the name that was asked for."""

import errno
import os
import stat
from pathlib import Path

import pytest

from liggghts_io.case.lock import raise_if_unusable
from liggghts_io.errors import CaseError, DiskFull
from liggghts_io.files import replacing, shell_word, write_text


def fail(number):
    raise OSError(number, os.strerror(number))


def test_a_full_disk_is_told_with_the_file_which_stays_as_it_was(tmp_path, monkeypatch):
    file = tmp_path / "contact.in"
    write_text(file, "old")
    monkeypatch.setattr(Path, "write_bytes", lambda *_: fail(errno.ENOSPC))
    with pytest.raises(OSError, match="No space left") as refused:
        write_text(file, "new")
    assert str(refused.value) == f"[Errno 28] No space left on device: '{file}'"
    assert [one.name for one in tmp_path.iterdir()] == ["contact.in"]
    assert file.read_text() == "old"


def test_where_nothing_can_be_written_the_temporary_name_is_not_told(tmp_path):
    file = tmp_path / "gone" / "scene.png"
    with pytest.raises(FileNotFoundError) as refused, replacing(file, ".png"):
        pytest.fail("the block began")
    assert refused.value.filename == str(file)


def test_a_rename_that_fails_names_one_file(tmp_path):
    (tmp_path / "film.gif").mkdir()
    with pytest.raises(IsADirectoryError) as refused, replacing(tmp_path / "film.gif", ".gif"):
        pass
    assert str(refused.value).endswith(f"'{tmp_path / 'film.gif'}'")


def test_another_file_that_fails_in_the_block_keeps_its_name(tmp_path):
    with pytest.raises(FileNotFoundError) as refused, replacing(tmp_path / "film.gif"):
        (tmp_path / "frame_0.dump").read_text()
    assert refused.value.filename == str(tmp_path / "frame_0.dump")
    assert not list(tmp_path.iterdir())


def test_a_new_file_has_the_rights_of_any_other_and_a_replaced_one_its_own(tmp_path):
    before = os.umask(0o027)
    try:
        write_text(tmp_path / "new", "1")
        (tmp_path / "own").touch(mode=0o600)
        write_text(tmp_path / "own", "1")
    finally:
        os.umask(before)
    rights = [stat.S_IMODE((tmp_path / name).stat().st_mode) for name in ("new", "own")]
    assert rights == [0o640, 0o600]


@pytest.mark.parametrize(
    ("number", "file", "place", "remedy"),
    [
        (errno.ENOSPC, "elsewhere/scene.png", "elsewhere/scene.png", "free some space"),
        (errno.ENOSPC, "case/scene.png", "case", "free some space"),
        (errno.ENOSPC, None, "case", "free some space"),
        (errno.EFBIG, "elsewhere/scene.png", "elsewhere/scene.png", "raise the limit (ulimit -f)"),
        (errno.EROFS, "elsewhere/scene.png", "elsewhere/scene.png", "choose another directory"),
    ],
)
def test_a_picture_outside_its_case_is_told_by_its_own_name(number, file, place, remedy):
    error = OSError(number, os.strerror(number), file)
    with pytest.raises(CaseError) as refused:
        raise_if_unusable(error, Path("case"))
    assert str(refused.value).startswith(f"{place}: ")
    assert remedy in str(refused.value)
    assert isinstance(refused.value, DiskFull) is (number != errno.EROFS)


@pytest.mark.parametrize(
    ("path", "typed"),
    [("-heap", "./-heap"), (Path("--out"), "./--out"), ("- a", '"./- a"'), ("a-b", "a-b")],
)
def test_a_command_that_is_offered_takes_no_path_for_an_option(path, typed):
    assert shell_word(path) == typed
