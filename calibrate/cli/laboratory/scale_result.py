"""What `bulkcal measured scale` reads, writes and shows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from calibrate.cli.show.output import Screen, table
from calibrate.errors import CalibrationError
from calibrate.laboratory.entries import Entry, extended
from calibrate.laboratory.instrument.cells import number_and_unit
from calibrate.laboratory.instrument.quantities import MASS
from calibrate.laboratory.instrument.series import Form
from calibrate.laboratory.plotting import png_of
from calibrate.laboratory.replicates import numbers_in_words
from calibrate.laboratory.scale.curve import Estimate, MassCurve
from calibrate.laboratory.scale.doubts import doubts_about
from calibrate.laboratory.scale.figure import mass_figure
from calibrate.laboratory.scale.log import read_mass_curve
from calibrate.laboratory.scale.repeats import (
    QUANTITIES,
    Repeated,
    curve_table,
    quantity_of,
    repeated,
)
from calibrate.laboratory.targets import (
    Place,
    check_value,
    curve_lines,
    experiment_lines,
    value_lines,
)

__all__ = ["Asked", "Found", "read_logs", "scale_data", "scale_files", "show_scale"]

_TARGET_MASS: Final = "target_mass_kg"
_POURED_MASS: Final = "poured_mass_kg"
_GRAMS_PER_KG: Final = 1e3
_ONE_MASS: Final = "# For every time of a mass in the study; where there are several, use --curve."


@dataclass(frozen=True)
class Asked:
    """What the command was asked for.

    Attributes
    ----------
    mass : str
        With its unit.
    quantity : str
        One of `QUANTITIES`.
    curve : bool
        Whether the whole curve is written.
    out : Path, optional
    name, material, surface : str
        Of the target.
    place : Place, optional
        What answers to it, where something is written.
    """

    mass: str
    quantity: str
    curve: bool
    out: Path | None
    name: str
    material: str
    surface: str
    place: Place | None


@dataclass(frozen=True)
class Found:
    """What the logs say.

    Attributes
    ----------
    curves : tuple of MassCurve
    mass_g : float
        Mass whose time was asked for.
    mean : Repeated
        Of the quantity that was asked for.
    """

    curves: tuple[MassCurve, ...]
    mass_g: float
    mean: Repeated


def read_logs(logs: Sequence[Path], form: Form, starts: Sequence[str], asked: Asked) -> Found:
    """Read logs and what was asked of them.

    Raises
    ------
    CalibrationError
    """
    mass_g = _mass(asked.mass)
    if len(starts) not in (0, 1, len(logs)):
        msg = (
            f"--start: {len(starts)} times for {len(logs)} logs; give one for all, or one for each"
        )
        raise CalibrationError(msg)
    each = list(starts) * (len(logs) if len(starts) == 1 else 1) or [""] * len(logs)
    curves = tuple(
        read_mass_curve(path, form, opened) for path, opened in zip(logs, each, strict=True)
    )
    _refuse_twice(curves)
    mean = repeated([quantity_of(curve, asked.quantity, mass_g) for curve in curves])
    usual = {} if asked.place is None else _usual(asked.place)
    poured = usual.get(_POURED_MASS)
    wanted = mass_g if asked.quantity == "time" else None
    curves = tuple(
        replace(curve, remarks=(
            *curve.remarks,
            *doubts_about(curve, wanted, None if poured is None else poured * _GRAMS_PER_KG),
        ))
        for curve in curves
    )  # fmt: skip
    return Found(curves, mass_g, mean)


def _usual(place: Place) -> dict[str, float]:
    """Return the numbers of an experiment's apparatus that a study need not say."""
    return {one.name: one.quick for one in place.experiment.parameters}


def _mass(text: str) -> float:
    """Return a mass with its unit [g]."""
    found = number_and_unit(text.strip())
    number = numbers_in_words([found[0]])[0] if found else 0.0
    if found is None or found[1] not in MASS.units or number <= 0.0:
        msg = f"--mass {text}: give a mass above zero with its unit, such as 100g or 0.1kg"
        raise CalibrationError(msg)
    return number * MASS.units[found[1]]


def _refuse_twice(curves: Sequence[MassCurve]) -> None:
    """Refuse a log that is given twice, or copied and saved anew: a repeat counts once."""
    for k, curve in enumerate(curves):
        for before in curves[:k]:
            if _same_readings(curve, before):
                msg = (
                    f"{curve.path}: is the same log as {before.path}; a repeat counts once, leave "
                    "one out"
                )
                raise CalibrationError(msg)


def _same_readings(one: MassCurve, other: MassCurve) -> bool:
    """Whether all readings are the same but for decimals: no two flows of grains are so alike."""
    if len(one.time_s) != len(other.time_s):
        return False
    times = (one.time_s - one.time_s[0]) - (other.time_s - other.time_s[0])
    tick_s, tick_g = max(one.tick_s, other.tick_s), max(one.tick_g, other.tick_g)
    return bool(
        np.all(np.abs(times) <= tick_s) and np.all(np.abs(one.mass_g - other.mass_g) <= tick_g)
    )


def scale_files(found: Found, asked: Asked, picture: Path | None) -> tuple[dict[Path, bytes], str]:
    """Return the files to be written, the table last, and the lines of the study."""
    files: dict[Path, bytes] = {}
    lines = ""
    title = asked.name or _called(found.curves)
    if picture is not None:
        files[picture] = png_of(mass_figure(found.curves, found.mass_g, title))
    if asked.out is not None and asked.place is not None:
        ways = _curve_file if asked.curve else _entry
        files[asked.out], lines = ways(found, asked, asked.out, asked.place)
    return files, lines


