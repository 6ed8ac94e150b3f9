"""Run a script from its first command to its last."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TextIO

from minidem.commands.command import COMMANDS
from minidem.errors import RunInterrupted
from minidem.memory import shortage
from minidem.output.report import Report
from minidem.rehearsal import execute_command, rehearse
from minidem.run.engine import Engine
from minidem.run.threads import MOST
from minidem.script import CaseFolder, Hooks, Interpreter, inside
from minidem.script.check.finding import Finding, refusal
from minidem.world.world import World

__all__ = ["RunSummary", "run_script"]


@dataclass(frozen=True)
class RunSummary:
    """What a script did.

    Attributes
    ----------
    steps : int
        Last step.
    particles : int
        Particles at the end.
    lost : int
        Particles that left through a fixed boundary.
    wall_s : float
        Wall-clock time, s.
    loop_s : float
        Part of it spent in run loops, s.
    particle_steps : int
        Sum over all steps of the number of particles.
    builds : int
        Neighbour-list builds.
    """

    steps: int
    particles: int
    lost: int
    wall_s: float
    loop_s: float
    particle_steps: int
    builds: int


def run_script(
    script: Path, *, root: Path | CaseFolder, variables: Mapping[str, Sequence[str]] | None = None,
    log: str | None = "log.liggghts", echo: str = "log", screen: TextIO | None = None,
    progress: Callable[[int, int], None] | None = None, threads: int = 1,
    stop: Callable[[], bool] | None = None, strict: bool = False,
) -> RunSummary:  # fmt: skip
    """Run a LIGGGHTS script.

    Parameters
    ----------
    script : Path
        Script file.
    root : Path or CaseFolder
        Relative paths in the script resolve against it; nothing outside is touched.
    variables : mapping of str to sequence of str, optional
        Values for ``variable ... index``, as ``-var`` gives them.
    log : str or None
        Log file in `root`, None for none.
    screen, echo : text file or None, str
        Where screen output goes; where commands are shown: none, screen, log or both.
    progress : callable, optional
        Called with step and last step of the current run now and then.
    threads : int
        Threads that share every step, 1 to 64; results of another number differ by rounding.
    stop : callable, optional
        Asked about twice a second whether to stop; all files are complete then.
    strict : bool
        Refuse the words that LIGGGHTS lacks, see `minidem.contact.extensions`.

    Raises
    ------
    ScriptError
        With file, line, word and remedy; unknown commands are found before the first step.
    SimulationError
        With step, particle and cause.
    OutputError
        If a file cannot be written; the ``errno`` of its ``__cause__`` tells a full disk.
    ResourceError
        If there is not enough memory.
    InputError
        If the log would lie outside of `root`.
    RunInterrupted, ValueError
        If `stop` said so; if the number of threads is none.
    """
    started, count = time.perf_counter(), _checked(threads)
    world = World(root if isinstance(root, CaseFolder) else CaseFolder(Path(root)))
    try:
        findings = rehearse(Path(script), world.root, variables or {}, strict=strict)
        with ExitStack() as open_files:  # from here on there is a log
            report = Report(inside(world.root, log) if log else None, screen, echo=echo)
            open_files.callback(report.close)
            engine = Engine(world, report, progress, count, stop)
            open_files.callback(engine.close)
            _interpret(engine, Path(script), variables or {}, stop, findings, strict=strict)
    except MemoryError as err:
        raise shortage(world.step, world.state.n) from err
    return RunSummary(
        world.step, world.state.n, world.lost, time.perf_counter() - started, engine.loop_s,
        engine.particle_steps, world.lists.builds,
    )  # fmt: skip


def _checked(threads: int) -> int:
    """Return a number of threads; ValueError if it is none."""
    if not 1 <= threads <= MOST:
        msg = f"threads: expected a number from 1 to {MOST}, found {threads}"
        raise ValueError(msg)
    return threads


def _interpret(
    engine: Engine, script: Path, variables: Mapping[str, Sequence[str]],
    stop: Callable[[], bool] | None, findings: Sequence[Finding], *, strict: bool,
) -> None:  # fmt: skip
    """Execute a script on an engine unless what was found in it forbids that."""
    world, report = engine.world, engine.report
    world.log, world.warn = report.line, report.warning
    hooks = Hooks(
        emit=report.line,
        echo=partial(_echo, engine, stop),
        warn=report.warning,
        strict=strict,
    )
    world.interpreter = Interpreter(
        script, root=world.root, variables=variables, context=engine.quantities, known=COMMANDS,
        hooks=hooks,
    )  # fmt: skip
    error = refusal(findings)
    if error is not None:
        raise error
    for finding in findings:
        if not (finding.skipped or finding.missing_file):
            too = ", as LIGGGHTS does" if finding.shared else ""
            report.warning(f"{finding.error}; the run stops if it gets to this line{too}")
    world.interpreter.run(partial(execute_command, engine, strict=strict))


def _echo(engine: Engine, stop: Callable[[], bool] | None, text: str) -> None:
    """Show a command before it is executed, or stop instead."""
    if stop is not None and stop():
        kept = engine.forced_restart() if engine.world.box else ""
        raise RunInterrupted(engine.world.step, kept)
    engine.report.echo(text)
