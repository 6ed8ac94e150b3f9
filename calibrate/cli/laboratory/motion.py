"""The command `motion`: a measured profile of a plate as a sum of cosines."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from calibrate.cli.arguments import AsJson, Quiet
from calibrate.cli.laboratory.options import TimeColumn, TimeUnit, new_picture, write_all
from calibrate.cli.show.output import Screen, table
from calibrate.cli.show.waiting import Waiting
from calibrate.errors import CalibrationError
from liggghts_io.pictures.style import check_replaced

if TYPE_CHECKING:
    from rich.table import Table

    from calibrate.laboratory.motion.profile import PlateMotion

__all__ = ["motion"]

_MOST_HARMONICS = 30
_GRAVITY = 9.81


Profile = Annotated[
    Path, typer.Argument(metavar="PROFILE.csv", help="Time, and position or acceleration.")
]
Period = Annotated[
    str, typer.Option("--period", help="Period, such as 0.08s or 80ms; default: it is found.")
]
Harmonics = Annotated[
    int,
    typer.Option(
        "--harmonics", metavar="N", min=0, max=_MOST_HARMONICS,
        help="Number of cosines; default: as many as are worth keeping.",
    ),
]  # fmt: skip
Reverse = Annotated[
    bool, typer.Option("--reverse", help="The sensor points against the way of the grains.")
]
Column = Annotated[str, typer.Option("--column", help="Column of position or acceleration.")]
Unit = Annotated[str, typer.Option("--unit", help="Its unit: m, cm, mm, um, m/s2, mm/s2 or g.")]
Picture = Annotated[
    Path | None,
    typer.Option("--plot", metavar="FILE.png", help="Picture; default: PROFILE_motion.png."),
]


def motion(
    profile: Profile,
    period: Period = "",
    harmonics: Harmonics = 0,
    reverse: Reverse = False,
    time_column: TimeColumn = "",
    column: Column = "",
    time_unit: TimeUnit = "",
    unit: Unit = "",
    plot: Picture = None,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> None:
    """Fit a sum of cosines to the measured motion of a plate, for a study or a LIGGGHTS script.

    Readings may have gaps and any spacing; gravity, mounting and slow drift of the sensor are
    taken off. A cosine is kept if it predicts parts of the record that it has not seen.

    Example: bulkcal motion plate.csv
    """
    screen = Screen(quiet)
    length = _seconds(period) if period else 0.0
    usual = Path(f"{profile.stem}_motion.png")
    picture = new_picture(plot, None) or check_replaced(usual, "--plot")
    with Waiting(screen.console, "fitting the motion"):
        from calibrate.laboratory.instrument.series import Form
        from calibrate.laboratory.motion.doubts import doubts_of
        from calibrate.laboratory.motion.figure import motion_figure
        from calibrate.laboratory.motion.lines import script_line, study_lines
        from calibrate.laboratory.motion.profile import plate_motion_in
        from calibrate.laboratory.plotting import png_of

        form = Form(time_column, column, time_unit, unit)
        found = plate_motion_in(
            profile, form, period_s=length, harmonics=harmonics, reverse=reverse
        )
        write_all({picture: png_of(motion_figure(found))})
    study, script, doubts = study_lines(found), script_line(found), doubts_of(found)
    if as_json:
        told = {"doubts": doubts, "study": study, "script": script, "written": [str(picture)]}
        screen.json(_plain(found) | told)
        return
    screen.table(_table(found))
    for line in _sentences(found):
        screen.result(line)
    for doubt in doubts:
        screen.remark(doubt)
    screen.result(f"wrote {picture}")
    screen.hint("into the study:\n")
    screen.result(study)
    screen.hint("\nor into a LIGGGHTS script, behind the mesh 'plate' and before its wall:\n")
    screen.result(script)
    screen.hint("\nnext: bulkcal check STUDY.toml, once the lines stand in the study")


def _seconds(text: str) -> float:
    """Return a period with its unit [s]."""
    from calibrate.laboratory.instrument.cells import number_and_unit
    from calibrate.laboratory.instrument.quantities import TIME
    from calibrate.laboratory.replicates import numbers_in_words

    found = number_and_unit(text.strip())
    number = numbers_in_words([found[0]])[0] if found else 0.0
    if found is None or found[1] not in TIME.units or not 0.0 < number < math.inf:
        msg = f"--period {text}: give a time above zero with its unit, such as 80ms or 0.08s"
        raise CalibrationError(msg)
    return number * TIME.units[found[1]]


def _plain(found: PlateMotion) -> dict[str, Any]:
    waves = zip(
        found.amplitudes_m, found.amplitudes_se_m, found.phases_rad, found.phases_se_rad,
        strict=True,
    )  # fmt: skip
    return {
        "file": str(found.path),
        "measured": found.quantity.name,
        "readings": len(found.time_s),
        "period_s": found.period_s,
        "period_se_s": found.period_se_s,
        "harmonics": [
            {
                "order": order,
                "amplitude_m": float(amplitude),
                "amplitude_se_m": float(amplitude_se),
                "phase_deg": math.degrees(phase),
                "phase_se_deg": math.degrees(phase_se),
            }
            for order, (amplitude, amplitude_se, phase, phase_se) in enumerate(waves, 1)
        ],
        "rms": found.fit.rms,
        "rms_unit": found.quantity.unit,
        "share": found.share,
        "worth_keeping": found.worth,
        "missed_by": [float(one) ** 0.5 for one in found.errors.mean(axis=1)],
        "peak_acceleration_m_s2": _peak(found),
    }


def _peak(found: PlateMotion) -> float:
    import numpy as np

    clock = np.linspace(0.0, found.period_s, 1000)
    return float(np.abs(found.acceleration(clock)).max())


def _table(found: PlateMotion) -> Table:
    headings = ["cosine", "amplitude (mm)", "phase (deg)"]
    shown = table(headings, headings[1:])
    for one in _plain(found)["harmonics"]:
        phase = "90 (starts the clock)"
        if one["order"] > 1:
            phase = f"{one['phase_deg']:.4g} ± {one['phase_se_deg']:.2g}"
        size = f"{1e3 * one['amplitude_m']:.5g} ± {1e3 * one['amplitude_se_m']:.2g}"
        shown.add_row(str(one["order"]), size, phase)
    return shown


def _sentences(found: PlateMotion) -> list[str]:
    error = f" ± {1e3 * found.period_se_s:.2g}" if found.period_se_s else " (given)"
    said = [
        f"period {1e3 * found.period_s:.6g}{error} ms; peak acceleration "
        f"{_peak(found) / _GRAVITY:.3g} g",
        f"remaining error {found.fit.rms:.3g} {found.quantity.unit} (rms), "
        f"{100 * found.share:.2g} % of the motion",
    ]
    worth = "1 cosine is" if found.worth == 1 else f"{found.worth} cosines are"
    if found.worth == len(found.errors):
        said.append(f"{worth} worth keeping, and more might be: as many as were tried")
    else:
        said.append(
            f"{worth} worth keeping: more of them do not predict unseen parts of the record any "
            "better"
        )
    return said
