"""One picture that tells the diagnosis without the text around it."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping
from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure

from calibrate.causes.judging.probabilities import NONE, UNKNOWN
from calibrate.causes.told.words import KINDS
from calibrate.shown_figure import shown_figure

__all__ = ["diagnosis_figure"]

_BEFORE: Final = "#b0413e"
_AFTER: Final = "#2a6f97"
_QUIET: Final = "#9aa5b1"
_CAP: Final = 12.0  # standard errors at which bars end
_WIDTH: Final = 125  # letters of the title
_BAR: Final = 0.36


def diagnosis_figure(record: Mapping[str, Any]) -> Figure:
    """Draw residuals before and after, each candidate's strength, and the probabilities.

    Parameters
    ----------
    record : mapping
        A diagnosis as plain data, with residuals.
    """
    rows = max(len(record["residuals"]), len(record["candidates"]) + 2)
    figure = shown_figure(15.0, 2.4 + _BAR * rows)
    figure.patch.set_alpha(1.0)  # its words are dark
    left, middle, right = figure.subplots(1, 3, width_ratios=(1.0, 1.0, 0.6))
    _residual_panel(left, record)
    _strength_panel(middle, record)
    _share_panel(right, record)
    title = KINDS[record["verdict"]].capitalize()
    text = textwrap.fill(record["headline"], _WIDTH)
    figure.suptitle(f"{title}\n{text}", fontsize=11, ha="left", x=0.01)
    return figure


def _residual_panel(axes: Any, record: Mapping[str, Any]) -> None:
    """Bars of z per reading; what reaches beyond the grey band is more than chance."""
    before, after = record["residuals"], record["residuals_after"]
    at = np.arange(len(before))
    axes.axvspan(-2.0, 2.0, color="0.93", zorder=0)
    axes.axvline(0.0, color="0.4", lw=0.8)
    named = f"with {' and '.join(record['leading'])}" if after else ""
    for rows, colour, label, side in (
        (before, _BEFORE, "base model", -1),
        (after, _AFTER, named, 1),
    ):
        if rows:
            z = np.clip([row["z_left_out"] for row in rows], -_CAP, _CAP)
            axes.barh(at + 0.5 * side * _BAR, z, _BAR, color=colour, label=label)
            axes.legend(fontsize=8, loc="best", frameon=False)
    axes.set_yticks(at, [_words(row["name"]) for row in before], fontsize=8)
    axes.invert_yaxis()
    axes.set_xlabel(
        "measured minus predicted from all other readings,\nin standard errors (grey: chance)"
    )
    axes.set_title("What the simulation gets wrong", fontsize=10, loc="left")


def _strength_panel(axes: Any, record: Mapping[str, Any]) -> None:
    """Each candidate on its own scale: possible strengths, what can be seen, what fits."""
    candidates = record["candidates"]
    for k, one in enumerate(candidates):
        colour = _AFTER if one["name"] in record["names"] else _QUIET
        axes.plot([0.0, 1.0], [k, k], color="0.85", lw=7, solid_capstyle="butt", zorder=1)
        if one["visible"]:
            seen = one["detectable"] / one["limit"]
            axes.plot([seen, 1.0], [k, k], color="#cfe3d4", lw=7, solid_capstyle="butt", zorder=2)
        ends = np.sort(np.abs([one["low_95"], one["high_95"]])) / one["limit"]
        low = ends[0] if one["low_95"] * one["high_95"] > 0.0 else 0.0
        axes.plot([low, ends[1]], [k, k], color=colour, lw=2.2, zorder=3)
        text = f"{100 * one['absorbed']:.0f} % imitated"
        text = text if one["visible"] else f"{text}, invisible"
        axes.text(1.02, k, text, va="center", fontsize=8)
    names = [_words(one["name"]) for one in candidates]
    axes.set_yticks(range(len(candidates)), names, fontsize=8)
    axes.set_xlim(0.0, 1.5)
    axes.set_xticks([0.0, 0.5, 1.0], ["0", "half", "largest\npossible"])
    axes.invert_yaxis()
    axes.set_xlabel("size; green: seen in 8 of 10 studies;\nline: 95 % interval if it is the cause")
    axes.set_title("Which causes could explain it", fontsize=10, loc="left")


def _share_panel(axes: Any, record: Mapping[str, Any]) -> None:
    """Probabilities of all answers, in the order of the candidates."""
    shares = record["probabilities"]
    names = [*(one["name"] for one in record["candidates"]), UNKNOWN, NONE]
    colours = [_AFTER if name in record["names"] else _QUIET for name in names]
    alone = [shares[name] for name in names]
    act = {one["name"]: one["inclusion"] for one in record["candidates"]}
    axes.barh(range(len(names)), [act.get(n, shares[n]) for n in names], color="0.85")
    axes.barh(range(len(names)), alone, color=colours)
    axes.set_yticks(range(len(names)), [_words(name) for name in names], fontsize=8)
    axes.invert_yaxis()
    axes.set_xlim(0.0, 1.0)
    axes.set_xlabel("probability (pale: with another cause)")
    axes.set_title("How probable each is", fontsize=10, loc="left")


def _words(name: str) -> str:
    return name.replace("_", " ")
