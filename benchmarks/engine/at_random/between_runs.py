"""Random changes between the runs of a script, for `random_scripts`."""

from __future__ import annotations

import random
from collections.abc import Callable

__all__ = ["between_runs", "box_of"]

_BOXES = ["f f f", "f f f", "p p f", "p f f", "p p p", "m m f"]

_POINT = "0.012 -0.006 0.03"
_REGIONS = (
    "block -0.03 0.005 -0.03 0.03 -0.02 0.06", "sphere 0.005 0 0.01 0.014",
    "cylinder z 0 0 0.012 -0.02 0.08", "block INF INF INF INF 0.006 INF",
)  # fmt: skip


class _Script:
    """What a script has set up so far.

    Parameters
    ----------
    draw : random.Random
        Source of all choices.
    lines : list of str
        The script up to its first run.
    """

    def __init__(self, draw: random.Random, lines: list[str]) -> None:
        self.draw = draw
        self.fixes = {words[1]: words[3] for words in map(str.split, lines) if words[0] == "fix"}
        self.first = {line.split()[1]: line for line in lines if line.startswith("fix ")}
        self.pair = next(line for line in lines if line.startswith("pair_style"))
        self.computes: list[str] = []
        self.made = 0

    def name(self, letter: str) -> str:
        """Return a new name."""
        self.made += 1
        return f"{letter}{self.made}"

    def any_fix(self, *styles: str) -> str | None:
        """Return a fix of one of some styles that is there, None without one."""
        found = [name for name, style in self.fixes.items() if style.startswith(styles)]
        return self.draw.choice(found) if found else None

    def fix(self, words: str) -> str:
        """Add a fix, given group, style and the rest."""
        name = self.name("f")
        self.fixes[name] = words.split()[1]
        return f"fix {name} {words}"

    def group(self) -> list[str]:
        """Return the lines that make a group, named last."""
        name, region = self.name("g"), self.name("r")
        if self.draw.random() < 0.3:
            return [f"group {name} type {self.draw.choice([1, 2])}", name]
        made = f"region {region} {self.draw.choice(_REGIONS)} units box"
        return [made, f"group {name} region {region}", name]


def _take_away(s: _Script) -> list[str]:
    name = s.any_fix(
        "gravity", "move/mesh", "massflow", "insert", "freeze", "viscous", "addforce", "setforce",
        "move", "nve/limit",
    )  # fmt: skip
    if name is None:
        return []
    del s.fixes[name]
    return [f"unfix {name}"]


def _take_wall(s: _Script) -> list[str]:
    """Take a wall away; its meshes stay, as a wall again or without one."""
    name = s.any_fix("wall/gran")
    if name is None:
        return []
    lines = [f"unfix {name}"]
    if s.draw.random() < 0.5:
        lines.append(s.first[name])
    else:
        del s.fixes[name]
    return lines


def _take_mesh(s: _Script) -> list[str]:
    """Take the wall away, a mesh, and what moves or counts it; the rest is a wall again."""
    wall = next((name for name in s.fixes if name == "wm"), None)
    mesh = s.any_fix("mesh/surface")
    if wall is None or mesh is None:
        return []
    lines = [f"unfix {wall}"]
    for name in [
        name for name, style in s.fixes.items() if style in ("move/mesh", "massflow/mesh")
    ]:
        if f"mesh {mesh} " in s.first.get(name, ""):
            lines.append(f"unfix {name}")
            del s.fixes[name]
    lines.append(f"unfix {mesh}")
    del s.fixes[mesh], s.fixes[wall]
    rest = [name for name, style in s.fixes.items() if style.startswith("mesh/surface")]
    rest = [name for name in rest if name != "gate"]
    if rest:
        head, _, tail = s.first[wall].partition(" mesh n_meshes ")
        count, _, *words = tail.split()
        words = [*rest, *words[int(count) :]]
        s.first[wall] = f"{head} mesh n_meshes {len(rest)} meshes {' '.join(words)}"
        lines.append(s.first[wall])
        s.fixes[wall] = "wall/gran"
    return lines


def _force(s: _Script) -> list[str]:
    *lines, group = s.group()
    words = s.draw.choice(
        ["freeze", "viscous 0.002", "addforce 0.001 0 0.002", "setforce 0 NULL 0"]
    )
    return [*lines, s.fix(f"{group} {words}")]


