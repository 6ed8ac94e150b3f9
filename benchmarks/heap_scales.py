"""Which size and shape of heap reproduces which: angles, scatter and cost over seeds, as a table.

    python benchmarks/heap_scales.py --seeds 5 --rows tests/data/heap_scales.csv
    python benchmarks/heap_scales.py --seeds 0 --rows tests/data/heap_scales.csv   # the table alone

Rows are appended as runs end; what is there is not run again.
"""

from __future__ import annotations

import argparse
import csv
import tempfile
import time
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from calibrate.study.resources import bundled_particles
from liggghts_io import CaseSpec, execute, particle_named
from liggghts_io.case.spec import setup_of
from liggghts_io.errors import CaseError
from liggghts_io.experiments.heap.observing import azimuths, has_walls, mean_of_flanks, measure
from liggghts_io.experiments.setup import Setup
from liggghts_io.materials import ONE
from liggghts_io.measure.dumps import Frame, all_frames, read_frame

GRAIN: Final = replace(particle_named("Carbo HSP13", bundled_particles()), sizes=ONE)
PUBLISHED: Final = {
    "mu_pp": 0.694, "mu_roll_pp": 0.0856, "mu_pw": 0.307, "mu_roll_pw": 0.274,
    "e_pp": 0.742, "e_pw": 0.439,
}  # fmt: skip
SETS: Final = {
    "glued, published": ("glued", {}),
    "steel, published": ("steel", {}),
    "glued, steep": ("glued", {"mu_pp": 0.8, "mu_roll_pp": 0.3}),
}
"""Surface and changes to the published parameters, by name."""
TRUTH: Final = "cone, 40 g"
"""What the bias of the others is counted from: the heap of the `paper` scale."""
_LATE: Final = 0.5  # part of the pour after which the growing heap is averaged
_COLUMNS: Final = (
    "heap", "parameters", "seed", "angle_deg", "growing_deg", "last_deg", "last_se_deg",
    "grains", "particle_steps", "cpu_s",
)  # fmt: skip


@dataclass(frozen=True)
class Heap:
    """A size and shape of heap.

    Attributes
    ----------
    scale : str
    sets : tuple of str
        Names of `SETS`.
    apparatus : Mapping[str, float]
        Overrides.
    """

    scale: str
    sets: tuple[str, ...]
    apparatus: Mapping[str, float] = field(default_factory=dict)


_TWO: Final = ("glued, published", "steel, published")
_FAR: Final = {
    "side_walls": 1.0, "slice_width_d": 60.0, "plate_half_length_d": 30.0, "pour_grains": 2000.0,
    "pour_tau": 200.0, "settle_tau": 40.0,
}  # fmt: skip
HEAPS: Final = {
    "slice, quick": Heap("quick", tuple(SETS)),
    "cone, 10 g": Heap("paper", _TWO, {"cone_mass_kg": 0.01}),
    "cone, 20 g": Heap("paper", _TWO, {"cone_mass_kg": 0.02}),
    TRUTH: Heap("paper", tuple(SETS)),
    "cone, 80 g": Heap("paper", _TWO[1:], {"cone_mass_kg": 0.08, "pour_angle_deg": 42.0}),
    "slice, quick, 40 tau of rest": Heap("quick", _TWO, {"settle_tau": 40.0}),
    "rising spout, walls far away": Heap("quick", _TWO[:1], _FAR),
    "slice, lab": Heap("lab", _TWO),
}


def angle_of(frames: list[Frame], setup: Setup) -> tuple[float, float]:
    """Return the mean angle of frames and the standard error if they are one, both [deg]."""
    found = []
    for frame in frames:
        try:
            views = [measure(frame, setup, turn) for turn in azimuths(setup)]
        except CaseError:  # no heap yet
            continue
        found.append(mean_of_flanks(views))
    means, errors = zip(*found, strict=True) if found else ((np.nan,), (np.nan,))
    return float(np.mean(means)), float(errors[-1])


