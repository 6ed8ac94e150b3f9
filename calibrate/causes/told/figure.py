"""One picture that tells the diagnosis without the text around it."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure

from calibrate.causes.judging.probabilities import NONE, UNKNOWN
from calibrate.causes.told.numbers import short, with_unit
from calibrate.causes.told.words import KINDS
from calibrate.shown_figure import shown_figure

__all__ = ["diagnosis_figure"]

_BEFORE: Final = "#b0413e"
_AFTER: Final = "#2a6f97"
_QUIET: Final = "#9aa5b1"
_CAP: Final = 12.0  # standard errors at which bars end
_WIDTH: Final = 125  # letters of the title
_LABEL: Final = 34  # letters of a line of a name
_BAR: Final = 0.36
_MOST: Final = 24  # readings that are drawn, those furthest off
_CAUSES: Final = 10  # that are drawn, the most probable
_FEW: Final = 4  # that are drawn, however improbable
_TOLD: Final = 0.01  # probability from which a cause is drawn


def diagnosis_figure(record: Mapping[str, Any]) -> Figure:
    """Draw residuals before and after, the probable answers, and how strong each cause would be.

    Parameters
    ----------
    record : mapping
        A diagnosis as plain data, with residuals.
    """
    answers = _answers(record)
    rows = max(min(len(record["residuals"]), _MOST), len(answers))
    figure = shown_figure(15.0, 2.2 + _BAR * max(rows, 8))
    figure.patch.set_alpha(1.0)  # its words are dark
    left, middle, right = figure.subplots(1, 3, width_ratios=(1.0, 0.7, 0.9))
    _residual_panel(left, record)
    _share_panel(middle, record, answers)
    _strength_panel(right, record, answers)
    title = KINDS[record["verdict"]].capitalize()
    text = textwrap.fill(record["headline"], _WIDTH)
    figure.suptitle(f"{title}\n{text}", fontsize=12, ha="left", x=0.01)
    return figure


def _answers(record: Mapping[str, Any]) -> list[str]:
    """Return the answers that are drawn, the most probable first."""
    act = _inclusion(record)
    causes = sorted((one["name"] for one in record["candidates"]), key=lambda name: -act[name])
    shown = [name for k, name in enumerate(causes) if k < _FEW or act[name] >= _TOLD][:_CAUSES]
    return sorted([*shown, UNKNOWN, NONE], key=lambda name: -act[name])


def _inclusion(record: Mapping[str, Any]) -> dict[str, float]:
    shares: dict[str, float] = {name: record["probabilities"][name] for name in (UNKNOWN, NONE)}
    return shares | {one["name"]: one["inclusion"] for one in record["candidates"]}


def _title(record: Mapping[str, Any], name: str) -> str:
    """Return what an answer is called."""
    if name == NONE:
        return "nothing is missing"
    if name == UNKNOWN:
        where = max(record["where"], key=record["where"].get, default="")
        place = where.removeprefix(f"{UNKNOWN} ")
        return textwrap.fill(f"something in no library {f'({place})' if place else ''}", _LABEL)
    title = next(one["title"] for one in record["candidates"] if one["name"] == name)
    return textwrap.fill(title, _LABEL)


def _residual_panel(axes: Any, record: Mapping[str, Any]) -> None:
    """Bars of z per reading; what reaches beyond the grey band is more than chance."""
    every = record["residuals"]
    far = sorted(range(len(every)), key=lambda k: -abs(every[k]["z_left_out"]))[:_MOST]
    drawn = sorted(far)
    at = np.arange(len(drawn))
    axes.axvspan(-2.0, 2.0, color="0.93", zorder=0)
    axes.axvline(0.0, color="0.4", lw=0.8)
    after = record["residuals_after"]
    both = 0.5 * _BAR if after else 0.0
    pairs = [(every, _BEFORE, "without any cause", -both)]
    if after:
        pairs.append((after, _AFTER, f"with {' and '.join(record['leading'])}", both))
    for rows, colour, label, shift in pairs:
        z = [rows[k]["z_left_out"] for k in drawn]
        bars = np.clip(z, -_CAP, _CAP)
        axes.barh(at + shift, bars, _BAR if after else 2.0 * _BAR, color=colour, label=label)
        _say_longer(axes, (at + shift).tolist(), z)
    if after:
        axes.legend(fontsize=9, loc="best", frameon=False)
    axes.set_yticks(at, [_words(every[k]["name"]) for k in drawn], fontsize=9)
    axes.invert_yaxis()
    rest = f"; {len(every) - len(drawn)} nearer ones left out" if len(every) > len(drawn) else ""
    axes.set_xlabel(
        "measured minus predicted from all other readings,\n"
        f"in standard errors (grey: chance{rest})"
    )
    axes.set_title("What the simulation gets wrong", fontsize=11, loc="left")


def _say_longer(axes: Any, rows: Sequence[float], z: Sequence[float]) -> None:
    """Write the number into each bar that ends before it."""
    for row, value in zip(rows, z, strict=True):
        if abs(value) > _CAP:
            side = "left" if value < 0.0 else "right"
            end = np.copysign(0.97 * _CAP, value)
            axes.text(
                end, row, f"{value:.0f}", ha=side, va="center", fontsize=8, color="white",
                fontweight="bold",
            )  # fmt: skip


def _share_panel(axes: Any, record: Mapping[str, Any], answers: Sequence[str]) -> None:
    """Probabilities, of causes alone and in pairs."""
    act, alone = _inclusion(record), record["probabilities"]
    at = range(len(answers))
    colours = [_AFTER if name in record["names"] else _QUIET for name in answers]
    axes.barh(at, [act[name] for name in answers], 0.6, color="0.85")
    axes.barh(at, [alone[name] for name in answers], 0.6, color=colours)
    for k, name in enumerate(answers):
        axes.text(act[name] + 0.02, k, f"{act[name]:.2f}", va="center", fontsize=9)
    axes.set_yticks(at, [_title(record, name) for name in answers], fontsize=9)
    axes.set_ylim(len(answers) - 0.5, -0.5)
    axes.set_xlim(0.0, 1.2)
    axes.set_xticks([0.0, 0.5, 1.0])
    left = len(record["candidates"]) - (len(answers) - 2)
    rest = f"\n{left} more causes are less probable" if left else ""
    axes.set_xlabel(f"probability (pale: together with another cause){rest}")
    axes.set_title("What it could be", fontsize=11, loc="left")


def _strength_panel(axes: Any, record: Mapping[str, Any], answers: Sequence[str]) -> None:
    """Each cause on its own scale: possible strengths, what can be seen, what fits."""
    causes = {one["name"]: one for one in record["candidates"]}
    for k, name in enumerate(answers):
        if name in causes:
            _strength(axes, k, causes[name], name in record["names"])
    axes.set_yticks([])
    axes.set_ylim(len(answers) - 0.5, -0.5)
    axes.set_xlim(0.0, 2.15)
    axes.set_xticks([0.0, 0.5, 1.0], ["0", "half", "largest\npossible"])
    axes.set_xlabel(
        "line: 95 % interval if it is the cause\n"
        "green: seen in 8 of 10 studies if nothing else acts"
    )
    axes.set_title("How strong it would be", fontsize=11, loc="left")


def _strength(axes: Any, row: int, one: Mapping[str, Any], named: bool) -> None:
    colour = _AFTER if named else "0.35"
    axes.plot([0.0, 1.0], [row, row], color="0.85", lw=9, solid_capstyle="butt", zorder=1)
    if one["visible"]:
        seen = one["detectable"] / one["limit"]
        axes.plot([seen, 1.0], [row, row], color="#b7d9c0", lw=9, solid_capstyle="butt", zorder=2)
    ends = np.sort(np.abs([one["low_95"], one["high_95"]])) / one["limit"]
    low = ends[0] if one["low_95"] * one["high_95"] > 0.0 else 0.0
    axes.plot([low, ends[1]], [row, row], color=colour, lw=2.4, zorder=3)
    strength = with_unit(short(one["strength"]), one["unit"])
    text = f"{strength} ({short(one['low_95'])} to {short(one['high_95'])})"
    axes.text(1.04, row, text, va="center", fontsize=9)


def _words(name: str) -> str:
    return name.replace("_", " ")
