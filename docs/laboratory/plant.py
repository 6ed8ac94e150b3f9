"""Make the measured data of the invented bulk solid: runs of the engine at `truth.toml`, and noise.

`python docs/laboratory/plant.py` writes the tables beside itself, in a minute of one core;
`visit.py` makes of them what somebody brings back from a laboratory.
"""

from __future__ import annotations

import tempfile
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from liggghts_io import CaseSpec, Particle, execute
from liggghts_io.bulk import Bulk
from liggghts_io.experiments.plate_motion import MOTION_PARAMETERS, plate_motion

HERE = Path(__file__).resolve().parent
PLATES = {"glued": "glued", "steel": "flat"}
SEED = 810_000
"""Seeds of the data, far from those of a calibration."""
PHOTOGRAPHED = 0.9
"""Part of the pour after which the photograph is taken, the funnel still running."""
BEFORE_S = 3.0
"""Time that the scale is logged before the funnel opens."""


def main() -> None:
    """Write every file of the data."""
    truth = tomllib.loads((HERE / "truth.toml").read_text(encoding="utf-8"))
    grain = Bulk(**truth["material"]).particle
    rng = np.random.default_rng(truth["noise_seed"])
    with tempfile.TemporaryDirectory() as folder:
        runs = Path(folder)
        _write_heaps(truth, grain, runs)
        _write_logs(truth, grain, runs, rng)
    _write_motion(truth, rng)
    flows = truth["material"]["flow_flat_g_s"] + truth["funnel"]["noise_g_s"] * rng.normal(size=3)
    print("weighed below the funnel:", " ".join(f"{flow:.1f}" for flow in flows), "g/s")


def _run(truth: dict[str, Any], grain: Particle, runs: Path, place: tuple[str, str, int]) -> Path:
    """Run an experiment at the true values and return its directory."""
    experiment, plate, number = place
    parameters = truth["parameters"]
    seed = SEED + number
    result = execute(
        CaseSpec(experiment, grain, PLATES[plate], "quick", parameters, seed=seed), runs
    )
    if result.status != "ok":
        raise SystemExit(result.reason)
    return result.path


def _write_heaps(truth: dict[str, Any], grain: Particle, runs: Path) -> None:
    """Write where the grains of each photographed heap are, those at the back first."""
    for plate in PLATES:
        for number in range(1, truth["photographs"] + 1):
            case = _run(truth, grain, runs, ("heap", plate, number))
            frames = sorted((case / "output" / "post").glob("frame_*.dump"), key=_step)
            grains = _grains(frames[round(PHOTOGRAPHED * len(frames)) - 1])
            rows = [f"{x:.1f},{z:.1f},{d:.2f}" for x, z, d in grains]
            text = "\n".join(["x_mm,z_mm,diameter_mm", *rows])
            (HERE / f"heap_{plate}{number}.csv").write_text(f"{text}\n", encoding="utf-8")


def _step(frame: Path) -> int:
    return int(frame.stem.removeprefix("frame_"))


def _grains(frame: Path) -> npt.NDArray[np.float64]:
    """Return x, z and diameter (n, 3) of the grains of a dump [mm], from back to front."""
    head = frame.read_text(encoding="ascii").splitlines()[8].split()[2:]
    rows = np.loadtxt(frame, skiprows=9, ndmin=2)
    x, y, z, radius = (rows[:, head.index(name)] * 1e3 for name in ("x", "y", "z", "radius"))
    return np.column_stack([x, z, 2.0 * radius])[np.argsort(-y)]


def _write_logs(
    truth: dict[str, Any], grain: Particle, runs: Path, rng: np.random.Generator
) -> None:
    """Write what the scale showed, from before the funnel was opened to the end of the run."""
    scale = truth["scale"]
    for plate in PLATES:
        for number in range(1, truth["logs"] + 1):
            case = _run(truth, grain, runs, ("conveyor", plate, number))
            known = np.loadtxt(case / "mass_time.csv", delimiter=",", skiprows=1)
            time = np.arange(-BEFORE_S, known[-1, 0], 1.0 / scale["rate_hz"])
            mass = np.interp(time, known[:, 0], known[:, 1])
            shown = scale["tare_g"] + mass + scale["noise_g"] * rng.normal(size=len(time))
            rows = [f"{t:.2f};{m:.2f}" for t, m in zip(time, shown, strict=True)]
            text = "\n".join(["time [s];mass [g]", *rows]).replace(".", ",")
            (HERE / f"log_{plate}{number}.csv").write_text(f"{text}\n", encoding="utf-8")


def _write_motion(truth: dict[str, Any], rng: np.random.Generator) -> None:
    """Write what the accelerometer on the plate showed over half a second."""
    motion = plate_motion({one.name: one.quick for one in MOTION_PARAMETERS})
    noise, rate = truth["motion"]["noise_m_s2"], truth["motion"]["rate_hz"]
    time = np.arange(0.0, 0.5, 1.0 / rate)
    acceleration = noise * rng.normal(size=len(time))
    for amplitude, phase, period in zip(
        motion["amplitudes"], motion["phases"], motion["periods"], strict=True
    ):
        omega = 2.0 * np.pi / period
        acceleration -= amplitude * omega**2 * np.cos(omega * time + phase)
    rows = [f"{1e3 * t:.0f},{a:.2f}" for t, a in zip(time, acceleration, strict=True)]
    text = "\n".join(["t [ms],a [m/s2]", *rows])
    (HERE / "plate.csv").write_text(f"{text}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
