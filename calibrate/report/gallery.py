"""Pictures of the experiments in a report, and one scene that can be turned with the mouse."""

from __future__ import annotations

import base64
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, NamedTuple

from markupsafe import Markup

__all__ = ["Drawings", "gallery"]


class Drawings(NamedTuple):
    """How a case directory is drawn.

    Attributes
    ----------
    picture : callable
        Makes the picture of a case directory and returns its path (`liggghts_io.render_case`).
    scene : callable
        Returns a part of a page with a scene of a case directory (`liggghts_io.scene_of_case`).
    """

    picture: Callable[[Path], Path]
    scene: Callable[[Path], str]


def gallery(cases: Iterable[tuple[str, Path | None]], drawings: Drawings) -> dict[str, Any]:
    """Return what `gallery.html.j2` shows.

    Parameters
    ----------
    cases : iterable of (str, Path or None)
        Title and case directory of each experiment, None where every run failed.
    drawings : Drawings

    Returns
    -------
    dict
        `pictures`, one for each experiment, and `scene`, of the first one with a picture.
    """
    pictures = []
    scene = {"title": "", "content": "", "reason": ""}
    for title, directory in cases:
        picture = {"title": title, "image": "", "reason": "Every run of this experiment failed."}
        pictures.append(picture)
        if directory is None:
            continue
        try:
            content = drawings.picture(directory).read_bytes()
        except (OSError, RuntimeError) as err:
            picture["reason"] = f"No picture: {err}"
            continue
        picture["image"] = "data:image/png;base64," + base64.b64encode(content).decode("ascii")
        if not scene["title"]:
            scene = _scene(title, directory, drawings)
    return {"pictures": pictures, "scene": scene}


def _scene(title: str, directory: Path, drawings: Drawings) -> dict[str, str]:
    try:
        # Made by us, with every text in it escaped.
        return {"title": title, "content": Markup(drawings.scene(directory)), "reason": ""}
    except (OSError, RuntimeError) as err:
        return {"title": title, "content": "", "reason": f"No scene: {err}"}
