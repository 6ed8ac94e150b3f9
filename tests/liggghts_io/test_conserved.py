"""What every run must keep: each grain is somewhere; mirrored and turned scripts give the same."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
import pytest

from liggghts_io import execute
from liggghts_io.case.spec import describe, setup_of
from liggghts_io.experiments.plate_impact.observing import IN_AIR, fate_of
from liggghts_io.measure.counts import read_count
from liggghts_io.measure.dumps import all_frames, read_frame
from minidem import run_script
from tests.liggghts_io.conftest import SMALL, TIMED

FALLS = {"conveyor": "scale.txt", "funnel_flow": "outlet.txt"}
"""Experiments that grains leave, and the file that lists those."""
STAYS = ("drawdown", "drum", "tilting_plate")
"""Experiments in which all grains stay."""


def folder_of(make_spec, tmp_path, experiment):
    """Run a small case; return the folder of its output."""
    apparatus = TIMED if experiment == "conveyor" else SMALL[experiment]
    result = execute(make_spec(experiment, apparatus=apparatus), tmp_path)
    return result.path / "output"


@pytest.mark.parametrize("experiment", FALLS)
def test_a_grain_is_in_the_apparatus_or_was_weighed(make_spec, tmp_path, experiment):
    """Ids are given one after the other, so that a grain that is lost leaves a gap."""
    folder = folder_of(make_spec, tmp_path, experiment)
    left = set(read_frame(all_frames(folder)[-1]).columns["id"].astype(int).tolist())
    weighed = set(read_count(folder / FALLS[experiment], 1.0).grain.tolist())
    assert left
    assert weighed
    assert left | weighed == set(range(1, 1 + max(left)))


def test_masses_of_a_plate_impact_are_those_of_the_grains_of_all_sizes(make_spec, tmp_path):
    """What is in boxes and beside is all that was poured but for grains still in the air."""
    spec = make_spec("plate_impact", apparatus={"mass_fraction": 0.05, "flight_s": 0.1})
    result = execute(spec, tmp_path)
    assert result.status == "ok", result.reason
    fate = fate_of(result.path / "output", setup_of(spec))
    assert len(np.unique(fate.mass_kg.round(9))) > 1
    down = 1.0 - fate.mass(IN_AIR) / fate.mass_kg.sum()
    assert 0.0 < down < 1.0
    poured_g = 1e3 * spec.particle.amount("impact_mass_kg")
    assert sum(result.observables.values()) == pytest.approx(poured_g * down)


@pytest.mark.parametrize("experiment", STAYS)
def test_grains_of_a_closed_apparatus_are_those_it_began_with(make_spec, tmp_path, experiment):
    folder = folder_of(make_spec, tmp_path, experiment)
    first, *rest = [read_frame(path).columns for path in all_frames(folder)[1:]]
    for later in rest:
        assert later["id"].tolist() == first["id"].tolist()
        assert later["radius"] == pytest.approx(first["radius"], rel=1e-6)


@dataclass(frozen=True)
class Symmetry:
    """A map of space under which an apparatus stays as it is.

    Attributes
    ----------
    matrix : (2, 2) tuple
        Of x and y.
    nuisances : dict of str to float
        What leans or stands off in the first script.
    mapped : dict of str to float
        The same in the mapped one.
    """

    matrix: tuple[tuple[float, float], tuple[float, float]]
    nuisances: dict[str, float]
    mapped: dict[str, float]

    def of(self, x, y):
        """Return x and y mapped."""
        (xx, xy), (yx, yy) = self.matrix
        return xx * x + xy * y, yx * x + yy * y

    def of_mesh(self, text):
        """Return the text of an STL file with its corners mapped: its diagonals too."""

        def mapped(found):
            x, y = self.of(float(found[1]), float(found[2]))
            return f"vertex {x!r} {y!r}"

        return re.sub(r"vertex (\S+) (\S+)", mapped, text)


ACROSS = ((1.0, 0.0), (0.0, -1.0))
QUARTER = ((0.0, -1.0), (1.0, 0.0))
SYMMETRIES = {
    "heap, mirrored": ("heap", Symmetry(ACROSS, {"tilt_y_deg": 4.0}, {"tilt_y_deg": -4.0})),
    "heap, a quarter turned": (
        "heap", Symmetry(QUARTER, {"tilt_x_deg": 4.0}, {"tilt_y_deg": 4.0}),
    ),
    "conveyor, mirrored": (
        "conveyor", Symmetry(ACROSS, {"cross_tilt_deg": 4.0}, {"cross_tilt_deg": -4.0}),
    ),
    "plate impact, mirrored": (
        "plate_impact", Symmetry(ACROSS, {"tilt_y_deg": 4.0}, {"tilt_y_deg": -4.0}),
    ),
}  # fmt: skip
PLACES = {
    "heap": (0.0, 0.0, 0.0015), "conveyor": (0.008, 0.0, 0.0015),
    "plate_impact": (0.0, 0.0, 0.0645),
}  # fmt: skip
"""Where a lump of grains begins to fall, above plate and wall, inside the apparatus [m]."""
APPARATUS = {
    "heap": {"side_walls": 0.0, "cone_mass_kg": 0.001, "frames": 10.0},
    "conveyor": {"width_fraction": 0.3, "frames": 10.0},
    "plate_impact": {"frames": 10.0},
}
STEPS = 4500
COUNT = 27
NEAR_D = 1e-6
"""Diameters. Neighbours are met in another order, which changes the last digit, and collisions
amplify that: to 3e-8 in these steps, to 1e-3 in twice as many."""


def lump(place, d):
    """Return centres and speeds of a loose lump, of no symmetry itself."""
    rng = np.random.default_rng(3)
    side = np.arange(3) - 1.0
    grid = np.stack(np.meshgrid(side, side, side + 1.0), axis=-1).reshape(COUNT, 3)
    centres = np.array(place) + 1.3 * d * grid + 0.1 * d * rng.uniform(-1.0, 1.0, (COUNT, 3))
    return centres, 0.1 * rng.normal(size=(COUNT, 3))


def trajectory(spec, folder, symmetry, mapped):
    """Run a lump of grains in the apparatus of a spec; return positions [m], (frames, n, 3)."""
    case = describe(spec)
    d = setup_of(spec).particle.d32_m
    centres, speeds = lump(PLACES[spec.experiment], d)
    if mapped:
        for one in (centres, speeds):
            one[:, 0], one[:, 1] = symmetry.of(one[:, 0].copy(), one[:, 1].copy())
    grains = []
    for k, (x, v) in enumerate(zip(centres, speeds, strict=True), start=1):
        grains += [
            f"create_atoms 1 single {x[0]:.17g} {x[1]:.17g} {x[2]:.17g} units box",
            f"set atom {k} diameter {d:.17g} density {spec.particle.density:.17g}",
            f"set atom {k} vx {v[0]:.17g} vy {v[1]:.17g} vz {v[2]:.17g}",
        ]
    head, _ = re.split(r"^fix pour1 ", case.script, maxsplit=1, flags=re.M)
    tail = [
        "fix motion all nve/sphere",
        f"dump frames all custom {STEPS // 10} post/frame_*.dump id type x y z vx vy vz radius",
        'dump_modify frames format "%d %d' + 7 * " %.15g" + '"',
        f"run {STEPS}",
    ]
    (folder / "meshes").mkdir(parents=True)
    for name, content in case.meshes.items():
        text = content.decode()
        (folder / "meshes" / name).write_text(symmetry.of_mesh(text) if mapped else text)
    script = folder / "in.script"
    script.write_text("\n".join([head, *grains, *tail, ""]))
    run_script(script, root=folder)
    return np.array([read_frame(path).positions for path in all_frames(folder)])


@pytest.mark.parametrize("name", SYMMETRIES)
def test_a_mirrored_or_turned_script_gives_the_mirrored_or_turned_run(make_spec, tmp_path, name):
    experiment, symmetry = SYMMETRIES[name]
    found = []
    for mapped, nuisances in enumerate((symmetry.nuisances, symmetry.mapped)):
        spec = make_spec(
            experiment, surface="glued" if experiment == "heap" else "steel",
            apparatus=APPARATUS[experiment] | nuisances,
        )  # fmt: skip
        found.append(trajectory(spec, tmp_path / str(mapped), symmetry, mapped))
    one, other = found
    d = make_spec().particle.d32_m
    changes = np.ptp(np.diff(one, n=2, axis=0), axis=0).max(axis=1)  # none in free fall
    assert (changes > 0.05 * d).sum() >= 5  # that many have bounced
    expected = np.stack([*symmetry.of(one[..., 0], one[..., 1]), one[..., 2]], axis=-1)
    np.testing.assert_allclose(other, expected, rtol=0.0, atol=NEAR_D * d)
