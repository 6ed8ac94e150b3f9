"""The fast formatting of many numbers equals C's formats to the last character."""

from __future__ import annotations

import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from minidem.output.text.fast import WORTHWHILE, number_lines, precision_of
from minidem.output.text.table import format_rows
from minidem.output.text.vtk import particle_file


def plain(values, digits: int) -> str:
    return "".join(f"{value:.{digits}g} \n" for value in values)


@pytest.mark.parametrize("digits", [6, 11])
def test_numbers_of_all_sizes(rng, digits):
    """Random bits cover all exponents; decimal fractions and halves hit ties."""
    bits = rng.integers(-(2**63), 2**63 - 1, 20_000).view(np.float64)
    edges = 10.0 ** np.arange(-290, 300)
    values = np.concatenate(
        [
            bits,
            np.round(rng.normal(size=20_000) * 100.0, 4),
            rng.integers(-(10**8), 10**8, 20_000) / 8.0,
            rng.integers(-(10**13), 10**13, 20_000) / 2.0,
            edges,
            np.nextafter(edges, 0.0),
            9.999995 * edges,
            [0.0, -0.0, np.inf, -np.inf, np.nan, 5e-324, 1e-4, 1e-5, 99999.5, 999999.5, 1e5, 1e6],
        ]
    )
    assert number_lines(values, np.array([digits]), 1) == plain(values.tolist(), digits)


@settings(deadline=60_000)  # the first call may compile the kernel
@given(st.lists(st.floats(), max_size=20), st.integers(1, 5), st.sampled_from([6, 11]))
def test_any_numbers_on_lines_of_any_length(numbers, per_line, digits):
    text = "".join(
        f"{number:.{digits}g} " + ("\n" if (i + 1) % per_line == 0 else "")
        for i, number in enumerate(numbers)
    )
    assert number_lines(np.array(numbers, dtype=float), np.array([digits]), per_line) == text


def test_whole_numbers_and_mixed_columns(rng):
    count = WORTHWHILE
    ids = rng.integers(-(2**40), 2**40, count)
    x = rng.normal(size=count)
    text = format_rows([ids, x, ids * 0], ["%d", "%g", "%d"])
    assert text == "".join(f"{i} {v:g} 0 \n" for i, v in zip(ids, x, strict=True))
    assert precision_of(["%d", "%.3f"]) is None


def test_large_vtk_file_equals_its_small_parts(rng):
    """The kernel and Python's formatting give the same file."""
    count = 900
    names = ("x", "y", "z", "vx", "vy", "vz", "radius")
    columns = [("id", np.arange(count))] + [(name, rng.normal(size=count)) for name in names]
    text = particle_file(columns)
    speeds = np.stack([values for _, values in columns[4:7]], axis=1).ravel()
    lines = [speeds[i : i + 9] for i in range(0, len(speeds), 9)]
    body = "".join("".join(f"{v:.11g} " for v in line) + "\n" for line in lines) + "\n"
    assert f"v 3 {count} double\n{body}radius" in text


def test_a_million_numbers_take_little_time(rng):
    """Dumping must not dominate a run: 0.1 s on the machine of development, ten times allowed."""
    values = rng.normal(size=1_000_000)
    number_lines(values[:10], np.array([6]), 10)
    start = time.process_time()
    number_lines(values, np.array([6]), 10)
    assert time.process_time() - start < 1.0
