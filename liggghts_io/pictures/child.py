"""Let a child process draw the grains of a shot with VTK."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

import numpy as np

from liggghts_io.pictures.shot import Shot
from liggghts_io.pictures.style import COLOURS, SOLID

_TIMEOUT_S: Final = 180.0
_PROGRAM: Final = Path(__file__).with_name("scene.py")


@contextmanager
def grains_of(shot: Shot) -> Iterator[Path | None]:
    """Draw a shot; inside the block the picture is there, or None where VTK cannot draw."""
    with TemporaryDirectory(prefix="bulkcal-") as folder:
        scene, picture = Path(folder) / "scene.npz", Path(folder) / "grains.png"
        np.savez(scene, **_arrays(shot))
        yield picture if _drawn(scene, picture) else None


def _arrays(shot: Shot) -> dict[str, Any]:
    from matplotlib import colormaps
    from matplotlib.colors import to_rgb

    colours = colormaps[COLOURS](shot.frame.speeds / shot.fastest)[:, :3]
    return {
        "positions": shot.frame.positions,
        "diameters": 2.0 * shot.frame.columns["radius"],
        "colours": np.round(255.0 * colours).astype(np.uint8),
        "window": np.array(shot.window),
        "solid": np.array(to_rgb(SOLID)),
        "opacities": np.array([shot.view.solid[name] for name in shot.meshes]),
        **{f"mesh_{name}": triangles for name, triangles in shot.meshes.items()},
    }


def _drawn(scene: Path, picture: Path) -> bool:
    """Run the child; say whether a picture came out."""
    try:
        done = subprocess.run(
            [sys.executable, "-P", str(_PROGRAM), str(scene), str(picture)],
            stdin=subprocess.DEVNULL, capture_output=True, timeout=_TIMEOUT_S, check=False,
        )  # fmt: skip
    except (subprocess.TimeoutExpired, OSError):
        return False
    return done.returncode == 0 and picture.is_file()
