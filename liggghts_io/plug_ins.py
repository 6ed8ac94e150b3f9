"""Experiments and effects that installed packages offer, ours among them, by entry points.

In a checkout ours are read from its `pyproject.toml`, so that a new line counts at once; once
installed they stand in the metadata like those of any other package.
"""

from __future__ import annotations

import logging
import tomllib
from collections.abc import Iterable
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from typing import Any, Final, NamedTuple, TypeVar

from liggghts_io.errors import CaseError

OURS: Final = "bulkcal"
_LOG: Final = logging.getLogger(__name__)
_T = TypeVar("_T")


class Loaded(NamedTuple):
    """What the packages offer in one group.

    Attributes
    ----------
    found : dict
        By the name that each has; ours first, each part in the order of the entry points' names.
    broken : list of str
        What cannot be used: package, name and reason.
    """

    found: dict[str, Any]
    broken: list[str]


def load_plug_ins(group: str, kind: type[_T], more: Loaded | None = None) -> Loaded:
    """Load what the packages offer; whatever is broken is named and stops nothing else.

    Parameters
    ----------
    group : str
        Such as "bulkcal.experiments".
    kind : type
        What an entry point must lead to: an object of this class, with a `name`.
    more : Loaded, optional
        What bulkcal itself has without an entry point; it stands behind the others of ours.

    Raises
    ------
    CaseError
        If not even ours are there.
    """
    loaded = Loaded({}, [])
    ours, others = _offered(group)
    _take(ours, kind, loaded)
    if more is not None:
        loaded.found.update({k: one for k, one in more.found.items() if k not in loaded.found})
        loaded.broken.extend(more.broken)
    _take(others, kind, loaded)
    for message in loaded.broken:
        _LOG.warning("%s", message)
    return loaded


def _take(offered: Iterable[tuple[str, EntryPoint]], kind: type[_T], loaded: Loaded) -> None:
    """Load entry points one by one."""
    for package, point in offered:
        place = f"the package {package} offers {point.name!r} ({point.value}) in {point.group}"
        remedy = f"; ask who made it, or uninstall {package}"
        try:
            one: Any = point.load()
        except Exception as err:
            why = f"which cannot be loaded: {type(err).__name__}: {err}"
            loaded.broken.append(f"{place}, {why}{remedy}")
            continue
        if not isinstance(one, kind):
            loaded.broken.append(f"{place}, which is no {kind.__name__}{remedy}")
        elif getattr(one, "name", "") in loaded.found:
            name = getattr(one, "name", "")
            loaded.broken.append(f"{place}, whose name {name!r} is taken{remedy}")
        else:
            loaded.found[getattr(one, "name", point.name)] = one


def _offered(group: str) -> tuple[list[tuple[str, EntryPoint]], list[tuple[str, EntryPoint]]]:
    """Return package and entry point of all that is offered, by ours and by other packages."""
    offered = [
        (point.dist.name if point.dist is not None else "unknown", point)
        for point in entry_points(group=group)
    ]
    here = [(OURS, point) for point in _checkout(group)]
    ours = here or [one for one in offered if one[0] == OURS]
    if not ours:
        msg = f"bulkcal offers nothing in {group}: its installation is broken; install it again"
        raise CaseError(msg)
    others = [one for one in offered if one[0] != OURS]
    ours, others = (sorted(part, key=lambda one: (one[0], one[1].name)) for part in (ours, others))
    return ours, others


def _checkout(group: str) -> list[EntryPoint]:
    """Return our entry points as the `pyproject.toml` beside this package has them, if one is."""
    path = Path(__file__).resolve().parents[1] / "pyproject.toml"
    try:
        project = tomllib.loads(path.read_text(encoding="utf-8"))["project"]
        table = project["entry-points"][group] if project["name"] == OURS else {}
    except (OSError, ValueError, KeyError, TypeError):
        return []
    return [EntryPoint(name, value, group) for name, value in table.items()]
