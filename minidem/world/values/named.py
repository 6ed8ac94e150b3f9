"""Names of computes, fixes and variables that have to be there where a command names them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from minidem.errors import MistakeError, suggest
from minidem.world.world import World

__all__ = ["need_map", "need_names"]

_STYLES: Final[dict[bool | None, tuple[str, ...]]] = {
    True: ("atom", "atomfile"), False: ("equal",), None: ("equal", "atom", "atomfile")
}  # fmt: skip
_SHOWN = 40  # characters of a name that a message shows


def need_names(world: World, what: str, words: Iterable[str], *, per_atom: bool | None) -> None:
    """Refuse names that nothing has yet; LIGGGHTS looks for them at once and stops.

    Parameters
    ----------
    world : World
        What there is.
    what : str
        The command, for messages.
    words : iterable of str
        Its inputs; of these ``c_ID`` and ``v_NAME`` are looked at, and ``f_ID`` where it is the
        fix itself that has the value.
    per_atom : bool or None
        Whether inputs have one value per particle; None if they may. A fix may then have such
        values under other names than its own, and is not looked for.

    Raises
    ------
    MistakeError
        For a name that is not there, or a variable of another style.
    """
    for word in words:
        kind, name = word[:2], word[2:].partition("[")[0]
        if kind == "v_":
            _need_variable(world, what, name, per_atom=per_atom)
        elif kind == "c_":
            _need(what, "compute", name, world.computes)
        elif kind == "f_" and per_atom is False:
            _need(what, "fix", name, world.fixes)


def _need(what: str, kind: str, name: str, known: Iterable[str]) -> None:
    """Refuse a name that is not known."""
    if name not in known:
        near = suggest(name, known)
        msg = f"{what}: there is no {kind} '{name[:_SHOWN]}'{near}; define it before this line"
        raise MistakeError(msg)


def _need_variable(world: World, what: str, name: str, *, per_atom: bool | None) -> None:
    """Refuse a variable that is not there, or of another style."""
    styles = world.interpreter.variable_styles()
    if world.interpreter.variable_style(name) is None:
        _need(what, "variable", name, styles)
    fitting = _STYLES[per_atom]
    style = styles.get(name, fitting[0])  # a rehearsal may know only that it may be there
    if style not in fitting:
        msg = (
            f"{what}: variable '{name[:_SHOWN]}' is of style {style}; expected "
            f"{' or '.join(fitting)}"
        )
        raise MistakeError(msg)


def need_map(world: World, what: str, kinds: tuple[str, ...] = ("array", "hash")) -> None:
    """Refuse what LIGGGHTS does only with an atom map, by which it finds particles by their ids.

    Parameters
    ----------
    world : World
        What there is.
    what : str
        What needs it, for messages.
    kinds : tuple of str
        Which maps will do.

    Raises
    ------
    MistakeError
        Without such a map.
    """
    if world.atom_map not in kinds:
        kind = f" of type '{kinds[0]}'" if len(kinds) == 1 else ""
        msg = f"{what} requires an atom map{kind}; give 'atom_modify map array' before create_box"
        raise MistakeError(msg)
