"""A scene that can be turned with the mouse, by vtk.js, with all data inside a page."""

from __future__ import annotations

import base64
import html
import json
from importlib.resources import files
from typing import Any, Final

import numpy as np

from liggghts_io.errors import CaseError
from liggghts_io.pictures.camera import VIEWS
from liggghts_io.pictures.colouring import Colouring
from liggghts_io.pictures.shot import FloatArray, Shot
from liggghts_io.pictures.style import SOLID

_VIEWER: Final = files("liggghts_io.pictures") / "viewer"
_MOST_BYTES: Final = 5_000_000
_MB: Final = 1e6
_MM: Final = 1e3
_START: Final = "iso"
_GLASS: Final = 0.35  # most opacity of a mesh: whoever turns a scene looks through it from anywhere
_STOPS: Final = 9  # colours of the bar
_POLICY: Final = (
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:"
)
"""What a browser may load for a page: nothing that is not in it."""


def scene_of(shot: Shot, *, wheel: bool = False) -> str:
    """Return a scene as a part of a page, hidden where a browser has no WebGL.

    A page has room for one. What is of the class ``until-scene`` in it disappears when the scene
    stands.

    Parameters
    ----------
    shot : Shot
    wheel : bool
        Whether the wheel of the mouse brings the scene nearer. Otherwise it moves the page, and
        the scene only with the control key.

    Raises
    ------
    CaseError
        If it would be larger than 5 MB, with what takes the room.
    """
    data = json.dumps(_data(shot, wheel=wheel))
    parts = (
        f"<style>{_text('scene.css')}</style>",
        '<div id="scene" class="scene" hidden><div class="scene-place"></div>',
        f'<div class="scene-bar">{_legend(shot.colouring)}<span>{_buttons()}</span></div></div>',
        f'<script type="application/json" id="scene-data">{data}</script>',
        f"<script>{_text('vtk.min.js')}</script>",
        f"<script>{_text('viewer.js')}</script>",
    )
    scene = "\n".join(parts)
    if len(scene) > _MOST_BYTES:
        faces = sum(map(len, shot.meshes.values()))
        msg = (
            f"{shot.frame.count} grains and {faces} triangles make a page of "
            f"{len(scene) / _MB:.1f} MB, {_MOST_BYTES / _MB:g} at most; draw a picture, or coarser "
            "meshes"
        )
        raise CaseError(msg)
    return scene


def page_of(shot: Shot, still: bytes) -> str:
    """Return a page with a scene, and its still picture where a browser has no WebGL.

    Parameters
    ----------
    shot : Shot
    still : bytes
        A PNG picture of it.

    Raises
    ------
    CaseError
        If the scene would be larger than 5 MB.
    """
    title = html.escape(shot.title)
    picture = base64.b64encode(still).decode("ascii")
    return "\n".join(
        (
            '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">',
            f'<meta http-equiv="Content-Security-Policy" content="{_POLICY}">',
            '<meta name="viewport" content="width=device-width, initial-scale=1">',
            f'<title>{title}</title>\n</head>\n<body class="scene-page">\n<h1>{title}</h1>',
            f'<img class="until-scene" alt="{title}" src="data:image/png;base64,{picture}">',
            f"{scene_of(shot, wheel=True)}\n</body>\n</html>\n",
        )
    )


def _data(shot: Shot, *, wheel: bool) -> dict[str, Any]:
    """Return what viewer.js reads: lengths in mm, numbers as bytes in base 64."""
    from matplotlib.colors import to_rgb

    frame = shot.frame
    return {
        "grains": {
            "centres": _packed(_MM * frame.positions),
            "radii": _packed(_MM * frame.columns["radius"]),
            "colours": base64.b64encode(shot.colouring.of(frame).tobytes()).decode("ascii"),
        },
        "meshes": [
            {
                "corners": _packed(_MM * triangles),
                "colour": to_rgb(SOLID),
                "opacity": min(shot.opacities[name], _GLASS),
            }
            for name, triangles in shot.meshes.items()
        ],
        "views": {
            name: {"toward": camera.toward.tolist(), "up": camera.up.tolist()}
            for name, camera in VIEWS.items()
        },
        "start": _START,
        "wheel": wheel,
    }


def _packed(numbers: FloatArray) -> str:
    return base64.b64encode(numbers.astype("<f4").tobytes()).decode("ascii")


def _text(name: str) -> str:
    return _VIEWER.joinpath(name).read_text(encoding="utf-8")


def _buttons() -> str:
    return "".join(f'<button type="button" data-view="{name}">{name}</button>' for name in VIEWS)


def _legend(colouring: Colouring) -> str:
    """Return what the colours say as HTML."""
    if not colouring.is_bar:
        dots = "".join(
            f'<span style="color:{colour}">&#9679;</span> {html.escape(words)} &ensp;'
            for colour, words in colouring.patches
        )
        return f"<span>{dots}</span>"
    from matplotlib.colors import to_hex

    stops = ",".join(to_hex(colouring.scale(part)) for part in np.linspace(0.0, 1.0, _STOPS))
    return (
        f"<span>{html.escape(colouring.label)}&ensp;{colouring.low:.3g} "
        f'<i class="scene-colours" style="background:linear-gradient(to right,{stops})"></i> '
        f"{colouring.high:.3g}</span>"
    )
