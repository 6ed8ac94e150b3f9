"""What a plate impact shows: the mass in every box, where grains land, and where each one went."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt

from liggghts_io.errors import CaseError
from liggghts_io.experiments.plate_impact.rig import BOXES, POURED, domain_x, opening
from liggghts_io.experiments.setup import Observed, Setup
from liggghts_io.measure.counts import Count, read_count
from liggghts_io.measure.dumps import SCRIPT, FloatArray, all_frames, read_frame
from liggghts_io.measure.landings import Opening, caught, landing_x, masses_in
from liggghts_io.measure.schedule import load_of

LANDING: Final = "landing.csv"
BALANCE: Final = "balance.csv"
IN_AIR: Final = -1
BESIDE: Final = 0
"""Places of grains that are in no box."""

_BIN_MM: Final = 1.0
_STEADY: Final = (0.1, 0.9)  # parts of the grains between which the flow is taken
_LATE: Final = 0.01
"""Part of the grains that may be missing at the end; else the flow was not that of the case."""


@dataclass(frozen=True)
class Fate:
    """Where every grain of a run is at its end.

    Attributes
    ----------
    grain : (n,) int64
        Ids of all grains that were poured, rising.
    mass_kg : (n,) float64
    box : (n,) int64
        Number of its box, 0 for a grain that fell beside, -1 for one still in the air.
    """

    grain: npt.NDArray[np.int64]
    mass_kg: FloatArray
    box: npt.NDArray[np.int64]

    def counted(self) -> dict[str, int]:
        """Return the number of grains poured, in each box, beside and in the air."""
        boxes = {f"box_{box}": int((self.box == box).sum()) for box in BOXES}
        rest = {
            "beside": int((self.box == BESIDE).sum()),
            "in_air": int((self.box == IN_AIR).sum()),
        }
        return {"poured": len(self.grain), **boxes, **rest}

    def mass(self, box: int) -> float:
        """Return the mass with one fate [kg]."""
        return float(self.mass_kg[self.box == box].sum())


def fate_of(folder: Path, setup: Setup) -> Fate:
    """Return where every grain of a finished run is, each in one place.

    Grains are counted at the funnel outlet and in the boxes; those that the last frame holds and
    no box has counted are in the air. Boxes without rims take what comes down to their mouths.

    Raises
    ------
    DamagedFile
        If a file is not as the script says.
    """
    density = setup.particle.density
    last = read_frame(all_frames(folder)[-1]).columns
    present = last["id"].astype(np.int64).tolist()
    solid = density * np.pi / 6.0 * (2.0 * last["radius"]) ** 3
    masses = dict(zip(present, solid.tolist(), strict=True))
    places = dict.fromkeys(present, IN_AIR)
    outlet = read_count(folder / "poured.txt", density)
    boxes = _boxed(folder, setup)
    for count, place in ((outlet, None), *boxes):
        for grain, mass in zip(count.grain.tolist(), count.mass_kg.tolist(), strict=True):
            masses.setdefault(grain, mass)
            places[grain] = places.get(grain, BESIDE) if place is None else place
    grains = sorted(masses)
    return Fate(
        np.array(grains, dtype=np.int64),
        np.array([masses[one] for one in grains]),
        np.array([places[one] for one in grains], dtype=np.int64),
    )


def _boxed(folder: Path, setup: Setup) -> list[tuple[Count, int]]:
    """Return the grains in the boxes, and beside as far as that is known, with their place."""
    if setup.apparatus["box_rims"]:
        density = setup.particle.density
        return [(read_count(folder / f"box{box}.txt", density), box) for box in BOXES]
    down = landings(folder, setup)
    inside = {box: caught(down, opening(setup, box)) for box in BOXES}
    beside = ~np.any(list(inside.values()), axis=0)
    return [(down.part(beside), BESIDE), *((down.part(one), box) for box, one in inside.items())]


def landings(folder: Path, setup: Setup) -> Count:
    """Return the grains that came down to the mouths of the boxes, before they touched a rim.

    Raises
    ------
    DamagedFile
    """
    return read_count(folder / "landing.txt", setup.particle.density)


def masses_with(folder: Path, setup: Setup, boxes: Sequence[Opening]) -> list[float]:
    """Return what boxes elsewhere would hold, from the landings of a finished run [g].

    Box positions, widths and heights need no new run this way. Left out is what bounces off the
    rims of the boxes.

    Parameters
    ----------
    folder : Path
    setup : Setup
        Of the run.
    boxes : sequence of Opening

    Raises
    ------
    CaseError
        If no grain was poured; DamagedFile if the run is not whole.
    """
    scale = _scale(fate_of(folder, setup), setup)
    return [scale * mass for mass in masses_in(landings(folder, setup), boxes)]


def _scale(fate: Fate, setup: Setup) -> float:
    """Return the mass poured in reality over the one poured in the run [g/kg]."""
    poured = float(fate.mass_kg.sum())
    if poured == 0.0:
        msg = "no grain was poured: none left the funnel outlet, and the last frame holds none"
        raise CaseError(msg)
    return setup.particle.amount(POURED) * 1e3 / poured


def distribution(count: Count, setup: Setup, scale: float) -> dict[str, FloatArray]:
    """Return the mass that lands nearer to the pipe axis than a distance, each millimetre.

    Parameters
    ----------
    count : Count
        Landings.
    setup : Setup
    scale : float
        Real mass over simulated mass, in grams per kilogram.

    Returns
    -------
    dict of str to (L,) float64
        "distance_mm", far end of a bin; "mass_g", mass nearer than that; "bin_g", mass in the bin.
    """
    a = setup.apparatus
    low, high = (round(x * 1e3 / _BIN_MM) * _BIN_MM for x in domain_x(setup))
    edges = np.arange(low, high + 0.5 * _BIN_MM, _BIN_MM)
    x, y = landing_x(count, a["box_shift_z_m"])
    inside = np.abs(y) <= 0.5 * a["box_width_m"]
    bins, _ = np.histogram(x[inside] * 1e3, edges, weights=count.mass_kg[inside] * scale)
    return {"distance_mm": edges[1:], "mass_g": np.cumsum(bins), "bin_g": bins}


def observe(folder: Path, setup: Setup) -> Observed:
    """Return the masses in and beside the boxes as grams of the real initial mass."""
    fate = fate_of(folder, setup)
    scale = _scale(fate, setup)
    _check_poured(folder, len(fate.grain))
    values = {f"m{box}_g": fate.mass(box) * scale for box in BOXES}
    values["beside_g"] = fate.mass(BESIDE) * scale
    balance = {name: np.array([float(count)]) for name, count in fate.counted().items()}
    balance["flow_g_s"] = np.array([1e3 * poured_flow(folder, setup)])
    tables: Mapping[str, Mapping[str, FloatArray]] = {
        LANDING: distribution(landings(folder, setup), setup, scale),
        BALANCE: balance,
    }
    return Observed(values, tables)


def poured_flow(folder: Path, setup: Setup) -> float:
    """Return the mass flow in the funnel outlet over the middle of the pour [kg/s].

    It stays below the one asked for where grains find no room to appear.
    """
    count = read_count(folder / "poured.txt", setup.particle.density)
    first, last = (int(part * len(count.time_s)) for part in _STEADY)
    if last - first < 2:
        return float("nan")
    time = float(count.time_s[last] - count.time_s[first])
    return float(count.mass_kg[first:last].sum()) / time if time > 0.0 else float("nan")


def _check_poured(folder: Path, count: int) -> None:
    """Refuse a run whose funnel could not pour what was asked for."""
    asked = load_of((folder / SCRIPT).read_text(encoding="utf-8")).grains
    if count < (1.0 - _LATE) * asked:
        msg = (
            f"{count} of {asked:g} grains were poured: so many find no room at the funnel outlet; "
            "raise pour_depth_m, pour_speed_m_s or spout_radius_m, or take smaller grains"
        )
        raise CaseError(msg)
