"""The commands `photo size` and `photo angle`: what a camera measures, as a study takes it."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Annotated, Final

import typer

from calibrate.cli import completion
from calibrate.cli.arguments import AsJson, Quiet, one_of
from calibrate.cli.show.output import Screen
from calibrate.cli.show.waiting import Waiting
from calibrate.errors import CalibrationError

__all__ = ["app"]

app = typer.Typer(
    name="photo",
    help="Measure photographs: sizes of grains, angle of repose.",
    rich_markup_mode=None,
)

POLARITIES: Final = ("dark", "bright")
_SCALES: Final = ("--scale", "--ruler", "--points")

Photos = Annotated[
    list[Path], typer.Argument(metavar="PHOTO...", help="JPEG, PNG, TIFF, BMP, WebP or PPM.")
]
Out = Annotated[
    str | None,
    typer.Option("--out", metavar="DIR", help="Write tables and pictures into this directory."),
]


@app.callback(invoke_without_command=True)
def photo(ctx: typer.Context) -> None:
    """Measure photographs: sizes of grains, angle of repose."""
    if ctx.invoked_subcommand is None:
        Screen().result(ctx.get_help())


@app.command("size", short_help="Sizes and circularity of grains.")
def size(
    photos: Photos,
    scale: Annotated[
        str, typer.Option("--scale", metavar="NUMBERpx/mm", help="Such as 22.7px/mm or 44um/px.")
    ] = "",
    ruler: Annotated[
        str,
        typer.Option(
            "--ruler", metavar="LENGTH",
            help="Between the finest ticks of a ruler in each photo, such as 1mm.",
        ),
    ] = "",
    points: Annotated[
        str,
        typer.Option(
            "--points", metavar="x1,y1,x2,y2,LENGTH",
            help="Columns and rows of two points, and what lies between them: 100,50,554,50,20mm.",
        ),
    ] = "",
    grains: Annotated[
        str,
        typer.Option(
            "--grains", metavar="|".join(POLARITIES),
            autocompletion=completion.offer(POLARITIES),
            help="Whether grains are darker or brighter than the ground; found out if left out.",
        ),
    ] = "",
    out: Out = None,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> None:  # fmt: skip
    """Measure grains spread in one layer, photographed from above: d32, d10, d50, d90, circularity.

    Grains that touch are separated. What the border cuts, clumps, dust, a ruler and tracers of
    another brightness are left out, and drawn in red in the picture that --out gets. Several
    photos of one bulk are counted together.

    Example: bulkcal photo size grains.jpg --scale 22.7px/mm --out sizes

    Example: bulkcal photo size a.jpg b.jpg --ruler 1mm --json
    """
    _check_scales(scale, ruler, points)
    if grains:
        one_of("--grains", grains, POLARITIES)
    screen = Screen(quiet)
    with Waiting(screen.console, "measuring grains"):
        from calibrate.cli.laboratory import photo_size as sizes
        from calibrate.cli.laboratory.photo_output import out_directory, write_all

        target = out_directory(out, sizes.names_of_files(photos))
        found = sizes.measured_photos(photos, (scale, ruler, points), grains, draw=bool(target))
        if target:
            write_all(target, sizes.size_files(found))
    if as_json:
        sizes.tell_doubts(screen, found)
        screen.json(sizes.sizes_data(found))
        return
    sizes.show_sizes(screen, found)
    _written(screen, target, sizes.names_of_files(photos))


def _check_scales(*given: str) -> None:
    """Refuse a scale that was given in no or in several ways."""
    names = [name for name, word in zip(_SCALES, given, strict=True) if word]
    if len(names) != 1:
        said = f"{' and '.join(names)} were given" if names else "none was given"
        msg = f"the scale is one of {', '.join(_SCALES)}, and {said}; write --scale 22.7px/mm"
        raise CalibrationError(msg)


@app.command("angle", short_help="Angle of repose of a heap.")
def angle(
    photos: Photos,
    level: Annotated[
        str,
        typer.Option(
            "--level", metavar="x1,y1,x2,y2",
            help="Two points of the plate or of a level line; found in the photo if left out.",
        ),
    ] = "",
    surface: Annotated[
        str, typer.Option("--surface", help="Wall under the heap, for the lines of a study.")
    ] = "",
    out: Out = None,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> None:  # fmt: skip
    """Measure the angle of repose of a heap photographed from the side: both flanks and their mean.

    A line is fitted to each flank between a fifth and four fifths of the height, as in simulated
    heaps. The plate is found in the photo; --level tells it where that fails. The standard error
    of one photo holds the scatter of its outline only. Several photos, each of a heap poured
    anew, are repeats: their mean and its standard error are printed as a target of a study.

    Example: bulkcal photo angle heap.jpg --out angle

    Example: bulkcal photo angle heap1.jpg heap2.jpg heap3.jpg --surface steel
    """
    screen = Screen(quiet)
    with Waiting(screen.console, "measuring heaps"):
        from calibrate.cli.laboratory import photo_angle as angles
        from calibrate.cli.laboratory.photo_output import out_directory, write_all

        target = out_directory(out, angles.names_of_files(photos))
        found = angles.measured_heaps(photos, level, surface, draw=bool(target))
        if target:
            write_all(target, angles.angle_files(found))
    if as_json:
        angles.tell_doubts(screen, found)
        screen.json(angles.angles_data(found))
        return
    angles.show_angles(screen, found)
    _written(screen, target, angles.names_of_files(photos))


def _written(screen: Screen, directory: Path | None, names: Iterable[str]) -> None:
    """Say which files were written, where a directory was named."""
    for name in names if directory else ():
        screen.hint(f"wrote {directory}/{name}")
