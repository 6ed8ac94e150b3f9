"""Scripts that LIGGGHTS 3.8.0 begins and either engine continues from the restart file.

``tests/data/minidem/restarts.zip`` has the restart files and what LIGGGHTS makes of them;
``python -m tests.minidem.restarts.continued_cases`` writes it anew.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
import zipfile
from dataclasses import dataclass, replace
from pathlib import Path

from tests.minidem.engine.case_list import PACK, WEIGHT, ball
from tests.minidem.engine.cases import Case, Outcome, outcomes, plate, read, thinned
from tests.minidem.laws.model_list import POUR, values
from tests.minidem.wet.wet_list import EASO, WASHINO, liquid
from tests.paths import DATA

STORED = DATA / "minidem" / "restarts.zip"
BEGUN, AFTER = 2000, 1000
"""Steps before the restart file, and from it on."""
FLOOR = "fix floor all wall/gran model {model} primitive type 2 zplane 0.0\n"
PIPE = "fix pipe all wall/gran model {model} primitive type 1 zcylinder 0.017 0.001 0\n"
MESH = "fix cad all {style} file m.stl type 2 {words}\n"
MOVES = "fix mv all move/mesh mesh cad {motion}\n"
SIDES = "fix plates all wall/gran model {model} mesh n_meshes 1 meshes cad\n"
HERTZ = "hertz tangential history"
ROLLING = f"{HERTZ} rolling_friction epsd2"
TILTED = WEIGHT.replace("0 0 -1", "0.3 0 -1")
BACK = (  # a plate above, to be counted at and to be inserted from
    "fix face all mesh/surface file high.stl type 1\n"
    "fix ins all insert/stream seed 32452867 distributiontemplate pd nparticles 300 "
    "massrate 0.3 insert_every 1500 overlapcheck yes all_in no vel constant 0 0 -1 "
    "insertion_face face\n"
)


@dataclass(frozen=True)
class Continued:
    """A script in two parts.

    Attributes
    ----------
    setup : str
        Lines of both parts.
    particles : str
        Lines of the first part alone, before the walls.
    model : str
        Contact model of pairs; of walls, too, without the bridges of ``easo``.
    steps : int
        Of the first part.
    rtol, boundary, thermo : float, str, str
        As in `Case`.
    again : str
        Lines of the second part alone.
    processes : int
        With how many LIGGGHTS runs the first part, in a file each if more than one.
    """

    setup: str
    particles: str = PACK + POUR
    model: str = ROLLING
    steps: int = BEGUN
    boundary: str = "f f f"
    again: str = ""
    thermo: str = "atoms ke"
    processes: int = 1
    # rounding of forces, 1e-16, grows in collisions; to 4e-12 at most, as seen in `AFTER` steps
    rtol: float = 1e-10

    @property
    def file(self) -> str:
        """Name of the restart file."""
        return "r.restart" if self.processes == 1 else "r.%.restart"

    def parts(self) -> tuple[Case, Case]:
        """Return the script that writes the restart file, and the one that reads it."""
        wall = self.model.replace(EASO, "")
        setup = self.setup.format(model=wall)
        meshes = {"m.stl": plate(0.0, 0.04), "high.stl": plate(0.05, 0.01)}
        first = Case(
            self.particles + setup, model=self.model, meshes=meshes, boundary=self.boundary,
            skin=0.0005, runs=f"run {self.steps}\nwrite_restart {self.file}",
        )  # fmt: skip
        body = setup if "create_atoms" in self.particles else self.particles + setup
        second = replace(first, body=body + self.again, steps=AFTER, runs="", rtol=self.rtol,
                         thermo=self.thermo)  # fmt: skip
        return first, second

    def continued(self) -> str:
        """Return the second script, which takes the box from the restart file."""
        lines = self.parts()[1].script().splitlines()
        at = next(i for i, line in enumerate(lines) if line.startswith("region reg"))
        lines[at : at + 2] = [f"read_restart {self.file}"]
        return "\n".join([*lines, ""])

    def write(self, folder: Path) -> Path:
        """Write the second script and its meshes into a folder; return the script."""
        script = self.parts()[1].write(folder)
        script.write_text(self.continued())
        return script


def grains(model: str, extra: str = "", **more: object) -> Continued:
    """Return a case of thirty grains that fall on a plane and into a pipe."""
    body = values() + liquid() + extra + TILTED + FLOOR + PIPE
    return Continued(body, model=model, **more)  # type: ignore[arg-type]


def on_plate(motion: str, style: str = "mesh/surface", words: str = "") -> Continued:
    """Return a case of grains on a plate that moves."""
    mesh = MESH.format(style=style, words=words) + MOVES.format(motion=motion)
    wear = "fix wear all property/global k_finnie peratomtypepair 2 1e-9 1e-9 1e-9 1e-9\n"
    load = "".join(f" f_cad[{k}]" for k in range(1, 10)) if "stress" in style else ""
    return Continued(values() + wear + TILTED + mesh + SIDES, thermo=f"atoms ke{load}")


CASES: dict[str, Continued] = {
    "history": grains(HERTZ),
    "no history": grains("hertz tangential no_history rolling_friction epsd2"),
    "epsd2": grains(ROLLING),
    "hysteresis": grains("hooke/hysteresis tangential history rolling_friction epsd2"),
    "luding": grains("luding tangential tan_luding rolling_friction luding"),
    "edinburgh": grains("edinburgh tangential history rolling_friction epsd"),
    "thornton_ning": grains(
        "thornton_ning tangential history", "timestep 2e-6\n", steps=20000
    ),
    "easo": grains(f"{HERTZ} {EASO}"),
    "washino": grains(f"hooke tangential history {WASHINO} rolling_friction epsd2"),
    "wiggle": on_plate("wiggle amplitude 0 0 0.001 period 0.015"),
    "rotate, stress and wear": on_plate(
        "rotate origin 0 0.01 0 axis 0 1 0 period 3.", "mesh/surface/stress",
        "wear finnie reference_point 0.01 0 0",
    ),
    "insertion goes on": Continued(
        values() + TILTED + FLOOR + PIPE,
        PACK + POUR.replace("once", "700").replace("region 30", "region 20"),
    ),
    "stream": Continued(values() + WEIGHT + FLOOR, PACK + BACK, steps=2500),
    "passages": Continued(
        values() + WEIGHT + FLOOR
        + "fix face all mesh/surface file high.stl type 1\n"
        "fix mf all massflow/mesh mesh face count once vec_side 0 0 -1\n",
        PACK + POUR.replace("0.001 0.03", "0.03 0.08"),
        thermo="atoms ke f_mf[1] f_mf[2]",
    ),
    "periodic": Continued(
        values() + TILTED + FLOOR, boundary="p p f",
        particles=PACK
        + POUR.replace("-0.015 0.015 -0.015", "0.07 0.1 -0.015").replace("0 0 -0.5", "1 0 -0.5"),
    ),
    "springs and values": Continued(
        values() + WEIGHT + FLOOR
        + "fix spring all spring/self 2.\nfix keep all store/state 0 x vz\n"
        "fix own all property/atom own vector yes no no 1. 2.\n"
        "compute kept all reduce sum f_keep[1] f_keep[2] f_own[1] f_own[2]\n",
        ball(1, "0 0 0.01", "0.5 0.1 0.3") + ball(2, "0.02 0 0.01") + ball(3, "0.03 0.03 0.02"),
        thermo="atoms ke c_kept[1] c_kept[2] c_kept[3] c_kept[4]",
    ),
    "a file per process": replace(grains(ROLLING), processes=2),
}  # fmt: skip


def begin(case: Continued, folder: Path) -> list[Path]:
    """Let LIGGGHTS write the restart files of a case; return them."""
    program = shutil.which("liggghts")
    if program is None:
        msg = "LIGGGHTS is not installed (Debian: apt-get install liggghts)"
        raise FileNotFoundError(msg)
    script = case.parts()[0].write(folder)
    command = [program, "-in", script.name]
    if case.processes > 1:
        mpi = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-np", str(case.processes)]
        command = [*mpi, *command]
    subprocess.run(command, cwd=folder, check=True, capture_output=True)
    return sorted(folder.glob("r.*restart"))


def go_on(case: Continued, folder: Path) -> Outcome:
    """Let LIGGGHTS go on from the restart files that are in a folder."""
    program = str(shutil.which("liggghts"))
    script = case.write(folder)
    subprocess.run([program, "-in", script.name], cwd=folder, check=True, capture_output=True)
    return read(folder)


def load() -> dict[str, Outcome]:
    """Return what LIGGGHTS makes of the stored restart files."""
    with zipfile.ZipFile(STORED) as archive:
        return outcomes(archive.read("outcomes.json"))


def restart_files(name: str, folder: Path) -> list[Path]:
    """Put the stored restart files of a case into a folder; return them."""
    folder.mkdir(parents=True, exist_ok=True)
    found = []
    with zipfile.ZipFile(STORED) as archive:
        for member in archive.namelist():
            case, _, file = member.partition("/")
            if case == name:
                (folder / file).write_bytes(archive.read(member))
                found.append(folder / file)
    return found


def main() -> None:
    """Run all cases with LIGGGHTS and store the restart files and what comes of them."""
    found = {}
    with zipfile.ZipFile(STORED, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, case in CASES.items():
            with tempfile.TemporaryDirectory() as folder:
                for file in begin(case, Path(folder)):
                    archive.writestr(f"{name}/{file.name}", file.read_bytes())
                found[name] = thinned(go_on(case, Path(folder)))
            sys.stdout.write(f"{name}\n")
        archive.writestr("outcomes.json", json.dumps(found))


if __name__ == "__main__":
    main()
