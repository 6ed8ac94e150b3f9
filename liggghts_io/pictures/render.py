"""Pictures of a case: grains and meshes with what is measured on them, a page, and a chart."""

from __future__ import annotations

import io
import logging
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

from liggghts_io.case.directory import load_record, load_setup, load_spec
from liggghts_io.case.lock import locked
from liggghts_io.case.output import drawable_run, find_run
from liggghts_io.case.results import load_result
from liggghts_io.case.spec import experiment_of
from liggghts_io.errors import CaseError
from liggghts_io.files import replacing, write_text
from liggghts_io.pictures.camera import SIDE, camera_named
from liggghts_io.pictures.child import Studio
from liggghts_io.pictures.colouring import SPEED
from liggghts_io.pictures.compose import composed
from liggghts_io.pictures.page import page_of, scene_of
from liggghts_io.pictures.reel import BEST, Reel
from liggghts_io.pictures.reels import reel_of_case
from liggghts_io.pictures.style import SIGNED, TEXT, sheet

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.figure import Figure

    from liggghts_io.case.lock import Tell
    from liggghts_io.case.results import CaseResult
    from liggghts_io.pictures.shot import Shot

SCENE: Final = "scene.png"
CHART: Final = "chart.png"
_LOG: Final = logging.getLogger(__name__)


@dataclass(frozen=True)
class Look:
    """How a frame is drawn.

    Attributes
    ----------
    frame : str
        Which dump: "best" for the one that the experiment chooses, "first", "middle", "last" or a
        number that counts from 0.
    view : str
        "side", "front", "top" or "iso".
    colour : str
        What colours say: "speed", "height", "type" or "size".
    """

    frame: str = BEST
    view: str = SIDE
    colour: str = SPEED


def render_case(directory: Path, look: Look | None = None, tell: Tell | None = None) -> Path:
    """Draw the grains of a case with its meshes and notes.

    VTK draws the grains where it can; elsewhere matplotlib draws discs, which looks much the same.

    Parameters
    ----------
    directory : Path
        A case that ran.
    look : Look, optional
        From the side, coloured by speed, where it is not given.
    tell : callable, optional
        Receives a line when another process is waited for.

    Returns
    -------
    Path
        `scene.png` in the case directory.

    Raises
    ------
    CaseError
        If the case was not run, a file of the run was changed, or it has no such frame.
    """
    with reel_in(directory, tell) as reel:
        return render_reel(reel, directory / SCENE, look)


def scene_of_case(directory: Path, tell: Tell | None = None) -> str:
    """Return a scene of a case that can be turned with the mouse, as a part of an HTML page.

    Raises
    ------
    CaseError
        As `render_case`, or if it would be larger than 5 MB.
    """
    with reel_in(directory, tell) as reel:
        return scene_of(reel.shot(BEST, SPEED))


@contextmanager
def reel_in(directory: Path, tell: Tell | None = None) -> Iterator[Reel]:
    """Open the frames of a case for a block, in which nobody else writes to it.

    Raises
    ------
    CaseError
        If the case was not run, or a file of the run was changed.
    """
    identity = load_record(directory)["case_id"]
    with locked(directory, tell):
        yield reel_of_case(directory, drawable_run(directory, identity), _observables(directory))


def render_reel(reel: Reel, target: Path, look: Look | None = None) -> Path:
    """Write a picture of a frame.

    Raises
    ------
    CaseError
        If there is no such frame, view or colour.
    """
    return _save(_drawn(reel, look or Look())[1], target)


def render_page(reel: Reel, target: Path, look: Look | None = None) -> Path:
    """Write a page with a scene of a frame that can be turned with the mouse.

    Parameters
    ----------
    reel : Reel
    target : Path
    look : Look, optional
        Its view is that of the still picture, for browsers without WebGL.

    Raises
    ------
    CaseError
        If there is no such frame, view or colour, or the scene would be larger than 5 MB.
    """
    shot, figure = _drawn(reel, look or Look())
    still = io.BytesIO()
    figure.savefig(still, format="png")
    write_text(target, page_of(shot, still.getvalue()))
    return target


def _drawn(reel: Reel, look: Look) -> tuple[Shot, Figure]:
    camera = camera_named(look.view)
    shot = reel.shot(look.frame, look.colour)
    with Studio() as studio:
        grains = studio.picture(shot, camera)
        if grains is None:
            _LOG.info("VTK cannot draw here (no display, no software renderer): discs")
        return shot, composed(shot, camera, grains)


def chart_case(directory: Path) -> Path:
    """Draw what was measured, as the experiment shows it.

    Parameters
    ----------
    directory : Path
        A case with the result "ok".

    Returns
    -------
    Path
        `chart.png` in the case directory.

    Raises
    ------
    CaseError
        If the case failed or did not run, or its output is not that of its result.
    """
    load_record(directory)  # before a lock file appears in a directory that holds no case
    with locked(directory):
        folder, result = _measured_run(directory)
        experiment = experiment_of(load_spec(directory))
        figure, axes = sheet(3.6)
        experiment.chart(folder, load_setup(directory), result.observables, axes)
        axes.set_title(experiment.title, loc="left", fontsize=TEXT["title"])
        return _save(figure, directory / CHART)


def _measured_run(directory: Path) -> tuple[Path, CaseResult]:
    """Return the run of a case and the numbers that were measured on it."""
    result = load_result(directory)
    if result.status != "ok":
        msg = f"{directory}: the case failed ({result.reason}); there is nothing to draw"
        raise CaseError(msg)
    folder, end = find_run(directory, result.case_id, load_spec(directory).engine)
    if result.output != (end.digest if end else ""):
        msg = f"{directory}: the result is of another run than the output; use 'bulkcal post'"
        raise CaseError(msg)
    return folder, result


def _observables(directory: Path) -> Mapping[str, float]:
    try:
        return _measured_run(directory)[1].observables
    except CaseError:  # drawn all the same: a run that failed is looked at first of all
        return {}


def _save(figure: Figure, target: Path) -> Path:
    """Write a figure under a temporary name, then rename it."""
    with replacing(target, target.suffix) as temporary:
        figure.savefig(temporary, metadata=SIGNED)
    return target