def measured(heap: str, name: str, seed: int) -> dict[str, object]:
    """Run one heap and return its row."""
    surface, changes = SETS[name]
    chosen = HEAPS[heap]
    spec = CaseSpec(
        "heap", GRAIN, surface, chosen.scale, PUBLISHED | changes, chosen.apparatus, seed=seed
    )
    setup = setup_of(spec)
    with tempfile.TemporaryDirectory() as root:
        started = time.process_time()
        result = execute(spec, Path(root))
        spent = time.process_time() - started
        frames = [read_frame(path) for path in all_frames(result.path / "output")]
    steps = np.array([one.step for one in frames])
    counts = np.array([one.count for one in frames])
    a = setup.apparatus
    run = a["pour_tau"] + a["settle_tau"]
    pour = a["frames"] * (a["pour_tau"] / run if has_walls(setup) else 1.0)
    late = [one for k, one in enumerate(frames) if _LATE * pour <= k <= pour]
    growing, _ = angle_of(late, setup)
    last, error = angle_of(frames[-1:], setup)
    values = (
        heap, name, seed, result.observables.get("angle_deg", np.nan), growing, last, error,
        int(counts[-1]), float(np.sum(counts[1:] * np.diff(steps))), spent,
    )  # fmt: skip
    return dict(zip(_COLUMNS, values, strict=True))


def run_all(rows: Path, seeds: int, only: list[str]) -> None:
    """Run what is not in the file of rows, seed by seed, and append it."""
    if not rows.exists():
        rows.write_text(",".join(_COLUMNS) + "\n", encoding="utf-8")
    known = pd.read_csv(rows)
    done = set(zip(known["heap"], known["parameters"], known["seed"], strict=True))
    for seed in range(1, seeds + 1):
        for heap, chosen in HEAPS.items():
            for name in chosen.sets:
                if (heap, name, seed) in done or (only and heap not in only):
                    continue
                row = measured(heap, name, seed)
                with rows.open("a", newline="", encoding="utf-8") as file:
                    csv.DictWriter(file, _COLUMNS).writerow(
                        {k: f"{v:.6g}" if isinstance(v, float) else v for k, v in row.items()}
                    )


def pooled_variance(rows: pd.DataFrame) -> tuple[float, int]:
    """Return the variance over seeds within each set of parameters, and its degrees of freedom."""
    groups = rows.groupby("parameters")["angle_deg"]
    freedom = int((groups.count() - 1).sum())
    squares = float(((rows["angle_deg"] - groups.transform("mean")) ** 2).sum())
    return (squares / freedom if freedom else np.nan), freedom


def table(rows: pd.DataFrame) -> list[str]:
    """Return the lines of the table: one for each heap and set of parameters."""
    lines = [
        "| heap | parameters | angle (seeds) | growing | last frame | less the cone of 40 g "
        "| sd over seeds (degrees of freedom) | 1e6 particle-steps | of them for 1 deg |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    truth = rows[rows["heap"] == TRUTH].groupby("parameters")["angle_deg"].mean()
    for heap, chosen in HEAPS.items():
        variance, freedom = pooled_variance(rows[rows["heap"] == heap])
        scatter = f"{np.sqrt(variance):.2f} ({freedom})" if freedom else "-"
        for name in chosen.sets:
            part = rows[(rows["heap"] == heap) & (rows["parameters"] == name)]
            if part.empty:
                continue
            angle, cost = part["angle_deg"].mean(), part["particle_steps"].mean() / 1e6
            price = f"{cost * variance:.0f}" if freedom else "-"
            lines.append(
                f"| {heap} | {name} | {angle:.2f} ({len(part)}) "
                f"| {part['growing_deg'].mean():.1f} | {part['last_deg'].mean():.1f} "
                f"| {angle - truth[name]:+.1f} | {scatter} | {cost:.0f} | {price} |"
            )
    return lines


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--rows", type=Path, default=Path("tests/data/heap_scales.csv"))
    parser.add_argument("--only", nargs="*", default=[], choices=list(HEAPS), metavar="HEAP")
    chosen = parser.parse_args()
    run_all(chosen.rows, chosen.seeds, chosen.only)
    print("\n".join(table(pd.read_csv(chosen.rows))))


if __name__ == "__main__":
    main()
