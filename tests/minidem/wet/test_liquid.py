"""Liquid bridges: what they refuse, what grains keep of their liquid, and what outputs show.

Trajectories are compared with those of LIGGGHTS in ``tests/minidem/engine/test_cases.py``.
"""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from minidem import ScriptError, run_script
from tests.minidem.engine import cases
from tests.minidem.engine.cases import Case
from tests.minidem.wet.wet_list import EASO, HERTZ, LIQUID, WASHINO, WET_CASES, met, poured

SHORT = {name: replace(WET_CASES[name], runs="run 0") for name in WET_CASES}
OF_BRIDGES = {
    "minSeparationDistanceRatio", "maxSeparationDistanceRatio", "surfaceLiquidContentInitial",
    "surfaceTension", "fluidViscosity", "contactAngle",
}  # fmt: skip
TAKEN = {
    "easo, slow": OF_BRIDGES,
    "washino, slow": OF_BRIDGES,
    "washino, limits": {*OF_BRIDGES, "maxLiquidContent", "lbVolumeFraction"},
    "thornton_ning": {"coefficientYieldRatio"},
}
"""Values that LIGGGHTS 3.8.0 asks for, of those of `LIQUID`."""


def refusal(folder: Path, case: Case, text: str) -> str:
    """Return why a script is refused."""
    case.write(folder)
    (folder / "in.script").write_text(text)
    with pytest.raises(ScriptError) as caught:
        run_script(folder / "in.script", root=folder)
    return str(caught.value).replace(f"{folder}/", "")


# -- values and words ------------------------------------------------------------------------------


@pytest.mark.parametrize("name", TAKEN)
def test_a_missing_value_is_named_with_the_line_to_add(tmp_path, name):
    text = SHORT[name].script()
    for value in LIQUID:
        without = re.sub(rf"fix \S+ all property/global {value} .*\n", "", text)
        if value not in TAKEN[name]:
            text = without
            continue
        found = refusal(tmp_path, SHORT[name], without)
        line = without[: without.index("\nrun 0")].count("\n") + 2
        form = "peratomtype VALUE VALUE" if "per" in LIQUID[value] else "scalar VALUE"
        assert found.startswith(f"in.script:{line}: Could not locate a fix/property storing")
        assert found.endswith(f"Add 'fix ID all property/global {value} {form}'")
    (tmp_path / "in.script").write_text(text)
    run_script(tmp_path / "in.script", root=tmp_path)


@pytest.mark.parametrize(
    ("name", "value", "words", "why"),
    [
        (
            "easo, slow",
            "contactAngle",
            "peratomtype 20 200",
            "contactAngle is 200; it must be from",
        ),
        (
            "easo, slow",
            "maxSeparationDistanceRatio",
            "scalar 0.9",
            "requires maxSeparationDistance",
        ),
        ("washino, slow", "minSeparationDistanceRatio", "scalar 0", "it must be above zero"),
        ("washino, limits", "maxLiquidContent", "peratomtype 0 2", "is 2; it must be from 0 to 1"),
        ("washino, limits", "lbVolumeFraction", "scalar -1", "is -1; it must be from 0 to 1"),
        ("thornton_ning", "coefficientYieldRatio", "peratomtype 0.1 2", "must be from 0 to 1"),
    ],
)
def test_values_out_of_their_limits_are_refused(tmp_path, name, value, words, why):
    text = re.sub(rf"(property/global {value}) .*", rf"\1 {words}", SHORT[name].script())
    assert why in refusal(tmp_path, SHORT[name], text)


def test_bridges_of_easo_to_walls_are_refused(tmp_path):
    case = SHORT["easo, slow"]
    text = re.sub(r"(wall/gran model hertz tangential history)", rf"\1 {EASO}", case.script())
    assert "'cohesion easo/capillary/viscous' is for pairs only" in refusal(tmp_path, case, text)


def test_models_must_agree_on_how_far_bridges_reach(tmp_path):
    case = SHORT["washino, limits"]
    text = re.sub(r"(zplane \S+) .*", r"\1", case.script())
    assert "'limitLiquidContent on' sets how far bridges reach" in refusal(tmp_path, case, text)


# -- the liquid ------------------------------------------------------------------------------------


def table(path: Path) -> dict[int, np.ndarray]:
    """Return the rows of a dump by step."""
    lines = path.read_text().splitlines()
    found, at = {}, 0
    while at < len(lines):
        count = int(lines[at + 3])
        rows = [[float(word) for word in row.split()] for row in lines[at + 9 : at + 9 + count]]
        found[int(lines[at + 1])] = np.array(rows)
        at += 9 + count
    return found


WATCH = (
    "run 0\ndump l all custom 20 l.dump id f_surfaceLiquidContent[0] f_liquidFlux[0] "
    "f_liquidtransfer radius\n"
    'dump_modify l sort id format "%d %.17g %.17g %.17g %.17g"\n'
)


