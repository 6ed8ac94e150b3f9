"""Tables that the kernels read row by row begin where a line of the caches does."""

from __future__ import annotations

import numpy as np
import pytest

from minidem.kernels.columns import ROW
from minidem.world.aligned import LINE, aligned_zeros
from minidem.world.state import State


@pytest.mark.parametrize("kind", [np.float64, np.int64, np.int32, np.uint8])
@pytest.mark.parametrize("shape", [(1,), (7, 3), (1000, 8), (40_000, 6)])
def test_tables_begin_a_line_and_are_zero(shape, kind):
    made = aligned_zeros(shape, kind)
    assert made.ctypes.data % LINE == 0
    assert made.shape == shape
    assert made.dtype == kind
    assert made.flags.c_contiguous
    assert not made.any()


def test_a_particle_is_read_in_one_piece_however_many_come():
    """A row has as many bytes as a line; it would take two if the table began elsewhere."""
    assert ROW * np.dtype(np.float64).itemsize == LINE
    state = State()
    for wanted in (10, 700, 50_000):
        state.reserve(wanted)
        tables = (state.row, state.spin, state.force)
        assert [table.ctypes.data % LINE for table in tables] == [0, 0, 0]
