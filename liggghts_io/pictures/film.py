"""Films: a run in time-lapse, and a frame on a turntable, as MP4 or GIF."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Iterator
from importlib import import_module
from pathlib import Path
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from liggghts_io.errors import CaseError
from liggghts_io.files import replacing
from liggghts_io.pictures.camera import TURN_DEG, Camera, camera_named, orbit
from liggghts_io.pictures.child import FILM, Studio
from liggghts_io.pictures.compose import composed
from liggghts_io.pictures.reel import Reel
from liggghts_io.pictures.render import Look
from liggghts_io.pictures.shot import Shot, Window

Image = npt.NDArray[np.uint8]
Progress = Callable[[int, int], None]
MP4: Final = ".mp4"
GIF: Final = ".gif"
_RATE: Final = {MP4: 24.0, GIF: 12.0}  # pictures a second of a turntable
_TURN_S: Final = 6.0  # of one turn
_SHORTEST_S: Final = 4.0  # of a film of few frames
_QUALITY: Final = 8  # of 10


def checked_film(target: Path) -> Path:
    """Return the name of a film that can be written.

    Raises
    ------
    CaseError
        If it ends in neither .mp4 nor .gif, or MP4 cannot be written here.
    """
    if target.suffix not in _RATE:
        msg = f"{target}: name a film that ends in {MP4} or {GIF}"
        raise CaseError(msg)
    if target.suffix == MP4:
        try:
            import_module("imageio_ffmpeg")
        except ImportError as err:
            msg = f"{target}: MP4 needs 'pip install bulkcal[film]'; a {GIF} does without"
            raise CaseError(msg) from err
    return target


def time_lapse(
    reel: Reel, target: Path, look: Look | None = None, tell: Progress | None = None
) -> Path:
    """Write all frames of a run one after the other, in the same colours and window.

    Parameters
    ----------
    reel : Reel
    target : Path
        Ends in .mp4 or .gif.
    look : Look, optional
        Its frame is not looked at.
    tell : callable, optional
        Receives the number of frames that were drawn, and of all.

    Raises
    ------
    CaseError
        If no frame holds a grain, or the film cannot be written.
    """
    look = look or Look()
    camera = camera_named(look.view)
    count = reel.last + 1
    windows = [one.window_of(camera) for one in reel.film(look.colour) if one.frame.count]
    window = _around(windows)
    shots = ((one, camera) for one in reel.film(look.colour))
    rate = min(_RATE[checked_film(target).suffix], count / _SHORTEST_S)
    return _film(shots, window, target, max(rate, 1.0), count, tell)


def turntable(
    reel: Reel, target: Path, look: Look | None = None, tell: Progress | None = None
) -> Path:
    """Write one frame seen from all around.

    Parameters
    ----------
    reel : Reel
    target : Path
        Ends in .mp4 or .gif.
    look : Look, optional
        Its view is not looked at.
    tell : callable, optional
        Receives the number of pictures that were drawn, and of all.

    Raises
    ------
    CaseError
        If there is no such frame, or the film cannot be written.
    """
    look = look or Look()
    rate = _RATE[checked_film(target).suffix]
    shot = reel.shot(look.frame, look.colour)
    count = round(_TURN_S * rate)
    cameras = [orbit(360.0 * k / count - 90.0, TURN_DEG) for k in range(count)]
    window = _around([shot.window_of(camera) for camera in cameras])
    shots = ((shot, camera) for camera in cameras)
    return _film(shots, window, target, rate, count, tell)


def _around(windows: Iterable[Window]) -> Window:
    sides = np.array(list(windows))
    left, low = sides[:, [0, 2]].min(axis=0).tolist()
    right, high = sides[:, [1, 3]].max(axis=0).tolist()
    return left, right, low, high


def _film(
    shots: Iterable[tuple[Shot, Camera]],
    window: Window,
    target: Path,
    rate: float,
    count: int,
    tell: Progress | None,
) -> Path:
    """Write the film under a temporary name, then rename it."""
    write = _write_gif if target.suffix == GIF else _write_mp4
    with replacing(target, target.suffix) as temporary:
        write(temporary, _images(shots, window, count, tell), rate)
    return target


def _images(
    shots: Iterable[tuple[Shot, Camera]], window: Window, count: int, tell: Progress | None
) -> Iterator[Image]:
    """Yield the pictures of a film, all of one even size."""
    with Studio() as studio:
        for number, (shot, camera) in enumerate(shots, start=1):
            grains = studio.picture(shot, camera, FILM, window)
            figure = composed(shot, camera, grains, window)
            figure.canvas.draw()
            pixels = np.asarray(figure.canvas.buffer_rgba())[:, :, :3]  # type: ignore[attr-defined]
            rows, columns = (size - size % 2 for size in pixels.shape[:2])
            yield np.ascontiguousarray(pixels[:rows, :columns])
            if tell is not None:
                tell(number, count)


def _write_gif(target: Path, images: Iterator[Image], rate: float) -> None:
    from PIL import Image as Pillow

    frames = (Pillow.fromarray(image).quantize(colors=128) for image in images)
    first = next(frames)
    first.save(
        target, format="GIF", save_all=True, append_images=frames, duration=round(1000.0 / rate),
        loop=0, optimize=True,
    )  # fmt: skip


def _write_mp4(target: Path, images: Iterator[Image], rate: float) -> None:
    ffmpeg: Any = import_module("imageio_ffmpeg")
    first = next(images)
    rows, columns = first.shape[:2]
    writer = ffmpeg.write_frames(
        str(target), (columns, rows), fps=rate, quality=_QUALITY, macro_block_size=2,
        ffmpeg_log_level="error",
    )  # fmt: skip
    writer.send(None)
    try:
        for image in itertools.chain([first], images):
            writer.send(image)
    finally:
        writer.close()
