"""Let a child process draw with VTK, one scene after the other."""

from __future__ import annotations

import subprocess
import sys
import threading
from pathlib import Path
from tempfile import TemporaryDirectory
from types import TracebackType
from typing import Any, Final

import numpy as np

from liggghts_io.pictures.camera import Camera
from liggghts_io.pictures.shot import Shot, Window
from liggghts_io.pictures.style import EDGE, SOLID

STILL: Final = 2400
"""Pixels across a picture that is reduced to the size of a sheet, against steps at edges."""
FILM: Final = 1600
_TIMEOUT_S: Final = 600.0  # for one scene, also where others use the processor
_PROGRAM: Final = Path(__file__).with_name("scene.py")


class Studio:
    """Draws shots in a child process that lives as long as the ``with`` block."""

    def __init__(self) -> None:
        self._folder = TemporaryDirectory(prefix="bulkcal-")
        self._child: subprocess.Popen[str] | None = None
        self._failed = False

    def __enter__(self) -> Studio:
        """Return itself; the child is started by the first scene."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """End the child and remove what it made."""
        self._end()
        self._folder.cleanup()

    def picture(
        self, shot: Shot, camera: Camera, width: int = STILL, window: Window | None = None
    ) -> Path | None:
        """Return a picture of a shot, which stands until the next one, None where VTK fails.

        Parameters
        ----------
        shot : Shot
        camera : Camera
        width : int
            In pixels.
        window : (float, float, float, float), optional
            Left, right, bottom and top [m] where they are not those of the shot.
        """
        if self._failed:
            return None
        scene, target = Path(self._folder.name, "scene.npz"), Path(self._folder.name, "grains.png")
        target.unlink(missing_ok=True)
        arrays = _arrays(shot, camera, window or shot.window_of(camera))
        np.savez(scene, width=np.array(width), **arrays)
        self._failed = not (self._told(f"{scene}\t{target}\n") and target.is_file())
        return None if self._failed else target

    def _told(self, line: str) -> bool:
        """Whether the child did what a line asks for."""
        child = self._child = self._child or _started()
        if child is None or child.stdin is None or child.stdout is None:
            return False
        timer = threading.Timer(_TIMEOUT_S, child.kill)
        timer.start()
        try:
            child.stdin.write(line)
            child.stdin.flush()
            return child.stdout.readline() == "\n"
        except OSError:
            return False
        finally:
            timer.cancel()

    def _end(self) -> None:
        if self._child is not None:
            self._child.kill()
            self._child.communicate()
            self._child = None


def _started() -> subprocess.Popen[str] | None:
    try:
        return subprocess.Popen(
            [sys.executable, "-P", str(_PROGRAM)],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
        )  # fmt: skip
    except OSError:
        return None


def _arrays(shot: Shot, camera: Camera, window: Window) -> dict[str, Any]:
    from matplotlib.colors import to_rgb

    return {
        "positions": shot.frame.positions,
        "radii": shot.frame.columns["radius"],
        "colours": shot.colouring.of(shot.frame),
        "right": camera.right,
        "up": camera.up,
        "window": np.array(window),
        "solid": np.array(to_rgb(SOLID)),
        "edge": np.array(to_rgb(EDGE)),
        "opacities": np.array([shot.opacity(name, camera) for name in shot.meshes]),
        **{f"mesh_{name}": triangles for name, triangles in shot.meshes.items()},
    }
