"""Whatever stands in a study, it is read or refused by name, soon, and nothing else is read."""

from __future__ import annotations

import copy
import io
import math
import shutil
import tempfile
import time
import tomllib
from contextlib import redirect_stderr, redirect_stdout, suppress
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from calibrate.cli import main as cli
from calibrate.errors import CalibrationError
from calibrate.study.data import load_data
from calibrate.study.resources import bundled_study

PATIENCE = 2.0
"""Longest silence [s], in time of the processor: other tests share it."""

WILD = st.one_of(
    st.sampled_from([
        "", " ", "0", "nan", "inf", "\n", "a" * 5000, "../secret.csv", "/etc/passwd", ".", "..",
        "conveyor.csv", "ä ö \u202e 漢字", "'", '"', "\\", "[stage]", "heap", "angle_deg", "\t",
        0, 1, -1, -3, 7, 8, 2**31, 2**63 - 1, -(2**63), 10**300,
        0.0, -0.0, 1e-300, 1e300, math.inf, -math.inf, math.nan, 0.5, 1000.0, -1e-9, True, False,
    ]),
    st.text(max_size=30),
    st.floats(),
    st.integers(),
    st.just([]),
    st.just({}),
    st.lists(st.one_of(st.floats(), st.text(max_size=5), st.integers()), max_size=4),
    st.dictionaries(st.text(max_size=8), st.floats(), max_size=3),
)  # fmt: skip


def toml(value: object) -> str:
    """Write any value as inline TOML."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"')
        plain = "".join(c if c >= " " and c != "\x7f" else f"\\u{ord(c):04x}" for c in escaped)
        return f'"{plain}"'
    if isinstance(value, float) and not math.isfinite(value):
        return repr(value)
    if isinstance(value, list):
        return "[" + ", ".join(toml(one) for one in value) + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{toml(k)} = {toml(v)}" for k, v in value.items()) + "}"
    return repr(value)


def document(data: dict[str, Any]) -> str:
    """Write a study with a key per line, as a person would."""
    return "".join(f"{toml(key)} = {toml(value)}\n" for key, value in data.items())


def places(value: object, path: tuple[str | int, ...] = ()) -> list[tuple[str | int, ...]]:
    """Return the way to everything in a study."""
    found = [path] if path else []
    if isinstance(value, dict):
        for key, one in value.items():
            found += places(one, (*path, key))
    elif isinstance(value, list):
        for number, one in enumerate(value):
            found += places(one, (*path, number))
    return found


def base() -> dict[str, Any]:
    """Return the bundled study with every other table and key that there is."""
    data = tomllib.loads(bundled_study().read_text(encoding="utf-8"))
    data["run"] |= {"workers": 2, "executor": "local", "time_limit_s": 60.0}
    data["design"] |= {"runs": 100, "start": 0, "tolerance": 0.1, "check_draws": 5}
    data["experiment"] = [
        {"name": "heap", "apparatus": {"frames": 40.0}},
        {"name": "conveyor", "apparatus": {"pour_depth_d": 5.0}},
    ]
    data["effects"] = {"cohesion_J_m3": 10.0}
    data["known"] = {
        "plate_period": {"value": 0.0, "se": 0.01},
        "mu_pw": [{"value": 0.3, "se": 0.02, "material": "Carbo HSP13", "surface": "steel"}],
    }
    data["surface"].append({"name": "brass", "kind": "flat"})
    data["target"] += [
        {"name": "curve", "experiment": "conveyor", "surface": "steel", "observable": "mass_time",
         "file": "curve.csv", "x_column": "time_s", "column": "mass_g", "se_column": "sem_g",
         "levels": [20.0, 60.0]},
        {"name": "given", "material": "Carbo HSP13", "experiment": "heap", "surface": "brass",
         "observable": "angle_deg", "unit": "deg", "value": 30.0, "se": 0.5, "repeats": 5},
    ]  # fmt: skip
    data["shared"] = [{"name": "ruler", "targets": ["angle_steel", "given"], "se": 0.2}]
    data["parameter"]["mu_pw"] |= {"tie": "surface", "prior": {"normal": [0.4, 0.2]}}
    data["parameter"]["e_pw"] |= {"published": {"Carbo HSP13/steel": 0.4}, "scope": "surface"}
    data["parameter"]["conveyor.period_s"] = {"range": [0.07, 0.09], "value": 0.08}
    return data


BASE = base()
PLACES = places(BASE)


@pytest.fixture(scope="module")
def folder():
    """Return a folder with the data, in a folder with a secret beside it."""
    with tempfile.TemporaryDirectory() as name:
        inside = Path(name) / "study"
        inside.mkdir()
        for csv in bundled_study().parent.glob("*.csv"):
            shutil.copy(csv, inside)
        (inside / "curve.csv").write_text("time_s,mass_g,sem_g\n1,0,1\n5,50,1\n10,100,1\n")
        (Path(name) / "secret.csv").write_text("particle,surface,secret\n")
        yield inside


def change(data: dict[str, Any], path: tuple[str | int, ...], value: object, how: str) -> None:
    """Replace, remove, rename or double what stands at a place."""
    owner: Any = data
    for step in path[:-1]:
        owner = owner[step]
    last = path[-1]
    if how == "remove":
        del owner[last]
    elif how == "rename" and isinstance(owner, dict) and isinstance(value, str):
        owner[value] = owner.pop(last)
    elif how == "double" and isinstance(owner, list):
        owner.append(copy.deepcopy(owner[last]))
    else:
        owner[last] = value


def read(folder: Path, text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Load a study; it ends well or in our error, soon, and opens nothing outside its folder."""
    path = folder / "study.toml"
    path.write_text(text, encoding="utf-8")
    opened: list[Path] = []
    honest = Path.open

    def watch(self: Path, *rest: Any, **more: Any) -> Any:
        opened.append(self.resolve())
        return honest(self, *rest, **more)

    started = time.process_time()
    with monkeypatch.context() as patch, suppress(CalibrationError):
        patch.setattr(Path, "open", watch)
        load_data(path)
    assert time.process_time() - started < PATIENCE
    # Templates are the program's own; of the user's files only those beside the study count.
    assert all(one.is_relative_to(folder.resolve()) for one in opened if one.suffix != ".j2")


