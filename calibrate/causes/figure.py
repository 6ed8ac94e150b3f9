"""One picture that tells the diagnosis without the text around it."""

from __future__ import annotations

import textwrap
from typing import Any, Final

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from calibrate.causes.diagnosis import Diagnosis
from calibrate.causes.verdict import NONE, UNKNOWN
from calibrate.causes.words import KINDS, headline

__all__ = ["diagnosis_figure"]

_BEFORE: Final = "#b0413e"
_AFTER: Final = "#2a6f97"
_QUIET: Final = "#9aa5b1"
_CAP: Final = 12.0  # standard errors at which bars end
_WIDTH: Final = 125  # letters of the title
_BAR: Final = 0.36


def diagnosis_figure(found: Diagnosis) -> Figure:
    """Draw residuals before and after, each candidate's strength, and the probabilities.

    Parameters
    ----------
    found : Diagnosis
        With residuals.
    """
    rows = max(len(found.residuals), len(found.board.candidates) + 2)
    figure = Figure(figsize=(15.0, 2.4 + _BAR * rows), layout="constrained")
    FigureCanvasAgg(figure)
    left, middle, right = figure.subplots(1, 3, width_ratios=(1.0, 1.0, 0.6))
    _residual_panel(left, found)
    _strength_panel(middle, found)
    _share_panel(right, found)
    title = KINDS[found.verdict.kind].capitalize()
    text = textwrap.fill(headline(found), _WIDTH)
    figure.suptitle(f"{title}\n{text}", fontsize=11, ha="left", x=0.01)
    return figure


def _residual_panel(axes: Any, found: Diagnosis) -> None:
    """Bars of z per reading; what reaches beyond the grey band is more than chance."""
    at = np.arange(len(found.residuals))
    axes.axvspan(-2.0, 2.0, color="0.93", zorder=0)
    axes.axvline(0.0, color="0.4", lw=0.8)
    shown = ((found.residuals, _BEFORE, "base model", -1), (found.after, _AFTER, "named cause", 1))
    for rows, colour, label, side in shown:
        if rows:
            z = np.clip([one.z_left_out for one in rows], -_CAP, _CAP)
            axes.barh(at + 0.5 * side * _BAR, z, _BAR, color=colour, label=label)
            axes.legend(fontsize=8, loc="best", frameon=False)
    axes.set_yticks(at, [one.name.replace("_", " ") for one in found.residuals], fontsize=8)
    axes.invert_yaxis()
    axes.set_xlabel(
        "measured minus predicted from all other readings,\nin standard errors (grey: chance)"
    )
    axes.set_title("What the simulation gets wrong", fontsize=10, loc="left")


def _strength_panel(axes: Any, found: Diagnosis) -> None:
    """Each candidate on its own scale: possible strengths, what can be seen, what fits."""
    candidates = found.board.candidates
    for k, one in enumerate(candidates):
        sight = found.visibility.of(one.name)
        colour = _AFTER if one.name in found.verdict.names else _QUIET
        axes.plot([0.0, 1.0], [k, k], color="0.85", lw=7, solid_capstyle="butt", zorder=1)
        seen = min(sight.detectable / sight.limit, 1.0)
        axes.plot([seen, 1.0], [k, k], color="#cfe3d4", lw=7, solid_capstyle="butt", zorder=2)
        span = found.interval(one.name)
        ends = sorted((abs(span.low), abs(span.high)))
        low = ends[0] if span.low * span.high > 0.0 else 0.0
        axes.plot(np.array([low, ends[1]]) / sight.limit, [k, k], color=colour, lw=2.2, zorder=3)
        text = f"{100 * sight.absorbed:.0f} % imitated"
        axes.text(1.02, k, text if sight.visible else f"{text}, invisible", va="center", fontsize=8)
    names = [one.name.replace("_", " ") for one in candidates]
    axes.set_yticks(range(len(candidates)), names, fontsize=8)
    axes.set_xlim(0.0, 1.5)
    axes.set_xticks([0.0, 0.5, 1.0], ["0", "half", "largest\npossible"])
    axes.invert_yaxis()
    axes.set_xlabel("size; green: seen in 8 of 10 studies;\nline: 95 % interval if it is the cause")
    axes.set_title("Which causes could explain it", fontsize=10, loc="left")


def _share_panel(axes: Any, found: Diagnosis) -> None:
    """Probabilities of all answers, in the order of the candidates."""
    shares = found.verdict.probabilities
    names = [*(one.name for one in found.board.candidates), UNKNOWN, NONE]
    colours = [_AFTER if name in found.verdict.names else _QUIET for name in names]
    axes.barh(range(len(names)), [shares[name] for name in names], color=colours)
    axes.set_yticks(range(len(names)), [name.replace("_", " ") for name in names], fontsize=8)
    axes.invert_yaxis()
    axes.set_xlim(0.0, 1.0)
    axes.set_xlabel("probability")
    axes.set_title("How probable each is", fontsize=10, loc="left")
