"""Measure and draw a run of an own experiment."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from liggghts_io.errors import CaseError
from liggghts_io.experiments.own.reading import Definition
from liggghts_io.experiments.setup import Observed, Setup
from liggghts_io.experiments.view import Notes, View
from liggghts_io.measure.dumps import Frame, check_all_dumps
from liggghts_io.measure.extract import Run
from liggghts_io.measure.extract.grains.angle import Angle

_IN_A_LINE: Final = 2  # numbers above a picture


def observing(found: Definition) -> Callable[[Path, Setup], Observed]:
    """Return what measures a finished run."""

    def observe(folder: Path, setup: Setup) -> Observed:
        check_all_dumps(folder)
        run = _run(folder, setup)
        values = {}
        for one, extractor in found.observables:
            with _naming(one.name):
                values[one.name] = extractor.factor * extractor.read(run)
        tables = {}
        for curve, curve_extractor in found.curves:
            with _naming(curve.name):
                x, y = curve_extractor.read(run)
                tables[f"{curve.name}.csv"] = {
                    "x": x * curve_extractor.x_factor,
                    "y": y * curve_extractor.factor,
                }
        return Observed(values, tables)

    return observe


class _naming:  # noqa: N801 - used as a function
    """Puts the name of an observable before the reason why it is not determined."""

    def __init__(self, name: str) -> None:
        self._name = name

    def __enter__(self) -> None:
        pass

    def __exit__(self, _kind: Any, error: BaseException | None, _trace: Any) -> None:
        if type(error) is CaseError:
            msg = f"{self._name}: {error}"
            raise CaseError(msg) from error


def _run(folder: Path, setup: Setup) -> Run:
    names = {**setup.apparatus, "d32_m": setup.particle.d32_m}
    return Run(folder, setup.particle.density, names)


def charting(found: Definition) -> Callable[[Path, Setup, Mapping[str, float], Any], None]:
    """Return what draws the first curve, or the numbers where there is none."""

    def chart(folder: Path, setup: Setup, observables: Mapping[str, float], axes: Any) -> None:
        words = _words(found, observables)
        if not found.curves:
            axes.set_axis_off()
            for k, word in enumerate(words):
                axes.text(0.02, 0.9 - 0.12 * k, word, transform=axes.transAxes, fontsize=12)
            return
        curve, extractor = found.curves[0]
        x, y = extractor.read(_run(folder, setup))
        axes.plot(x * extractor.x_factor, y * extractor.factor, linewidth=2.0)
        axes.set_xlabel(f"{curve.x_name} ({curve.x_unit})")
        axes.set_ylabel(f"{curve.meaning} ({curve.unit})")
        if words:
            axes.legend([], [], title="\n".join(words), loc="best")

    return chart


def _words(found: Definition, observables: Mapping[str, float]) -> list[str]:
    """Return each number that is known with its name and unit."""
    return [
        f"{one.name} = {observables[one.name]:.4g} {one.unit}".removesuffix(" -")
        for one, _ in found.observables
        if one.name in observables
    ]


def view_of(found: Definition) -> View:
    """Return how a case is drawn: its meshes, and the fitted lines of all angles seen along y."""
    picture = found.head.picture
    solid = {
        mesh.file.rpartition("/")[2].removesuffix(".stl"): mesh.opacity
        for mesh in found.meshes
        if mesh.opacity > 0.0
    }

    def window(setup: Setup) -> tuple[float, float, float, float]:
        run = _run(Path(), setup)
        left, right, low, high = (run.amount(one) for one in picture.window or ())
        return left, right, low, high

    return View(
        solid=solid,
        at=lambda _setup: picture.at,
        window=window if picture.window else None,
        notes=_noting(found),
    )


def _noting(found: Definition) -> Callable[[Frame, Setup, Mapping[str, float]], Notes]:
    def notes(frame: Frame, setup: Setup, observables: Mapping[str, float]) -> Notes:
        words = _words(found, observables)
        title = "\n".join(
            ", ".join(words[k : k + _IN_A_LINE]) for k in range(0, len(words), _IN_A_LINE)
        )
        lines: list[npt.NDArray[np.float64]] = []
        labels: list[tuple[float, float, str]] = []
        for angle in (e for _, e in found.observables if isinstance(e, Angle)):
            for line, degrees in _fitted(angle, frame, setup):
                x, z = line.mean(axis=0)
                above = float(z + 3.0 * setup.particle.d32_m)
                label = (float(x), above, f"{degrees:.1f}°")
                if label not in labels:  # angles of other times are read from the same line
                    lines.append(line)
                    labels.append(label)
        return Notes(title, tuple(lines), tuple(labels))

    return notes


def _fitted(
    angle: Angle, frame: Frame, setup: Setup
) -> list[tuple[npt.NDArray[np.float64], float]]:
    """Return the lines that an angle is read from in one frame, with its value there."""
    if angle.plane != "xz":
        return []
    try:
        shadow, base = angle.silhouette(frame, _run(Path(), setup))
        degrees, lines = angle.fit(shadow)
    except CaseError:  # an early frame, without what is measured
        return []
    return [(line + np.array([0.0, base]), degrees) for line in lines]
