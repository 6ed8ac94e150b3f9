"""The conveyor's plate: today's motion by default, any sum of cosines as apparatus parameters."""

from __future__ import annotations

import math

import pytest

from liggghts_io.case.spec import build_case, script_of
from liggghts_io.experiments import EXPERIMENTS
from liggghts_io.experiments.plate_motion import HARMONICS, plate_motion
from minidem import run_script


def test_two_cosines_at_their_steepest_point_are_the_default():
    moving = plate_motion(EXPERIMENTS["conveyor"].apparatus("quick", {}))
    assert moving == {
        "amplitudes": [0.002, 0.0005],
        "phases": [0.5 * math.pi, 0.5 * math.pi],
        "periods": [0.08, 0.04],
    }


def test_every_harmonic_has_its_amplitude_phase_and_period(make_spec):
    apparatus = {"amplitude_m": 0.003, "period_s": 0.1, "harmonic_2": 0.0}
    for order in range(3, HARMONICS + 1):
        apparatus |= {f"harmonic_{order}": 0.1 / order, f"phase_{order}_deg": 10.0 * order}
    moving = build_case(make_spec("conveyor", apparatus=apparatus)).variables
    orders = [1, *range(3, HARMONICS + 1)]
    assert moving["amplitudes"] == pytest.approx([0.003, *(3e-4 / k for k in orders[1:])])
    assert moving["phases"] == pytest.approx(
        [0.5 * math.pi, *(math.radians(10.0 * k) for k in orders[1:])]
    )
    assert moving["periods"] == pytest.approx([0.1 / k for k in orders])


PROBE = """
atom_style granular
atom_modify map array sort 0 0
boundary f f f
newton off
communicate single vel yes
units si
region box block -0.1 0.1 -0.1 0.1 -0.1 0.1 units box
create_box 1 box
neighbor 0.002 bin
fix m1 all property/global youngsModulus peratomtype 5.e6
fix m2 all property/global poissonsRatio peratomtype 0.3
fix m3 all property/global coefficientRestitution peratomtypepair 1 0.5
fix m4 all property/global coefficientFriction peratomtypepair 1 0.5
pair_style gran model hertz tangential history
pair_coeff * *
timestep 1e-5
fix plate all mesh/surface file meshes/plate.stl type 1
{drive}
fix wall all wall/gran model hertz tangential history mesh n_meshes 1 meshes plate
fix nve all nve/sphere
dump mesh all mesh/stl {every} plate_*.stl plate
run {every}
"""


def test_an_engine_moves_the_plate_so(make_spec, tmp_path):
    """The plate in minidem after a third of a period, from the script of a case."""
    apparatus = {"harmonic_2": 0.3, "phase_2_deg": 20.0, "harmonic_5": 0.1, "phase_5_deg": -70.0}
    spec = make_spec("conveyor", apparatus=apparatus)
    drive = next(line for line in script_of(spec).splitlines() if "move/mesh" in line)
    moving = build_case(spec).variables
    every = 2667
    (tmp_path / "meshes").mkdir()
    (tmp_path / "meshes" / "plate.stl").write_text(
        "solid plate\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0.05 0 0\n"
        "vertex 0 0.05 0\nendloop\nendfacet\nendsolid plate\n"
    )
    (tmp_path / "in.probe").write_text(PROBE.format(drive=drive, every=every))
    run_script(tmp_path / "in.probe", root=tmp_path)
    words = (tmp_path / f"plate_{every}.stl").read_text().split()
    x = min(float(words[k + 1]) for k, word in enumerate(words) if word == "vertex")
    time = every * 1e-5
    waves = zip(moving["amplitudes"], moving["phases"], moving["periods"], strict=True)
    expected = sum(a * (math.cos(2 * math.pi * time / t + p) - math.cos(p)) for a, p, t in waves)
    assert x == pytest.approx(expected, abs=2e-6)
