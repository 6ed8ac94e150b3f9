"""The loop of the extended contact laws has the base physics: reference trajectories of LIGGGHTS.

Restitution is made to fall above an impact speed that nothing reaches. So every contact goes
through the extended code, and the result must be that of LIGGGHTS to the last digits all the same.
"""

from __future__ import annotations

import re
import shutil

import numpy as np
import pytest

from minidem import run_script
from minidem.kernels.columns import SLOWS
from minidem.kernels.contact.records import Switches
from tests.minidem.engine.test_golden import QUANTITIES, RTOL, read_dump
from tests.paths import DATA

CASES = (
    "b_oblique_plane", "c_pairs_cdt", "c_pairs_epsd", "c_pairs_epsd2", "c_pairs_hertz",
    "c_pairs_tdampoff_limit", "g_stl_features", "i_plate_rotate", "j_conveyor_surface_vel",
    "k_mesh_sjkr2", "k_wall_sjkr", "m_zcylinder", "u_hooke", "v_sjkr_tangential_reduce",
    "v_torsion_on_cdt",
)  # fmt: skip
"""One of each contact model and kind of wall."""
WORDS = " velocityRestitution on"
VALUES = """fix e1 all property/global restitutionExponent peratomtypepair {n} {ones}
fix e2 all property/global restitutionVelocity scalar 1e6
pair_coeff"""


def extended(text: str) -> str:
    """Return a script with the extension on in its pair style and in every wall."""
    types = int(re.search(r"^create_box (\d+)", text, re.M)[1])
    values = VALUES.format(n=types, ones=" ".join(["0.25"] * types**2))
    text = re.sub(r"^(pair_style .*|fix \S+ all wall/gran .*)$", rf"\1{WORDS}", text, flags=re.M)
    return re.sub(r"^pair_coeff", values, text, flags=re.M)


@pytest.mark.parametrize("name", CASES)
def test_trajectory_is_still_that_of_liggghts(name, tmp_path):
    assert Switches._fields[SLOWS] == "velocity_restitution"
    case = DATA / "golden" / name
    for stl in case.glob("*.stl"):
        shutil.copy(stl, tmp_path)
    text = extended((case / "in.case").read_text())
    assert text.count(WORDS) >= 1
    (tmp_path / "in.case").write_text(text)
    run_script(tmp_path / "in.case", root=tmp_path)
    wanted = np.genfromtxt(case / "ref.csv", delimiter=",", skip_header=1)
    found = read_dump(tmp_path / "traj.dump")
    found = found[np.isin(found[:, 0], wanted[:, 0])]
    np.testing.assert_array_equal(found[:, :3], wanted[:, :3])
    for what, columns in QUANTITIES.items():
        size = np.abs(wanted[:, columns]).max()
        error = np.abs(found[:, columns] - wanted[:, columns]).max()
        assert error <= max(RTOL * size, 1e-18), f"{what}: off by {error:.2e} of {size:.2e}"
