"""What fixes of LIGGGHTS keep in its restart files, as the fixes of minidem take it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from minidem.run.restarts.binary import damaged
from minidem.run.restarts.liggghts_state import LiggghtsState

__all__ = ["fix_states"]

Translation = Callable[[LiggghtsState, str, list[float]], dict[str, Any]]


def fix_states(saved: LiggghtsState) -> dict[str, dict[str, Any]]:
    """Return style and state by the id of the fix, for styles whose state minidem continues."""
    found = {}
    styles = {name: style for name, (style, _) in saved.fixes.items()}
    styles.update({name: kept.style for name, kept in saved.kept.items()})
    for name, style in styles.items():
        translation = _TRANSLATIONS.get(style)
        if translation is not None:
            wrote = saved.fixes[name][1].tolist() if name in saved.fixes else []
            if len(wrote) < _LEAST.get(style, 0):
                continue
            if not all(abs(one) < _MOST for one in wrote):
                damaged(f"what fix {name} wrote makes no sense")
            found[name] = {"style": style, "state": translation(saved, name, wrote)}
    return found


def _insert(saved: LiggghtsState, name: str, wrote: list[float]) -> dict[str, Any]:
    """Return generator and counters; the step 0 means that nothing more comes."""
    del saved, name
    seed, inserted, _, following, mass = wrote[:5]
    return {
        "seed": seed, "inserted": inserted, "inserted_mass": mass,
        "next_step": following if following > 0 else -1.0,
    }  # fmt: skip


def _distribution(saved: LiggghtsState, name: str, wrote: list[float]) -> dict[str, Any]:
    del saved, name
    return {"seed": wrote[0]}


def _move_mesh(saved: LiggghtsState, name: str, wrote: list[float]) -> dict[str, Any]:
    """Return the clock; as in LIGGGHTS the axis of rotation is that of the script again."""
    del saved, name
    return {"clock": wrote[0]}


def _mass_flow(saved: LiggghtsState, name: str, wrote: list[float]) -> dict[str, Any]:
    """Return the counters; as in LIGGGHTS the number of particles begins at zero again."""
    del name
    mass, _, _, _, deleted_mass, deleted = wrote[:6]
    return {
        "mass": mass, "number": 0, "rates": [0.0, 0.0],
        "deleted_mass": deleted_mass, "deleted_number": int(deleted),
        "base": [saved.step, mass, 0],
    }  # fmt: skip


def _values(saved: LiggghtsState, name: str, wrote: list[float]) -> dict[str, Any]:
    """Return values per particle."""
    del wrote
    if name not in saved.kept or not len(saved.ids):
        return {}
    order = saved.ids.argsort()
    values = saved.of_atoms(name, int(saved.kept[name].size[0]) - 1)
    return {"ids": saved.ids[order].tolist(), "values": values[order].tolist(), "begun": True}


def _move(saved: LiggghtsState, name: str, wrote: list[float]) -> dict[str, Any]:
    """Return the beginning, and where the particles were then."""
    return _values(saved, name, wrote) | {"begun": int(wrote[0])}


_MOST: Final = 2.0**53  # beyond it not every whole number is a float64
_LEAST: Final = {
    "move/mesh": 1, "massflow/mesh": 6, "move": 1, "particledistribution/discrete": 1,
    "insert/pack": 5, "insert/stream": 5, "insert/rate/region": 5,
}  # fmt: skip
"""How many numbers a fix writes."""

_TRANSLATIONS: Final[dict[str, Translation]] = {
    "insert/pack": _insert,
    "insert/stream": _insert,
    "insert/rate/region": _insert,
    "particledistribution/discrete": _distribution,
    "move/mesh": _move_mesh,
    "massflow/mesh": _mass_flow,
    "property/atom": _values,
    "store/state": _values,
    "spring/self": _values,
    "move": _move,
}
