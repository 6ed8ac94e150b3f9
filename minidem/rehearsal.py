"""Rehearsal of a script on an engine that makes no steps and writes nothing."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from functools import partial
from pathlib import Path

import numpy as np

from minidem.commands.command import COMMANDS
from minidem.contact.extensions import refuse_extension
from minidem.errors import (
    DemError,
    OutputError,
    ResourceError,
    ScriptError,
    SimulationError,
    UnknownWordError,
)
from minidem.fixes.wet.liquid import provide_liquid
from minidem.output.dump import DUMPS, Dump
from minidem.output.report import Report
from minidem.output.thermo_words import THERMO
from minidem.run.engine import Engine
from minidem.run.ready import check_settings, check_values
from minidem.script import CaseFolder, Command, Interpreter
from minidem.script.check.finding import Finding
from minidem.script.check.notes import BOX
from minidem.script.check.rehearsal import Rehearsal, Stage
from minidem.script.formula import FormulaError
from minidem.script.names import HARMLESS, unknown
from minidem.words import Words, leading_numbers
from minidem.world.compute import COMPUTES
from minidem.world.fix import FIXES
from minidem.world.state import Box
from minidem.world.world import World

__all__ = ["execute_command", "rehearse"]


_TYPES = 64  # atom types of a box that stands in for one that cannot be made


class _IdleEngine(Engine):
    """An engine that counts steps instead of making them."""

    wrote = False
    """Whether a restart file would have been written, so that what is there now is an old one."""

    def run(self, steps: int, every: int, lines: Sequence[str], *, anew: bool = True) -> None:
        """Go to the last step at once; execute the lines of ``run every`` a single time."""
        world = self.world
        self.wrote = self.wrote or bool(world.restarts or world.restart_turns)
        begin, world.step = world.step, world.step + steps
        provide_liquid(world)
        with self.between(begin):
            for line in lines:
                if every > 0 and line != "NULL":
                    world.interpreter.execute_line(line)
        check_settings(world)
        check_values(world)

    def write_restart(self, pattern: str) -> None:
        """Write nothing."""
        del pattern
        self.wrote = True

    def write_data(self, pattern: str, shift: int) -> None:
        """Write nothing."""
        del pattern, shift

    def write_dump(self, dump: Dump) -> None:
        """Write nothing."""
        del dump


def _try(engine: _IdleEngine, strict: bool, command: Command) -> None:
    """Execute a command of a rehearsal; where the box is not to be had, put one in its place."""
    world = engine.world
    if command.name == "read_restart" and engine.wrote:
        _stand_in(world)
        msg = "this restart file is written by the script itself"
        raise ScriptError(command.file, command.line, msg) from FileNotFoundError()
    try:
        execute_command(engine, command, strict=strict)
    except DemError:
        if command.name in BOX:
            _stand_in(world)
        raise


def _stand_in(world: World) -> None:
    """Give a world a box, so that the words behind a box that is missing are still read."""
    if world.box is None:
        lo, hi = np.zeros(3), np.ones(3)
        world.box = Box(lo, hi, world.boundary, lo.copy(), hi.copy())
        world.types = _TYPES
        world.granular = True


class _Mute(Report):
    """A report without a log, whatever a script names."""

    def open_log(self, path: Path | None, *, append: bool) -> None:
        """Open nothing."""
        del path, append

    def open_thermo_log(self, path: Path | None, *, append: bool) -> None:
        """Open nothing."""
        del path, append


class _Prompter(Interpreter):
    """Answers the questions of fixes and commands about variables during a rehearsal."""

    def __init__(self, script: Path, rehearsal: Rehearsal, stage: Stage) -> None:
        super().__init__(
            script, root=stage.root, variables={}, context=stage.context, known=stage.known
        )
        self._variables = rehearsal.variables
        self._guessed = rehearsal.variables.unknown
        self._flow = rehearsal

    def variable_style(self, name: str) -> str | None:
        """Return the style of a variable; of one that may be there it is guessed."""
        return "equal" if name in self._guessed else super().variable_style(name)


def rehearse(
    script: Path, root: CaseFolder, variables: Mapping[str, Sequence[str]], *, strict: bool
) -> list[Finding]:
    """Go through a script as it would be executed, as far as it follows from itself.

    Parameters
    ----------
    script : Path
        The script.
    root : CaseFolder
        Folder of the case; nothing in it is changed.
    variables : mapping of str to sequence of str
        Values of the command line.
    strict : bool
        Refuse the words that LIGGGHTS lacks.

    Returns
    -------
    list of Finding
        Lines that cannot be carried out, in the order in which they are met.

    Raises
    ------
    ScriptError
        If a value of the command line is no variable, or the script cannot be read.
    """
    world = World(CaseFolder(root.top, root.here))
    engine = _IdleEngine(world, _Mute(None, None, echo="none"))
    stage = Stage(root, frozenset(COMMANDS), engine.quantities, frozenset(THERMO), strict)
    try:
        rehearsal = Rehearsal(stage, variables)
    except FormulaError as err:
        raise ScriptError(str(script), 0, f"-var: {err}") from err
    world.root = rehearsal.root
    world.interpreter = _Prompter(script, rehearsal, stage)
    found = rehearsal.find(script, partial(_try, engine, strict))
    engine.close()
    for one in found:
        if not one.error.line:
            raise one.error
    return found


def execute_command(engine: Engine, command: Command, *, strict: bool) -> None:
    """Execute one command of a script.

    Raises
    ------
    ScriptError
        With file and line of what is wrong with it.
    """
    if strict:
        refuse_extension(command)
    _check_style(command)
    try:
        engine.settled = engine.settled and command.name in HARMLESS
        engine.world.words_of_fixes.update(word for word in command.args if "f_" in word)
        with leading_numbers(partial(_tell_cut, engine, command), loose=_is_loose(command)):
            words = Words(command.args, command.name)
            COMMANDS[command.name](engine, words)
            words.finish()
    except (ScriptError, SimulationError, OutputError, ResourceError):
        raise
    except DemError as err:  # of a file that the command reads: say which command
        raise ScriptError(command.file, command.line, str(err)) from err


def _tell_cut(engine: Engine, command: Command, word: str, read: str) -> None:
    """Warn of a word of which only the number at its beginning is read."""
    place = f"{command.file}:{command.line}"
    engine.world.warn(f"{place}: '{word[:40]}' is read as {read[:40]}, as LIGGGHTS does")


_LOOSE = (
    "insert/", "particletemplate/", "particledistribution/", "massflow/", "check/timestep/",
)  # fmt: skip


def _is_loose(command: Command) -> bool:
    """Tell whether LIGGGHTS takes anything behind the numbers of a command."""
    style = "".join(command.args[2:3])
    if command.name == "fix":
        return style.startswith(_LOOSE)
    return command.name in ("run", "run_time", "reset_timestep")


_STYLES: Mapping[str, tuple[int, Collection[str]]] = {
    "fix": (2, FIXES), "compute": (2, COMPUTES), "dump": (2, DUMPS), "write_dump": (1, DUMPS),
}  # fmt: skip


def _check_style(command: Command) -> None:
    """Refuse an unknown style of a fix, compute or dump, and tell a gap from a typing mistake."""
    at, table = _STYLES.get(command.name, (0, ()))
    if not at or len(command.args) <= at or command.args[at] in table:
        return
    kind = command.name.removeprefix("write_")
    cause = UnknownWordError(unknown(kind, command.args[at], table))
    raise ScriptError(command.file, command.line, str(cause)) from cause