@given(data=st.data())
@settings(max_examples=120, deadline=None, suppress_health_check=list(HealthCheck))
def test_a_changed_study_is_read_or_refused(folder: Path, monkeypatch, data):
    study = copy.deepcopy(BASE)
    for _ in range(data.draw(st.integers(1, 3))):
        place = data.draw(st.sampled_from(PLACES))
        how = data.draw(st.sampled_from(["set", "set", "set", "remove", "rename", "double"]))
        with suppress(KeyError, IndexError, TypeError):  # an earlier change took the place away
            change(study, place, data.draw(WILD), how)
    read(folder, document(study), monkeypatch)


KEYS = [place for place in PLACES if all(step in (0, str(step)) for step in place)]
"""Every key once: of lists the first item only."""


@pytest.mark.parametrize("place", KEYS, ids=str)
def test_every_key_takes_or_refuses_every_kind_of_value(folder, monkeypatch, place):
    for value in ("", "漢", -3, 10**300, 1e300, math.nan, True, [], {}):
        study = copy.deepcopy(BASE)
        change(study, place, value, "set")
        read(folder, document(study), monkeypatch)


@given(raw=st.binary(max_size=300))
@settings(max_examples=80, deadline=None, suppress_health_check=list(HealthCheck))
def test_any_bytes_are_a_study_or_refused(folder: Path, raw: bytes):
    path = folder / "bytes.toml"
    path.write_bytes(raw)
    with suppress(CalibrationError):
        load_data(path)


@given(raw=st.one_of(st.binary(max_size=300), st.text(max_size=200).map(str.encode)))
@settings(max_examples=80, deadline=None, suppress_health_check=list(HealthCheck))
def test_any_bytes_are_a_table_or_refused(folder: Path, raw: bytes):
    """The two tables of the study, one read as targets and one as a curve."""
    (folder / "study.toml").write_text(document(BASE), encoding="utf-8")
    kept = {name: (folder / name).read_bytes() for name in ("conveyor.csv", "curve.csv")}
    head = b"particle,surface,t100_s,sem_s,repeats\n"
    try:
        for name in kept:
            (folder / name).chmod(0o644)
            for text in (raw, head + raw):
                (folder / name).write_bytes(text)
                with suppress(CalibrationError):
                    load_data(folder / "study.toml")
    finally:
        for name, old in kept.items():
            (folder / name).write_bytes(old)


@given(data=st.data())
@settings(max_examples=25, deadline=None, suppress_health_check=list(HealthCheck))
def test_check_ends_with_code_2_and_lists_what_is_wrong(folder: Path, data):
    study = copy.deepcopy(BASE)
    place = data.draw(st.sampled_from(PLACES))
    change(study, place, data.draw(WILD), "set")
    study["name"] = -3  # so that it is wrong in any case, and no probe is run
    path = folder / "checked.toml"
    path.write_text(document(study), encoding="utf-8")
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err), pytest.raises(SystemExit) as ended:
        cli.main(["check", str(path)])
    assert ended.value.code == 2
    assert "Traceback" not in err.getvalue()
    assert str(path) in err.getvalue().replace("\n", "")
