"""The good study of the tests, and what is told when words in it are replaced."""

from __future__ import annotations

import shutil
import time
from pathlib import Path

import pytest

from calibrate.errors import StudyError
from calibrate.study.data import load_data
from calibrate.study.resources import bundled_study

GOOD = (Path(__file__).parents[1] / "studies" / "good.toml").read_text(encoding="utf-8")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder with the good study and its data."""
    for csv in bundled_study().parent.glob("*.csv"):
        shutil.copy(csv, tmp_path)
        (tmp_path / csv.name).chmod(0o644)
    (tmp_path / "study.toml").write_text(GOOD, encoding="utf-8")
    return tmp_path


@pytest.fixture
def told(folder: Path):
    """Write the good study with words replaced and lines added; return what is wrong with it."""

    def tell(*changes: tuple[str, str], more: str = "") -> list[str]:
        text = GOOD
        for old, new in changes:
            assert old in text
            text = text.replace(old, new, 1)
        path = folder / "study.toml"
        path.write_text(text + more, encoding="utf-8")
        started = time.process_time()  # other tests share the machine
        with pytest.raises(StudyError) as caught:
            load_data(path)
        assert time.process_time() - started < 2.0
        return [one.removeprefix(str(path)) for one in caught.value.mistakes]

    return tell
