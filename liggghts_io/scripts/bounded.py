"""The filters and functions of a stranger's template: each comes to an end, and is counted.

Filters of Jinja are here without what may take any time or memory: attributes, which a text of
thousands of parts names for every item, bases of numbers, and places behind the decimal point by
the million.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any, Final

import jinja2
from jinja2.runtime import Context

from liggghts_io.errors import CaseError
from liggghts_io.scripts.budget import LONGEST, MOST_ITEMS, Budget, refuse, within
from liggghts_io.scripts.filters import FILTERS, prime_seeds

BUDGET: Final = "_budget"
"""Name under which a template finds what it may still spend."""

_MOST_SEEDS: Final = 200
_MOST_PLACES: Final = 15  # a number has no more digits
_JINJA: Final = jinja2.Environment(undefined=jinja2.StrictUndefined)
_WORDS: Final[Mapping[str, tuple[str, ...]]] = {
    "abs": (), "first": (), "float": ("default",), "int": ("default",), "last": (), "length": (),
    "list": (), "max": (), "min": (), "reverse": (), "round": ("precision", "method"),
    "sort": ("reverse",), "sum": (),
}  # fmt: skip
"""Filters of Jinja, with the words in brackets that each takes."""


def scalar(value: Any) -> Any:
    """Return what can be written into a script; refuse a list, which is written item by item.

    Raises
    ------
    CaseError
    """
    if isinstance(value, str | int | float | jinja2.Undefined):
        return value
    msg = f'a {type(value).__name__} cannot be written; use {{{{ x | map("number") | join(" ") }}}}'
    raise CaseError(msg)


def budget_of(context: Context) -> Budget:
    """Return what a template may still spend.

    Raises
    ------
    CaseError
        In a template that was imported without it.
    """
    budget = context.get(BUDGET)
    if not isinstance(budget, Budget):
        msg = "import with the words 'with context'"
        raise CaseError(msg)
    return budget


def counted(context: Context, made: Any) -> Any:
    """Return what was made in a template; look at the clock, and count texts and lists.

    Raises
    ------
    CaseError
        When it is larger than a script needs, or all together are.
    """
    budget = budget_of(context)
    if isinstance(within(made), str | list | tuple):
        budget.write(made)
    budget.look()
    return made


def numbers_up_to(*bounds: int) -> list[int]:
    """Return a range as a list, no longer than a script needs."""
    found = range(*bounds)
    if len(found) > MOST_ITEMS:
        refuse(f"range of {len(found)}")
    return list(found)


def joined(*parts: Any) -> str:
    """Return texts and numbers one behind the other."""
    return str(within("".join(str(scalar(part)) for part in parts)))


def _join(values: Iterable[Any], between: str = "") -> str:
    """Return the items of a list with a text between them."""
    items = [str(scalar(value)) for value in values]
    if sum(map(len, items)) + len(items) * len(between) > LONGEST:
        refuse(f"a text of more than {LONGEST} characters")
    return between.join(items)


def _few_seeds(seed: int, count: int) -> tuple[int, ...]:
    """Return `prime_seeds`, as many as a script may need."""
    if count > _MOST_SEEDS:
        refuse(f"{count} seeds")
    return prime_seeds(seed, count)


def _of_jinja(name: str, words: tuple[str, ...]) -> Callable[..., Any]:
    """Return a filter of Jinja that takes no other words than these."""

    def filtered(value: Any, *args: Any, **kwargs: Any) -> Any:
        odd = [f"the word {key!r}" for key in kwargs if key not in words]
        if len(args) > len(words):
            odd.append(f"{len(args)} values in brackets")
        if odd:
            known = f"takes only {' and '.join(words)}" if words else "takes nothing in brackets"
            msg = f"{name}: {' and '.join(odd)}; in a script it {known}"
            raise CaseError(msg)
        places = {**dict(zip(words, args, strict=False)), **kwargs}.get("precision", 0)
        if not isinstance(places, int) or abs(places) > _MOST_PLACES:
            msg = f"round: to {places} places; give a whole number up to {_MOST_PLACES}"
            raise CaseError(msg)
        made = _JINJA.call_filter(name, value, args, kwargs)
        return list(made) if isinstance(made, Iterator) else made

    return filtered


def _counting(filter_: Callable[..., Any]) -> Callable[..., Any]:
    """Return a filter that counts as a turn, and of which what it makes is counted."""

    @jinja2.pass_context
    def bounded(context: Context, *args: Any, **kwargs: Any) -> Any:
        budget_of(context).turn()
        return counted(context, filter_(*args, **kwargs))

    return bounded


@jinja2.pass_context
def _map(context: Context, values: Iterable[Any], name: str, *args: Any) -> list[Any]:
    """Return the items of a list, each through a filter."""
    if name not in FILTERS and name not in _WORDS:
        msg = f"map: no filter {name!r} in a script"
        raise CaseError(msg)
    call = context.environment.call_filter
    made = []
    for value in within(list(values)):
        made.append(call(name, value, args, context=context))
    return made


@jinja2.pass_context
def _turns(context: Context, values: Iterable[Any]) -> Iterator[Any]:
    """Yield the items of a loop; every turn counts."""
    budget = budget_of(context)
    for value in values:
        budget.turn()
        yield value


def _all_filters() -> dict[str, Callable[..., Any]]:
    every: dict[str, Any] = {name: _of_jinja(name, words) for name, words in _WORDS.items()}
    every |= {**FILTERS, "prime_seeds": _few_seeds, "join": _join}
    every = {name: _counting(one) for name, one in every.items()}
    return {**every, "map": _map, "_counted": _turns, "_checked": jinja2.pass_context(counted)}


BOUNDED: Final = _all_filters()
"""Every filter that a stranger's template knows; those with ``_`` are put in by ourselves."""
