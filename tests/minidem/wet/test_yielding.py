"""Contacts with ``thornton_ning`` tell what LIGGGHTS 3.8.0 tells of them."""

from __future__ import annotations

import numpy as np
import pytest

from minidem import run_script
from tests.minidem.wet import yielding

STORED = np.loadtxt(yielding.STORED, delimiter=",")
NECK, PARTED, YIELDED = 9, 11, 13  # columns, with that of the step


def compare(found: np.ndarray, rtol: float) -> None:
    """Compare columns, each with its largest number; those of sliding with that of all three."""
    scale = np.abs(STORED).max(axis=0)
    scale[16:19] = scale[16:19].max()
    assert found.shape == STORED.shape
    assert (np.abs(found - STORED) <= rtol * scale).all()


def test_what_contacts_keep_is_what_liggghts_keeps(tmp_path):
    run_script(yielding.case().write(tmp_path), root=tmp_path)
    # rounding of forces, 1e-16, and what it grows to in contacts of some hundred steps
    compare(yielding.history(tmp_path), 1e-10)


def test_the_stored_contacts_go_through_all_stages():
    for column in (NECK, PARTED, YIELDED):
        assert set(STORED[:, column]) == {0.0, 1.0}
    assert (STORED[:, 15] < 0.0).any()  # the pull-off force of one that is unloaded
    # one that was parted and is held again keeps where it was parted
    assert ((STORED[:, PARTED] == 0.0) & (STORED[:, 10] != 0.0)).any()


@pytest.mark.liggghts
def test_stored_numbers_are_those_of_liggghts(tmp_path):
    # the same program on the same kind of machine: compilers may differ in the last digits
    compare(yielding.of_liggghts(tmp_path), 1e-12)
