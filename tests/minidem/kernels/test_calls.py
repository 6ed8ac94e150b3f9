"""Calls inside of machine code, and arrays that are handed to it."""

from __future__ import annotations

import llvmlite.binding as llvm
import numpy as np
import pytest

from minidem.kernels.machine import build, native

MODULE = """
define internal i64 @inside(i64 %used, i64 %idle) noinline {
  ret i64 %used
}
define i64 @outside(i64 %x) {
  %r = call i64 @inside(i64 %x, i64 7)
  ret i64 %r
}
"""


def test_calls_hand_over_only_what_is_looked_at():
    module = llvm.parse_assembly(MODULE)
    build._shorten(module)
    assert "%used" in str(module)
    assert "%idle" not in str(module)


@pytest.mark.parametrize(
    "value", [np.zeros((3, 2)), np.zeros(0), np.broadcast_to(np.zeros(4), (4,)), np.zeros(5)[2:]]
)
def test_arrays_begin_where_numpy_says(value):
    """Writable, empty, read-only ones and parts of others."""
    assert native._address(value) == value.__array_interface__["data"][0]