@pytest.mark.parametrize("words", [EASO, WASHINO])
def test_liquid_moves_when_bridges_break_and_none_is_lost(tmp_path, words):
    runs = f"run 0\nset atom 2 property/atom surfaceLiquidContent 0.03\n{WATCH}run 3000"
    run_script(met(f"{HERTZ} {words}", runs=runs).write(tmp_path), root=tmp_path)
    frames = table(tmp_path / "l.dump")
    content = np.array([rows[:, 1] for rows in frames.values()])
    volume = next(iter(frames.values()))[:, 4] ** 3
    np.testing.assert_allclose(content @ volume, content[0] @ volume, rtol=1e-12)
    assert content[0, 1] == 0.03
    assert content[-1, 1] < 0.0299
    assert (np.diff(content, axis=0) != 0.0).any(axis=1).sum() <= 4  # at ruptures only
    np.testing.assert_array_equal(content, [rows[:, 3] for rows in frames.values()])


def test_first_contents_have_seven_digits_and_later_grains_have_them(tmp_path):
    case = replace(WET_CASES["easo, packing"], runs=f"{WATCH}run 20")
    run_script(case.write(tmp_path), root=tmp_path)
    (rows,) = [rows for rows in table(tmp_path / "l.dump").values() if len(rows)]
    assert len(rows) == 29
    assert (rows[:, 1] == 0.01234568).all()


def test_a_source_adds_liquid(tmp_path):
    runs = f"run 0\nset atom 4 property/atom liquidSource 0.1\n{WATCH}run 100"
    case = replace(WET_CASES["easo, slow"], runs=runs)
    run_script(case.write(tmp_path), root=tmp_path)
    frames = table(tmp_path / "l.dump")
    gain = frames[100][:, 1] - frames[0][:, 1]
    np.testing.assert_allclose(gain[3], 0.1 * 100 * 1e-5, rtol=1e-9)


def test_liquid_goes_with_its_fix_and_comes_back_as_it_was_at_first(tmp_path):
    wetter = "run 0\nset atom 2 property/atom surfaceLiquidContent 0.03\n"
    runs = f"{wetter}unfix liquidtransfer\n{WATCH}run 1"
    case = replace(WET_CASES["easo, slow"], runs=runs)
    run_script(case.write(tmp_path), root=tmp_path)
    assert (table(tmp_path / "l.dump")[0][:, 1] == 0.01234568).all()
    text = case.script().replace("unfix liquidtransfer", "unfix liquidFlux")
    assert "unfix that instead" in refusal(tmp_path, case, text)
    text = case.script().replace("unfix liquidtransfer", "fix_modify liquidtransfer every 2")
    assert "liquid moves in every step" in refusal(tmp_path, case, text)


def test_a_property_of_the_liquid_needs_a_run_before_it(tmp_path):
    runs = "set atom 1 property/atom surfaceLiquidContent 0.03\nrun 1"
    case = replace(WET_CASES["easo, slow"], runs=runs)
    assert "no fix property/atom has 'surfaceLiquidContent'" in refusal(
        tmp_path, case, case.script()
    )


# -- bridges as contacts ---------------------------------------------------------------------------


def test_bridges_are_among_the_contacts(tmp_path):
    lines = (
        "compute c all pair/gran/local force delta history\n"
        "dump local all local 20 local.dump c_c[1] c_c[11] c_c[4]\nrun 800"
    )
    case = replace(WET_CASES["washino, collisions"], runs=lines)
    run_script(case.write(tmp_path), root=tmp_path)
    rows = np.concatenate([r for r in table(tmp_path / "local.dump").values() if len(r)])
    assert (rows[:, 1] < 0.0).any()  # a gap
    assert (rows[:, 2] == 1.0).all()
    assert (rows[rows[:, 1] < 0.0, 0] != 0.0).all()


@pytest.mark.parametrize(
    ("name", "first", "dt"),
    [
        ("easo, packing", 900, 1e-5),
        ("washino, packing", 900, 1e-5),
        ("thornton_ning, packing", 6000, 1e-6),
    ],
)
def test_a_restarted_run_goes_on_bit_for_bit(tmp_path, name, first, dt):
    runs = f"run {first}\nwrite_restart half.restart\nrun 600"
    body = f"{WET_CASES[name].body}timestep {dt}\n"
    case = replace(WET_CASES[name], body=body, steps=300, runs=runs)
    whole = case.write(tmp_path)
    run_script(whole, root=tmp_path)
    found = cases.read(tmp_path)
    text = re.sub(r"region reg .*\ncreate_box .*\n", "read_restart half.restart\n", case.script())
    (tmp_path / "in.script").write_text(text.replace(runs, "run 600"))
    run_script(whole, root=tmp_path)
    again = cases.read(tmp_path)
    for step in (first + 300, first + 600):
        np.testing.assert_array_equal(found.frames[step], again.frames[step])


@pytest.mark.parametrize("words", [EASO, WASHINO])
def test_two_threads_change_nothing_but_rounding(tmp_path, words):
    case = replace(poured(f"{HERTZ} {words}", runs=f"{WATCH}run 1500"), steps=1500)
    frames, liquid = [], []
    for threads in (1, 2):
        run_script(case.write(tmp_path), root=tmp_path, threads=threads)
        frames.append(cases.read(tmp_path).frames[1500])
        liquid.append(table(tmp_path / "l.dump")[1500][:, 1])
    # positions to what rounding, 1e-17 m, grows to in the contacts of 1500 steps
    np.testing.assert_allclose(frames[0][:, 2:5], frames[1][:, 2:5], rtol=0, atol=1e-12)
    np.testing.assert_allclose(liquid[0], liquid[1], rtol=1e-9)
    assert np.ptp(liquid[0]) > 0.0 or words == WASHINO
