"""The table of the joint fits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np
import pandas as pd

from benchmarks.peers.joint_fits.fits import FITS
from benchmarks.peers.lines import read_lines

STORED: Final = Path(__file__).with_name("joint_fits.csv")
"""A row for every unknown of the published fits."""


def load_fits(folder: Path | None) -> pd.DataFrame:
    """Return the fits of a campaign's folder, or the stored ones, a row per unknown.

    Raises
    ------
    FileNotFoundError
        If there is no fit yet.
    """
    if folder is None:
        return pd.read_csv(STORED)
    lines = read_lines(folder / FITS)
    if not lines:
        msg = f"{folder / FITS}: no fits yet; python -m benchmarks.peers joint {folder}"
        raise FileNotFoundError(msg)
    return with_expected(lines)


def with_expected(rows: Sequence[Mapping[str, Any]]) -> pd.DataFrame:
    """Return fits as a table, with how far each unknown was narrowed.

    Returns
    -------
    DataFrame
        The columns of `fits.fit_set` without ``halves``; narrowed: joint sd over that of the
        better half; expected: the same for normal distributions of this unknown alone, whose
        inverse variances add up, less that of what both halves know; 1 where one half has it.
    """
    table = pd.DataFrame(rows).drop_duplicates(["kind", "number", "parameter", "owner"])
    halves = [np.asarray(one) for one in table["halves"]]
    table["narrowed"] = table["sd"] / [one.min() for one in halves]
    twice = [(len(one) - 1) * sd**-2.0 for one, sd in zip(halves, table["common"], strict=True)]
    added = [np.sum(one**-2.0) - less for one, less in zip(halves, twice, strict=True)]
    # Halves that disagree with what both know can leave less than nothing.
    table["expected"] = np.maximum(added, 0.0) ** -0.5 / [one.min() for one in halves]
    return table.drop(columns=["halves", "common", "last"], errors="ignore")


def summary(table: pd.DataFrame) -> pd.DataFrame:
    """Return a row per kind for its shared and its other unknowns.

    Returns
    -------
    DataFrame
        kind, shared, sets, unknowns; covered: share of 90 % intervals that hold the truth; error:
        root mean square of the posterior mean, sd and width as parts of the range; medians of
        narrowed and expected; runs and particle_steps of one set.
    """
    grouped = table.groupby(["kind", "shared"])
    return grouped.agg(
        sets=("number", "nunique"),
        unknowns=("covered", "size"),
        covered=("covered", "mean"),
        error=("error", lambda e: float(np.sqrt(np.mean(np.square(e))))),
        sd=("sd", "mean"),
        width=("width", "mean"),
        narrowed=("narrowed", "median"),
        expected=("expected", "median"),
        runs=("runs", "mean"),
        particle_steps=("particle_steps", "mean"),
    ).reset_index()


def print_fits(table: pd.DataFrame, *, store: bool = False) -> None:
    """Print the summary as Markdown, and write the rows beside the program where asked."""
    print("| fit | unknowns | sets | covered | error | sd | sd over better half | expected | "
          "runs | particle-steps |")  # fmt: skip
    print("|---|---|---|---|---|---|---|---|---|---|")
    for row in summary(table).itertuples():
        what = "shared" if row.shared else "of one half"
        print(
            f"| {row.kind} | {row.unknowns} {what} | {row.sets} | {row.covered:.0%} "
            f"| {row.error:.3f} | {row.sd:.3f} | {row.narrowed:.2f} | {row.expected:.2f} "
            f"| {row.runs:.0f} | {row.particle_steps:.2g} |"
        )
    if store:
        table.to_csv(STORED, index=False, float_format="%.6g")