def _particles(s: _Script) -> list[str]:
    """Change particles that are there."""
    *lines, group = s.group()
    return [
        *lines,
        s.draw.choice(
            [
                f"delete_atoms group {group}", f"velocity {group} set 0.1 NULL -0.2",
                f"velocity {group} set 0 0 0.3 sum yes", f"set group {group} density 1800",
                f"set group {group} diameter 0.0045", f"set group {group} type 1",
                f"displace_atoms {group} move 0.0004 0 0.001 units box",
                f"displace_atoms {group} ramp x 0 0.001 z 0 0.02 units box",
                f"displace_atoms {group} rotate 0 0 0.01 0 0 1 20 units box",
                f"set group {group} vz 0.2", f"set group {group} omegax 5",
            ]
        ),
    ]  # fmt: skip


def _more(s: _Script) -> list[str]:
    """Bring further particles."""
    region = s.name("r")
    if s.draw.random() < 0.4:
        name = s.name("g")
        return [
            f"create_atoms 2 single {_POINT} units box",
            f"region {region} sphere {_POINT} 0.0001 units box", f"group {name} region {region}",
            f"set group {name} density 2000 diameter 0.005",
        ]  # fmt: skip
    place = s.draw.choice(["block -0.02 0.02 -0.02 0.02 0.03 0.06", "sphere 0 0 0.04 0.015"])
    kind = s.draw.choice(
        [
            "insert/pack seed 49979687 distributiontemplate pd maxattempt 50 insert_every once "
            f"overlapcheck yes all_in yes vel constant 0 0 -0.3 region {region} "
            "particles_in_region 20",
            "insert/rate/region seed 67867967 distributiontemplate pd nparticles 30 particlerate "
            "3000 insert_every 200 overlapcheck yes all_in no vel constant 0.1 0 -0.3 region "
            f"{region}",
        ]
    )
    return [f"region {region} {place} units box", s.fix(f"all {kind}")]


def _settings(s: _Script) -> list[str]:
    return [
        s.draw.choice(
            [
                f"timestep {s.draw.choice([4e-6, 8e-6, 1e-5])}", "neighbor 0.002 bin",
                "neigh_modify delay 0 every 1 check yes", "reset_timestep 0",
                "neigh_modify exclude type 1 2",
                "neigh_modify delay 0 contact_distance_factor 1.02",
                "neigh_modify one 2500 page 150000",
            ]
        )
    ]  # fmt: skip


def _asking(s: _Script) -> list[str]:
    """Let computes with lists of their own come or go, or give the contact model again."""
    if s.computes and s.draw.random() < 0.4:
        return [f"uncompute {s.computes.pop()}"]
    if s.draw.random() < 0.3:
        return [s.pair, "pair_coeff * *"]
    name = s.name("c")
    s.computes.append(name)
    return [f"compute {name} all {s.draw.choice(['contact/atom', 'coord/atom 0.004', 'ke/atom'])}"]


def _motion(s: _Script) -> list[str]:
    """Let a mesh move from now on."""
    mesh = s.any_fix("mesh/surface")
    if mesh is None or mesh == "gate":
        return []
    words = s.draw.choice(
        ["linear 0.02 0 0.01", "wiggle amplitude 0 0.0006 0.0004 period 0.015",
         "rotate origin 0 0 0 axis 0 0.3 1 period 0.5"]
    )  # fmt: skip
    line = s.fix(f"all move/mesh mesh {mesh} {words}")
    s.first[line.split()[1]] = line
    return [line]


_CHANGES: tuple[Callable[[_Script], list[str]], ...] = (
    _take_away, _take_wall, _take_mesh, _force, _particles, _more, _settings, _motion, _asking,
)  # fmt: skip


def box_of(seed: int) -> tuple[str, float]:
    """Return the boundary of a seed's box and half of its width, m: periodic ones are small."""
    boundary = random.Random(f"box {seed}").choice(_BOXES)
    return boundary, 0.026 if "p" in boundary else 0.08


def between_runs(draw: random.Random, lines: list[str], steps: int, every: int) -> list[str]:
    """Return runs of some steps in all, with one to three changes between each two.

    Parameters
    ----------
    draw : random.Random
        Source of all choices.
    lines : list of str
        The script up to its first run.
    steps, every : int
        Steps of all runs, and interval of the frames.
    """
    script = _Script(draw, lines)
    found: list[str] = []
    count = draw.choice([3, 4, 5])
    for k in range(count):
        found.append(f"run {steps // count + draw.choice([0, 1, every // 3])}")
        if draw.random() < 0.3:
            found.append(f"run 50 pre no{draw.choice(['', ' post no', ' every 20 NULL'])}")
        if k < count - 1:
            for _ in range(draw.choice([1, 1, 2, 3])):
                found += draw.choice(_CHANGES)(script)
    return found
