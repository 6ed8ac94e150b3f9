"""Particles that `read_dump` takes from a dump, and what becomes of those that were there."""

from __future__ import annotations

from tests.minidem.engine.case_list import FLOOR, WEIGHT
from tests.minidem.engine.cases import Case

THERE = (
    "create_atoms 1 single -0.05 -0.05 0.02\ncreate_atoms 1 single 0.01 0.01 0.006\n"
    "create_atoms 2 single 0.07 0.07 0.08\nset group all diameter 0.01 density 2500 vx 0.3\n"
)
LABELS = "radius id type {} vx vy vz ix iy iz"
ROWS = (
    (0.004, 7, 2, -0.08, -0.08, 0.0039, 0.1, 0.0, -0.2, 0, 0, 0),
    (0.005, 5, 1, 0.02, 0.0, 0.004, 0.0, 0.4, 0.0, 0, 1, 0),
    (0.005, 2, 2, 0.012, 0.012, 0.006, 0.0, 0.0, 0.1, 0, 0, 2),
    (0.006, 1, 1, -0.05, 0.06, 0.15, 0.0, 0.0, 0.0, -1, 0, 0),
)


def dump(places: str = "x y z", upper: float = 0.2, faces: str = "ff ff ff") -> str:
    """Return a dump of three snapshots, steps 100, 200 and 300; the second one counts."""
    text = ""
    for step in (100, 200, 300):
        rows = [list(row) for row in ROWS]
        for row in rows:
            if step != 200:
                row[3:6] = [0.0, 0.0, 0.001 * step]
            if places.startswith("xs"):
                row[3:6] = [(row[3] + 0.1) / 0.2, (row[4] + 0.1) / 0.2, (row[5] + 0.1) / 0.3]
            if "u" in places:
                row[3:6] = [row[3] + 0.2, row[4], row[5] - 0.6]
        text += f"ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ATOMS\n{len(rows)}\n"
        text += f"ITEM: BOX BOUNDS {faces}\n-0.1 0.1\n-0.1 0.1\n-0.1 {upper}\n"
        text += f"ITEM: ATOMS {LABELS.format(places)} \n"
        text += "".join(" ".join(f"{value:.17g}" for value in row) + " \n" for row in rows)
    return text


def read(
    words: str,
    boundary: str = "f f f",
    before: str = THERE,
    places: str = "x y z",
    upper: float = 0.2,
) -> Case:
    """Return a case in which a dump is read."""
    lines = f"{before}read_dump a.dump 200 {words}\n" + WEIGHT + FLOOR
    return Case(lines, steps=400, boundary=boundary, files={"a.dump": dump(places, upper)})


TOUCHING = (
    "create_atoms 1 single 0.04 0.01 0.006\ncreate_atoms 1 single 0.049 0.01 0.0075\n"
    "create_atoms 1 single 0.0565 0.01 0.013\nset group all diameter 0.01 density 2500 vx 0.3\n"
    "set type 1 vy 0.2\nset atom 5 vy -0.5\n"
)


def purged(before: str = "") -> Case:
    """Return a case in which grains in contact leave, and come again from a dump."""
    return Case(
        THERE + TOUCHING + WEIGHT + FLOOR, steps=200,
        runs="dump w all custom 20 w.dump id type x y z vx vy vz radius\n"
        'dump_modify w format "%d %d %.17g %.17g %.17g %.17g %.17g %.17g %.17g"\n'
        f"run 40\n{before}read_dump w.dump 40 x y z vx vy vz radius box no replace no purge yes "
        "add yes\nset group all density 2500\nrun 200\n",
    )  # fmt: skip


EVERYTHING = "x y z vx vy vz radius"
CASES: dict[str, Case] = {
    "into an empty box": read(f"{EVERYTHING} box no add yes", before=""),
    "density afterwards": Case(
        f"{THERE}read_dump a.dump 200 {EVERYTHING} add yes\nset group all density 2500\n"
        + WEIGHT + FLOOR,
        steps=400, files={"a.dump": dump()},
    ),
    "old ones replaced": read(f"{EVERYTHING} box no"),
    "some fields": read("radius vx z box no"),
    "new ones added": read(f"{EVERYTHING} box no replace no add yes"),
    "without all places": read("x z radius box no replace no add yes"),
    "all purged": read(f"{EVERYTHING} replace no purge yes add yes"),
    "others trimmed": read(f"{EVERYTHING} trim yes"),
    "trimmed only": read("radius replace no trim yes"),
    "another box": read(f"{EVERYTHING} box yes add yes", "p p p", upper=0.12),
    "scaled": read(f"{EVERYTHING} ix iy iz add yes", "p p p", places="xs ys zs"),
    "unwrapped": read(f"{EVERYTHING} ix iy iz add yes", "p p f", places="xu yu zu"),
    "purged in contact": purged(),
    "purged in contact behind others": purged("group some id 1\ndelete_atoms group some\n"),
    "of its own": Case(
        THERE + WEIGHT + FLOOR, steps=200,
        runs="dump w all custom 50 w.dump id type x y z vx vy vz radius\n"
        'dump_modify w format "%d %d %.17g %.17g %.17g %.17g %.17g %.17g %.17g"\n'
        "run 100\nread_dump w.dump 50 x y z vx vy vz radius box no\nrun 200\n",
    ),
}  # fmt: skip