def _called(curves: Sequence[MassCurve]) -> str:
    """Return a title: the name of the only log, or that of the first and how many there are."""
    first = curves[0].path.name
    return first if len(curves) == 1 else f"{first} and {len(curves) - 1} more"


def _origin(curves: Sequence[MassCurve]) -> str:
    return ", ".join(curve.path.name for curve in curves)


def _entry(found: Found, asked: Asked, out: Path, place: Place) -> tuple[bytes, str]:
    """Return the table with one row more, and its target."""
    mean = found.mean
    what = f"{found.mass_g:g} g" if asked.quantity == "time" else asked.quantity
    origin = f"{_origin(found.curves)}; {what}"
    unit = QUANTITIES[asked.quantity]
    entry = Entry(asked.name, asked.material, asked.surface, mean.value, mean.se, unit,
                  mean.repeats, origin)  # fmt: skip
    check_value(entry, place)
    lines = value_lines(entry, place, out.name)
    usual = _usual(place).get(_TARGET_MASS)
    mass_kg = found.mass_g / _GRAMS_PER_KG
    if asked.quantity == "time" and usual is not None and usual != mass_kg:
        changed = experiment_lines(place.experiment.name, {_TARGET_MASS: mass_kg})
        lines = f"{_ONE_MASS}\n{changed}\n\n{lines}"
    return extended(out, entry), lines


def _curve_file(found: Found, asked: Asked, out: Path, place: Place) -> tuple[bytes, str]:
    """Return the table of a curve, and its target."""
    if out.exists():
        msg = f"--out {out}: exists already, and a curve is a table of its own; name another file"
        raise CalibrationError(msg)
    curve = curve_table(found.curves)
    runs = [f"run_{k}_s" for k in range(1, len(found.curves) + 1)]
    keys = {"file": out.name, "x_column": "mass_g", "column": "time_s", "se_column": "se_s",
            "repeats": found.mean.repeats}  # fmt: skip
    lines = curve_lines(asked.name, asked.material, asked.surface, place, keys)
    head = f"# Time at which a mass lies on the scale, from {_origin(found.curves)}."
    rows = [",".join(["mass_g", "time_s", "se_s", *runs])]
    for k in range(len(curve.mass_g)):
        numbers = [curve.mass_g[k], curve.time_s[k], curve.se_s[k], *curve.runs_s[k]]
        rows.append(",".join(f"{number:.6g}" for number in numbers))
    return "\n".join([head, *rows, ""]).encode(), lines


def scale_data(
    found: Found, asked: Asked, files: Mapping[Path, bytes], lines: str
) -> dict[str, Any]:
    """Return the result as JSON shows it."""
    return {
        "quantity": asked.quantity,
        "mass_g": found.mass_g,
        "unit": QUANTITIES[asked.quantity],
        **asdict(found.mean),
        "logs": [_log_data(curve, found.mass_g) for curve in found.curves],
        "written": [str(path) for path in files],
        "study": lines,
    }


def _log_data(curve: MassCurve, mass_g: float) -> dict[str, Any]:
    reached = curve.rising_g[-1] >= mass_g
    numbers: dict[str, Estimate | None] = {
        "time_s": curve.time_to(mass_g) if reached else None,
        "onset_s": curve.onset_s,
        "slope_g_s": curve.slope_g_s,
        "plateau_g": curve.plateau_g,
        "tare_g": curve.tare_g,
        "drift_g_s": curve.drift_g_s,
    }
    return {
        "file": str(curve.path),
        "readings": len(curve.time_s),
        **{name: one and asdict(one) for name, one in numbers.items()},
        "taken_out": dict(curve.taken_out),
        "remarks": list(curve.remarks),
    }


def show_scale(screen: Screen, found: Found, asked: Asked) -> None:
    """Print a row for each log, what is to be known of it, and the mean."""
    headings = ["log", f"time of {found.mass_g:g} g (s)", "onset (s)", "slope (g/s)", "plateau (g)",
                "tare (g)", "drift (g/s)", "taken out"]  # fmt: skip
    shown = table(headings, headings[1:-1])
    for curve in found.curves:
        data = _log_data(curve, found.mass_g)
        numbers = ("time_s", "onset_s", "slope_g_s", "plateau_g", "tare_g", "drift_g_s")
        out = ", ".join(f"{why} {count}" for why, count in curve.taken_out.items() if count)
        shown.add_row(curve.path.name, *(_in_words(data[name]) for name in numbers), out or "-")
    screen.table(shown)
    named: dict[str, list[str]] = {}
    for curve in found.curves:
        for remark in curve.remarks:
            named.setdefault(remark, []).append(curve.path.name)
    for remark, logs in named.items():
        screen.hint(f"{', '.join(logs)}: {remark}")
    what = f"time of {found.mass_g:g} g" if asked.quantity == "time" else asked.quantity
    mean, unit = found.mean, QUANTITIES[asked.quantity]
    many = f"{mean.repeats} logs" if mean.repeats else "1 log"
    screen.result(f"{what}: {mean.value:.5g} ± {mean.se:.2g} {unit}, {many}")
    if not mean.repeats:
        screen.hint(
            "the error is that of reading one log; how far repeats scatter is not known: make some"
        )


def _in_words(one: Mapping[str, float] | None) -> str:
    return "-" if one is None else f"{one['value']:.5g} ± {one['se']:.2g}"
