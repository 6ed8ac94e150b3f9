"""One picture that tells the diagnosis without the text around it."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from calibrate.diagnose.pipeline import Diagnosis
from calibrate.report.diagnosis_words import KINDS, headline

_BEFORE, _AFTER, _QUIET = "#b0413e", "#2a6f97", "#9aa5b1"
_CAP = 12.0


def diagnosis_figure(found: Diagnosis) -> bytes:
    """Draw residuals before and after, and every candidate's size against what can be seen.

    Returns
    -------
    bytes
        PNG.
    """
    rows = max(len(found.residuals), len(found.problem.candidates) + 2)
    figure = Figure(figsize=(12.5, 2.4 + 0.36 * rows), layout="constrained")
    FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2, width_ratios=(1.0, 1.15))
    _residual_panel(left, found)
    _candidate_panel(right, found)
    title = f"{KINDS[found.verdict.kind].capitalize()}"
    figure.suptitle(f"{title}\n{_wrapped(headline(found))}", fontsize=11, ha="left", x=0.01)
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=130)
    return buffer.getvalue()


def _wrapped(text: str, width: int = 125) -> str:
    words, lines = text.split(), [""]
    for word in words:
        if len(lines[-1]) + len(word) > width:
            lines.append("")
        lines[-1] = f"{lines[-1]} {word}".strip()
    return "\n".join(lines)


def _residual_panel(axes: Any, found: Diagnosis) -> None:
    """Bars of z per observable; what reaches beyond the grey band is more than chance."""
    names = [r.name.replace("_", " ").replace(".", ": ") for r in found.residuals]
    at = np.arange(len(names))
    axes.axvspan(-2.0, 2.0, color="0.93", zorder=0)
    axes.axvline(0.0, color="0.4", lw=0.8)
    before = np.clip([r.z_left_out for r in found.residuals], -_CAP, _CAP)
    axes.barh(at - 0.19, before, 0.36, color=_BEFORE, label="base model")
    if found.after:
        after = np.clip([r.z_left_out for r in found.after], -_CAP, _CAP)
        label = f"with {found.verdict.names[0]}"
        axes.barh(at + 0.19, after, 0.36, color=_AFTER, label=label)
    axes.set_yticks(at, names, fontsize=8)
    axes.invert_yaxis()
    axes.set_xlabel(
        "measured minus predicted from all other values,\nin standard errors (grey: chance)"
    )
    axes.set_title("What the simulation gets wrong", fontsize=10, loc="left")
    axes.legend(fontsize=8, loc="best", frameon=False)


def _candidate_panel(axes: Any, found: Diagnosis) -> None:
    """Each candidate on its own scale: physical range, what can be seen, what was found."""
    candidates = found.problem.candidates
    named = set(found.verdict.names)
    for k, one in enumerate(candidates):
        sight = found.absorption.of(one.name)
        colour = _AFTER if one.name in named else _QUIET
        limit = sight.limit
        axes.plot([0.0, 1.0], [k, k], color="0.85", lw=7, solid_capstyle="butt", zorder=1)
        seen = min(sight.detectable / limit, 1.0)
        axes.plot([seen, 1.0], [k, k], color="#cfe3d4", lw=7, solid_capstyle="butt", zorder=2)
        suspect = next((s for s in found.verdict.suspects if s.candidate == one.name), None)
        if suspect is not None:
            axes.plot(abs(suspect.strength) / limit, k, "o", color=colour, ms=8, zorder=4)
        if one.name in found.verdict.intervals:
            low, high = found.verdict.intervals[one.name].interval95
            ends = sorted((abs(low), abs(high))) if low * high > 0.0 else [0.0, max(-low, high)]
            axes.plot(np.array(ends) / limit, [k, k], color=colour, lw=2.2, zorder=3)
        text = f"{100 * sight.absorbed:.0f} % imitated\nby parameters"
        if not sight.visible:
            text += ", invisible"
        axes.text(1.02, k, text, va="center", fontsize=8)
    axes.set_yticks(range(len(candidates)), [_label(found, c.name) for c in candidates], fontsize=8)
    axes.set_xlim(0.0, 1.42)
    axes.set_xticks([0.0, 0.5, 1.0], ["0", "half", "largest\nplausible"])
    axes.invert_yaxis()
    axes.set_xlabel(
        "strength; green: seen in 8 of 10 studies;\ndot and line: fitted, 95 % interval"
    )
    axes.set_title("Which causes could explain it", fontsize=10, loc="left")


def _label(found: Diagnosis, name: str) -> str:
    limit = found.absorption.of(name).limit
    mark = " ◄" if name in found.verdict.names else ""
    return f"{name.replace('_', ' ')}\n(up to {limit:g}){mark}"
