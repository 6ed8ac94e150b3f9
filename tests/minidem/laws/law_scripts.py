"""Small scripts for tests of the engine: spheres on planes and in pairs.

Type 1 are the balls, type 2 the floor; ``young`` and ``poisson`` hold a value of each.
A ``wall_model`` of its own costs no compilation of another loop over pairs.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from minidem import RunSummary, run_script
from tests.minidem.interpreted import run_interpreted

YOUNG, POISSON, DENSITY, RADIUS, DT = 5e6, 0.3, 2500.0, 0.005, 1e-5


@dataclass(frozen=True)
class Ball:
    """A sphere: position, velocity, spin, m, m/s, rad/s."""

    x: tuple[float, float, float]
    v: tuple[float, float, float] = (0.0, 0.0, 0.0)
    w: tuple[float, float, float] = (0.0, 0.0, 0.0)
    radius: float = RADIUS
    density: float = DENSITY


@dataclass(frozen=True)
class Scene:
    """A script in parts.

    What belongs to the floor alone stands in `wall_model` and `wall_settings`: walls of any model
    share one loop, a new model of pairs has to be compiled.
    """

    balls: tuple[Ball, ...]
    restitution: float = 0.5
    friction: float = 0.4
    rolling: float = 0.1
    model: str = "hertz tangential history"
    wall_model: str = ""
    wall_settings: str = ""
    floor: bool = True
    gravity: tuple[float, float, float] = (0.0, 0.0, -9.81)
    boundary: str = "f f f"
    box: str = "-0.5 0.5 -0.5 0.5 -0.5 0.5"
    dt: float = DT
    settings: str = ""
    skin: float = 0.002
    young: tuple[float, float] = (YOUNG, YOUNG)
    poisson: tuple[float, float] = (POISSON, POISSON)
    more: tuple[str, ...] = field(default_factory=tuple)

    def text(self, steps: int, every: int) -> str:
        """Return the script."""
        e, mu, mur = self.restitution, self.friction, self.rolling
        strength = float(np.linalg.norm(self.gravity)) or 0.0
        way = self.gravity if strength else (0.0, 0.0, -1.0)
        lines = [
            "atom_style granular",
            "atom_modify map array sort 0 0",
            f"boundary {self.boundary}",
            "newton off",
            "communicate single vel yes",
            "units si",
            *(["hard_particles yes"] if max(self.young) > 1e9 else []),
            f"region box block {self.box} units box",
            "create_box 2 box",
            f"neighbor {self.skin} bin",
            "neigh_modify delay 0",
            f"fix m1 all property/global youngsModulus peratomtype {self.young[0]} {self.young[1]}",
            "fix m2 all property/global poissonsRatio peratomtype "
            f"{self.poisson[0]} {self.poisson[1]}",
            f"fix m3 all property/global coefficientRestitution peratomtypepair 2 {e} {e} {e} {e}",
            f"fix m4 all property/global coefficientFriction peratomtypepair 2 {mu} {mu} {mu} {mu}",
            "fix m5 all property/global coefficientRollingFriction peratomtypepair 2 "
            f"{mur} {mur} {mur} {mur}",
            f"pair_style gran model {self.model} {self.settings}",
            "pair_coeff * *",
            f"timestep {self.dt}",
            f"fix g all gravity {strength} vector {way[0]} {way[1]} {way[2]}",
        ]
        if self.floor:
            lines.append(
                f"fix floor all wall/gran model {self.wall_model or self.model} "
                f"primitive type 2 zplane 0.0 {self.settings} {self.wall_settings}"
            )
        for i, ball in enumerate(self.balls, start=1):
            x, v, w = ball.x, ball.v, ball.w
            lines += [
                f"create_atoms 1 single {x[0]:.17g} {x[1]:.17g} {x[2]:.17g} units box",
                f"set atom {i} density {ball.density} diameter {2 * ball.radius}",
                f"set atom {i} vx {v[0]:.17g} vy {v[1]:.17g} vz {v[2]:.17g} "
                f"omegax {w[0]:.17g} omegay {w[1]:.17g} omegaz {w[2]:.17g}",
            ]
        columns = "id type x y z vx vy vz omegax omegay omegaz mass radius fx fy fz"
        form = " ".join(["%d %d", *["%.17g"] * 14])
        return "\n".join(
            [
                *lines,
                *self.more,
                "fix integr all nve/sphere",
                "thermo_style custom step atoms ke",
                f"thermo {every}",
                "thermo_modify lost error norm no",
                f"dump d all custom {every} out.dump {columns}",
                f'dump_modify d sort id format "{form}"',
                f"run {steps}",
                "",
            ]
        )


@dataclass(frozen=True)
class Track:
    """What a run printed: frames of x, v, w, f; shape (frames, balls, 3) each."""

    step: np.ndarray
    x: np.ndarray
    v: np.ndarray
    w: np.ndarray
    f: np.ndarray
    mass: np.ndarray
    radius: np.ndarray
    summary: RunSummary | None  # None if interpreted

    def kinetic(self) -> np.ndarray:
        """Return translational and rotational energy per frame, J."""
        inertia = 0.4 * self.mass * self.radius**2
        moving = 0.5 * self.mass * (self.v**2).sum(axis=2)
        turning = 0.5 * inertia * (self.w**2).sum(axis=2)
        return (moving + turning).sum(axis=1)


def run(
    scene: Scene, folder: Path, steps: int, every: int | None = None, *, interpreted: bool = False
) -> Track:
    """Run a scene and read what it printed; see `run_interpreted` for models that are rare."""
    (folder / "in.script").write_text(scene.text(steps, every or steps))
    summary = None
    if interpreted:
        run_interpreted(folder / "in.script")
    else:
        summary = run_script(folder / "in.script", root=folder)
    lines = (folder / "out.dump").read_text().splitlines()
    frames, at = [], 0
    while at < len(lines):
        count = int(lines[at + 3])
        rows = [[float(word) for word in row.split()] for row in lines[at + 9 : at + 9 + count]]
        frames.append((int(lines[at + 1]), rows))
        at += 9 + count
    data = np.array([rows for _, rows in frames])
    return Track(
        np.array([step for step, _ in frames]),
        data[:, :, 2:5],
        data[:, :, 5:8],
        data[:, :, 8:11],
        data[:, :, 13:16],
        data[0, :, 11],
        data[0, :, 12],
        summary,
    )
