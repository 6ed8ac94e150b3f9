"""The table and the figure of the comparison."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Final

import matplotlib.pyplot as plt
import pandas as pd

from benchmarks.peers.apparatus import RANGES
from benchmarks.peers.campaign import ANSWERS
from benchmarks.peers.lines import read_lines
from benchmarks.peers.scores import common_truths, paired, score_table, summary

STORED: Final = Path(__file__).with_name("scores.csv")
"""Scores of every answer of the published comparison."""
REFERENCE: Final = ("decalioc", 100)
"""Method and budget of the paper."""
GOAL: Final = (REFERENCE, ("ours-joint", 20))
"""What is to be reached, and with which part of its particle-steps."""
_PANELS: Final = (
    ("error", "parameter error (rms, part of the range)"),
    ("prediction", "prediction error (rms, standard errors)"),
    ("covered", "90 % intervals that hold the truth"),
)


def load_scores(folder: Path | None) -> pd.DataFrame:
    """Return the scores of a campaign's folder, or the stored ones.

    Raises
    ------
    FileNotFoundError
        If there is no answer yet.
    """
    if folder is None:
        return pd.read_csv(STORED)
    lines = read_lines(folder / ANSWERS)
    if not lines:
        msg = f"{folder / ANSWERS}: no answers yet; python -m benchmarks.peers run {folder}"
        raise FileNotFoundError(msg)
    return score_table(lines)


def print_report(scores: pd.DataFrame, methods: Sequence[str], figure: Path | None) -> None:
    """Print the table over truths that all methods have done, and draw it where asked."""
    rows = summary(common_truths(scores, methods))
    print(as_markdown(rows))
    print("\nThe goal, over the truths that both have:\n")
    print(as_markdown(paired(scores, GOAL)))
    print(_by_parameter(common_truths(scores, methods)))
    if figure is not None:
        draw(rows, figure)


def as_markdown(rows: pd.DataFrame) -> str:
    """Return the table as Markdown."""
    lines = [
        "| method | vectors | particle-steps | parameter error | prediction error | median |"
        " covered | width | failed runs | truths |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    for row in rows.itertuples():
        intervals = "- | -" if pd.isna(row.covered) else f"{row.covered:.0%} | {row.width:.2f}"
        lines.append(
            f"| {row.method} | {row.budget} | {row.particle_steps:.2g} "
            f"| {_with_error(row.error, row.error_se, 3)} "
            f"| {_with_error(row.prediction, row.prediction_se, 1)} "
            f"| {row.prediction_median:.1f} | {intervals} "
            f"| {row.failed:.1%} | {row.truths} |"
        )
    return "\n".join(lines)


def _with_error(value: float, error: float, digits: int) -> str:
    """Return a value with its standard error, which one truth does not tell."""
    shown = f"{value:.{digits}f}"
    return shown if pd.isna(error) else f"{shown} ± {error:.{digits}f}"


def _by_parameter(scores: pd.DataFrame) -> str:
    """Return the rms error of each parameter at the largest budget of every method."""
    lines = [f"\n| method | vectors | {' | '.join(RANGES)} |", "|" + "---|" * (2 + len(RANGES))]
    for method, group in scores.groupby("method"):
        last = group[group["budget"] == group["budget"].max()]
        errors = [f"{(last[f'error_{name}'] ** 2).mean() ** 0.5:.2f}" for name in RANGES]
        lines.append(f"| {method} | {last['budget'].max()} | {' | '.join(errors)} |")
    return "\n".join(lines)


def draw(rows: pd.DataFrame, target: Path) -> None:
    """Draw errors and coverage against particle-steps, one line per method."""
    figure, axes = plt.subplots(1, len(_PANELS), figsize=(13.0, 4.2), layout="constrained")
    shown = rows[rows["particle_steps"] > 0.0]
    for panel, (column, label) in zip(axes, _PANELS, strict=True):
        for method, group in shown.groupby("method"):
            bars = group.get(f"{column}_se")
            panel.errorbar(
                group["particle_steps"], group[column], yerr=bars, marker="o", label=method
            )
        panel.set(xscale="log", xlabel="particle-steps of one calibration", ylabel=label)
        _mark(panel, rows, column)
    if len(shown):
        axes[0].legend(fontsize="small")
    figure.savefig(target, dpi=110)
    plt.close(figure)


def _mark(panel: plt.Axes, rows: pd.DataFrame, column: str) -> None:
    """Draw what the paper's recipe reaches, or the wanted coverage."""
    if column == "covered":
        panel.axhspan(0.80, 0.97, color="0.9")
        panel.set_ylim(0.0, 1.02)
        return
    method, budget = REFERENCE
    paper = rows[(rows["method"] == method) & (rows["budget"] == budget)][column]
    panel.set_ylim(bottom=0.0)
    if len(paper):
        panel.axhline(float(paper.iloc[0]), color="0.5", linewidth=0.8, linestyle="--")
