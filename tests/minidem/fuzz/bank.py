"""Valid scripts with all words, made small, and the files beside them: what is mutated."""

from __future__ import annotations

import re
import struct
from functools import lru_cache
from itertools import chain

from tests.minidem.engine import case_list
from tests.minidem.engine.cases import Case, plate, stl_text
from tests.minidem.laws import model_list
from tests.minidem.motion.dumped_cases import dump
from tests.minidem.motion.region_cases import vtk
from tests.minidem.motion.stored import LISTS, cases
from tests.minidem.output import (
    scenes,
    test_arrangement,
    test_averages,
    test_contacts,
    test_dumps,
    test_euler,
    test_mesh_dumps,
    test_spatial,
    test_write,
)
from tests.minidem.script.test_command import FULL
from tests.minidem.script.test_data_file import GOOD
from tests.minidem.script.test_values import FILES, PRINTS

__all__ = ["FOLDER", "scripts"]

_HUGE = 10**12
_BINARY = b"binary".ljust(80, b"\0") + struct.pack("<I12fH", 1, *range(12), 0)
_READS = """atom_style granular
boundary f f p
newton off
communicate single vel yes
read_data good.data
fix m1 all property/global youngsModulus peratomtype 5e6
fix m2 all property/global poissonsRatio peratomtype 0.3
fix m3 all property/global coefficientRestitution peratomtypepair 1 0.5
fix m4 all property/global coefficientFriction peratomtypepair 1 0.5
pair_style gran model hertz tangential history
pair_coeff * *
timestep 1e-6
neighbor 0.01 bin
write_data w_*.data
write_restart r.1
variable t atomfile atoms.txt
variable u atom v_t*2
displace_atoms all move 0.01 0 0
read_dump good.dump 200 vx radius box no
set group all vx v_u
compute c all property/atom x v_u
dump d all custom 1 d.* id x c_c[1] v_u
info all
thermo_log values.txt
run 2
clear
read_restart r.1
run 1
"""
FOLDER: dict[str, bytes] = {
    **{name: text.encode() for name, text in FILES.items()},
    "m.stl": stl_text(plate()).encode(),
    "b.stl": _BINARY,
    "lie.stl": _BINARY[:80] + struct.pack("<I", 2**32 - 1) + _BINARY[84:],
    "cut.stl": _BINARY[:-7],
    "m.vtk": vtk().encode(),
    "lie.vtk": vtk().replace("POINTS 8", f"POINTS {_HUGE}").encode(),
    "cells.vtk": vtk().replace("CELLS 5 25", f"CELLS {_HUGE} {5 * _HUGE}").encode(),
    "types.vtk": vtk().replace("CELL_TYPES 5", f"CELL_TYPES {_HUGE}").encode(),
    "good.data": GOOD.encode(),
    "good.dump": dump().encode(),
    "lie.data": GOOD.replace("2 atoms", f"{_HUGE} atoms").encode(),
    "kinds.data": GOOD.replace("1 atom types", f"{_HUGE} atom types").encode(),
    "types.data": GOOD.replace("1 atom types", "100000000 atom types").encode(),
    "atoms.txt": b"# two sets\n2\n1 0.5\n2 -1e3\n\n1\n1 7\n",
    "lie.txt": f"{_HUGE}\n1 0.5\n".encode(),
    "r.lie": b"minidem restart 4\n" + struct.pack("<QQ", 2**63, 2**40) + b"\0" * 64,
    "r.foreign": b"LIGGGHTS RESTART\0" + struct.pack("<iid", 4, 2**31 - 1, 1e300),
    "part.s": b"variable p equal 1\nprint $p\n",
    "itself.s": b"include itself.s\n",
}
"""Files of every case by name; some have headers that lie."""
_RUN = re.compile(r"^(\s*run\s+)\d+", re.MULTILINE)
_MANY = re.compile(r"(particles_in_region|nparticles|particles) +\d+")
_LATTICE = re.compile(r"(lattice \w+) 0\.01\d?(?= |$)", re.MULTILINE)


def small(script: str) -> str:
    """Return a script with few steps and few particles."""
    script = _RUN.sub(lambda found: found[1] + "2", script)
    script = script.replace("delete_atoms overlap 0.00", "delete_atoms overlap 0.000")
    return _LATTICE.sub(r"\1 0.05", _MANY.sub(r"\1 4", script))


@lru_cache
def scripts() -> tuple[str, ...]:
    """Return the scripts."""
    motion = chain.from_iterable(cases(name).values() for name in LISTS)
    models = _cases(model_list)
    found = [case.script() for case in (*_cases(case_list), *motion, *models)]
    found += [scenes.scene(lines + "run 2\n", head) for head, lines in _outputs()]
    found.append(test_dumps.HEAD + test_dumps.DUMPS + "run 2\n")
    found += [test_arrangement.HEAD + test_arrangement.LINES + "run 2\n"]
    found += [text for text, _ in PRINTS.values()]
    found += [FULL, _READS]
    return tuple(map(small, found))


def _outputs() -> list[tuple[str, str]]:
    """Return heads of scripts and lines of output."""
    plain = [
        test_averages.LINES, test_averages.CORRELATIONS, test_arrangement.HISTOGRAMS,
        test_euler.LINES, test_mesh_dumps.DUMPS, test_write.LINES,
    ]  # fmt: skip
    found = [(scenes.HEAD, lines) for lines in plain]
    found += [(test_contacts.HEAD, lines) for lines in (test_contacts.LINES, test_contacts.PARTS)]
    return [*found, (test_spatial.HEAD, test_spatial.LINES)]


def _cases(module: object) -> list[Case]:
    """Return all cases of a module."""
    tables = [one for one in vars(module).values() if isinstance(one, dict)]
    return [case for table in tables for case in table.values() if isinstance(case, Case)]
