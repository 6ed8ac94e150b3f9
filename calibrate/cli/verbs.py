"""The verbs of `bulkcal`; the modules of a verb are loaded when it is asked for."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from importlib import import_module
from typing import Any, Final, NamedTuple

import typer
from typer.core import TyperGroup

__all__ = ["VERBS", "Verbs", "verbs_of"]


class _Verb(NamedTuple):
    """Where a verb is: a function, or a program of further verbs."""

    place: str
    help: str
    is_group: bool = False


VERBS: Final = {
    "generate": _Verb("cases:generate", "Write a case directory."),
    "run": _Verb("cases:run", "Run a case and show its observables."),
    "post": _Verb("output.post:post", "Measure a case, or any LIGGGHTS output."),
    "render": _Verb("output.render:render", "Draw a case, or any LIGGGHTS output."),
    "apparatus": _Verb("apparatus:apparatus", "Show what can be changed."),
    "check": _Verb("check:check", "Check a study, and say what it costs."),
    "export": _Verb("files.export:export", "Write the values for LIGGGHTS or others."),
    "init": _Verb("files.new_study:init", "Write a study to be filled in."),
    "migrate": _Verb("files.new_study:migrate", "Write an old study file anew."),
    "calibrate": _Verb("studies:calibrate_command", "Calibrate a study."),
    "demo": _Verb("studies:demo", "Calibrate the bundled study."),
    "diagnose": _Verb("diagnosis.command:diagnose", "Say what is still wrong."),
    "motion": _Verb("laboratory.motion:motion", "Fit cosines to a plate's motion."),
    "sensitivity": _Verb("sensitivity.command:sensitivity", "Say what moves what."),
    "status": _Verb("campaigns.status:status", "Say how far the runs are."),
    "runs": _Verb("campaigns.keep:runs", "Keep runs as a table."),
    "retry": _Verb("campaigns.retry:retry", "Let failed runs run again."),
    "challenge": _Verb(
        "challenge.command:app", "Hide causes and see whether they are found.", True
    ),
    "measured": _Verb("laboratory.measured:app", "Turn logs and numbers into targets.", True),
    "photo": _Verb("laboratory.photo:app", "Measure grains and heaps on photographs.", True),
}
"""In the order of the help."""


class _Loaded(Mapping[str, Any]):
    """All verbs, each loaded when it is asked for."""

    def __getitem__(self, name: str) -> Any:
        if name not in VERBS:
            raise KeyError(name)
        return _command(name)

    def __iter__(self) -> Iterator[str]:
        return iter(VERBS)

    def __len__(self) -> int:
        return len(VERBS)


class Verbs(TyperGroup):
    """A program whose verbs are loaded one by one."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(**settings)
        every: Any = _Loaded()
        self.commands = every

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write a line about every verb."""
        with formatter.section("Commands"):
            formatter.write_dl([(name, verb.help) for name, verb in VERBS.items()])


@cache
def _command(name: str) -> Any:
    """Load a verb; made once, as reading its options takes longer than many a verb."""
    verb = VERBS[name]
    module, _, function = verb.place.partition(":")
    found = getattr(import_module(f"calibrate.cli.{module}"), function)
    program = typer.Typer(rich_markup_mode=None, add_completion=False)
    program.callback()(_nothing)
    if verb.is_group:
        program.add_typer(found, name=name)
    else:
        program.command(name)(found)
    return typer.main.get_group(program).commands[name]


def _nothing() -> None:
    """Do nothing before the verb."""


def verbs_of(words: Iterable[str]) -> str:
    """Return the verb, or the two verbs, that a command line begins with, as far as known.

    Examples
    --------
    >>> verbs_of(["photo", "size", "a.png"]), verbs_of(["run", "heap"]), verbs_of(["-x"])
    ('photo size', 'run', '')
    """
    first, second, *_ = [*words, "", ""]
    if first not in VERBS:
        return ""
    further = _command(first).commands if VERBS[first].is_group else {}
    return f"{first} {second}" if second in further else first
