"""Contours of the emulators for each particle, as the paper's Figs. B.15 to B.17."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from benchmarks.paper import sources
from benchmarks.paper.held_out import published
from calibrate.inference.problem import Place
from calibrate.questions.core.problem import inputs_at, place_name, unknown_at
from calibrate.questions.joint.result import JointResult
from calibrate.scales import backward
from calibrate.study.places import Place as Where

SIDE = 41
LEVELS = 9
INK, OURS, PAPER = "#4a4f57", "#2a7fb8", "#d1495b"
WALLS = {"steel": "-", "alumina": "--"}
SYMBOLS = {
    "mu_pp": r"$\mu_\mathrm{pp}$", "mu_roll_pp": r"$\mu_\mathrm{R,pp}$",
    "mu_pw": r"$\mu_\mathrm{pw}$", "mu_roll_pw": r"$\mu_\mathrm{R,pw}$",
    "e_pp": r"$e_\mathrm{pp}$", "e_pw": r"$e_\mathrm{pw}$",
}  # fmt: skip


@dataclass(frozen=True)
class Panel:
    """One panel: an observable over two parameters, and where it was measured.

    Attributes
    ----------
    title, experiment, observable, unit, x, y : str
    walls : tuple of str
        Surfaces whose measured value is drawn.
    """

    title: str
    experiment: str
    observable: str
    unit: str
    x: str
    y: str
    walls: tuple[str, ...]


PANELS = (
    Panel("angle of repose, glued", "heap", "angle_deg", "deg", "mu_pp", "mu_roll_pp", ("glued",)),
    Panel("conveyor, glued", "conveyor", "t100_s", "s", "mu_pp", "mu_roll_pp", ("glued",)),
    Panel("angle of repose, flat", "heap", "angle_deg", "deg", "mu_pw", "mu_roll_pw",
          ("steel", "alumina")),
    Panel("conveyor, flat", "conveyor", "t100_s", "s", "mu_pw", "mu_roll_pw",
          ("steel", "alumina")),
    Panel("box 1", "plate_impact", "m1_g", "g", "e_pp", "e_pw", ("steel", "alumina")),
    Panel("box 2", "plate_impact", "m2_g", "g", "e_pp", "e_pw", ("steel", "alumina")),
    Panel("box 3", "plate_impact", "m3_g", "g", "e_pp", "e_pw", ("steel", "alumina")),
    Panel("box 4", "plate_impact", "m4_g", "g", "e_pp", "e_pw", ("steel", "alumina")),
)  # fmt: skip


def _seen(result: JointResult, where: Where) -> Place | None:
    return next((p for p in result.problem.places if p.name == place_name(where)), None)


def _field(
    result: JointResult, panel: Panel, where: Where, place: Place
) -> tuple[np.ndarray, np.ndarray, np.ndarray, float, list[float]]:
    """Return both axes, the emulator's mean over them, what was measured and our values.

    All other unknowns have their best values.
    """
    names, best = result.posterior.names, result.posterior.best
    keys = [unknown_at(result.study, name, where) for name in (panel.x, panel.y)]
    columns = [names.index(key) for key in keys if key is not None]
    spans = [result.problem.space.priors[k] for k in columns]
    x, y = (np.linspace(one.low, one.high, SIDE) for one in spans)
    values = np.tile(best, (SIDE * SIDE, 1))
    values[:, columns[0]], values[:, columns[1]] = (v.ravel() for v in np.meshgrid(x, y))
    target = next(
        t for t in result.study.targets
        if (t.material, t.surface, t.experiment, t.observable) == (*where, panel.observable)
    )  # fmt: skip
    reading = next(one for one in place.readings if one.name == target.name)
    mean = place.emulator.predict(inputs_at(place, values)).mean[:, reading.columns][:, 0]
    measured = float(backward(target.model_scale, reading.y)[0])
    point = [best[k] for k in columns]
    return x, y, backward(target.model_scale, mean).reshape(SIDE, SIDE), measured, point


def _draw(axes: Axes, result: JointResult, material: str, panel: Panel) -> None:
    first = True
    for wall in panel.walls:
        where = Where(material, wall, panel.experiment)
        place = _seen(result, where)
        if place is None:
            continue
        x, y, field, measured, point = _field(result, panel, where, place)
        if first:
            filled = axes.contourf(x, y, field, LEVELS, cmap="Greys", alpha=0.55)
            axes.figure.colorbar(filled, ax=axes, pad=0.02).ax.tick_params(labelsize=8)
            first = False
        if field.min() < measured < field.max():
            axes.contour(x, y, field, [measured], colors=OURS, linestyles=WALLS.get(wall, "-"),
                         linewidths=2.0)  # fmt: skip
        axes.plot(*point, "o", color=OURS, markersize=7, fillstyle="full" if wall != "alumina" else
                  "none")  # fmt: skip
        values, flag = published(material, wall)
        axes.plot(values[panel.x], values[panel.y], "x" if not flag else "+", color=PAPER,
                  markersize=9, markeredgewidth=2.2, alpha=1.0 if wall != "alumina" else 0.6,
                  clip_on=False)  # fmt: skip
    axes.set_title(f"{panel.title} [{panel.unit}]", fontsize=10, color=INK)
    axes.set_xlabel(SYMBOLS[panel.x], fontsize=11)
    axes.set_ylabel(SYMBOLS[panel.y], fontsize=11)
    axes.tick_params(labelsize=8)


def contour_figure(result: JointResult, material: str) -> Figure:
    """Return the contours of a particle: two panels for each of the paper's first two stages."""
    with mpl.rc_context({"font.size": 9}):
        figure = Figure(figsize=(14.0, 6.4), layout="constrained")
        for axes, panel in zip(figure.subplots(2, 4).ravel(), PANELS, strict=True):
            _draw(axes, result, material, panel)
        handles = [
            Line2D([], [], color=OURS, linestyle="-", label="measured: glued or steel"),
            Line2D([], [], color=OURS, linestyle="--", label="measured: alumina"),
            Line2D([], [], color=OURS, marker="o", linestyle="", label="ours"),
            Line2D([], [], color=PAPER, marker="x", linestyle="", label="paper"),
            Line2D([], [], color=PAPER, marker="+", linestyle="", label="paper, no intersection"),
        ]
        figure.legend(handles=handles, loc="outside lower center", ncols=5, fontsize=10)
    return figure


def draw(result: JointResult, materials: Iterable[str]) -> None:
    """Draw the contours of particles."""
    for material in materials:
        sources.save(contour_figure(result, material), sources.contours_of(material), 90)
