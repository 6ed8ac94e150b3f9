"""The engine: executes the commands of a script on a world."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any, TextIO

import numpy as np
from numpy.typing import NDArray

from minidem.errors import RunInterrupted, suggest
from minidem.fixes.insert import Insert, domain_of
from minidem.fixes.printing import PrintFix
from minidem.fixes.wall import MassFlow
from minidem.insertion import Stream
from minidem.output.quantities import COLUMNS, Quantities
from minidem.output.report import Report
from minidem.run.events import Event, RestartEvent, ThermoEvent, check_events
from minidem.run.restart import apply_restart, write_restart
from minidem.run.runner import Runner
from minidem.run.threads import Crew
from minidem.script import inside
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["Engine"]

_PER_ATOM = ("id", "type", "density", "diameter", "element")


class Engine:
    """Executes commands.

    Parameters
    ----------
    world : World
        The simulation.
    report : Report
        Log and screen.
    progress : callable or None
        Called with step and last step now and then.
    threads : int
        Threads that share every step.
    stop : callable or None
        Asked now and then whether to stop.
    """

    def __init__(
        self, world: World, report: Report, progress: Callable[[int, int], None] | None = None,
        threads: int = 1, stop: Callable[[], bool] | None = None,
    ) -> None:  # fmt: skip
        self.world = world
        self.report = report
        self.newton = True
        self.ghost_velocity = False
        self.current = ""
        self.loop_s = 0.0
        self.particle_steps = 0
        self.restored: tuple[dict[str, Any], dict[str, NDArray[Any]]] | None = None
        self.quantities = Quantities(world)
        self.stop = stop
        self._runner = Runner(world, progress, stop, crew=Crew(threads))
        self._files: dict[Path, TextIO] = {}

    # -- services for commands -------------------------------------------------------------------

    def tell(self, line: str) -> None:
        """Write a line to the screen only."""
        self.report.screen(line)

    def open_text(self, name: str) -> TextIO:
        """Open a text file of the case for writing; it stays open until the script ends."""
        path = inside(self.world.root, name)
        if path not in self._files:
            path.parent.mkdir(parents=True, exist_ok=True)
            self._files[path] = path.open("w")
        return self._files[path]

    def columns(self, words: Sequence[str]) -> tuple[str, ...]:
        """Check the column names of a dump.

        Raises
        ------
        ValueError
            With the nearest known name.
        """
        known = [*COLUMNS, *_PER_ATOM]
        for word in words:
            if word not in known and word[:2] not in ("c_", "f_", "v_"):
                msg = f"unknown dump column '{word}'{suggest(word, known)}"
                raise ValueError(msg)
        return tuple(words)

    def thermo_columns(self, words: Sequence[str]) -> tuple[str, ...]:
        """Check thermo keywords.

        Raises
        ------
        ValueError
            With the nearest known keyword.
        """
        for word in words:
            if not self.quantities.knows(word) and word[:2] not in ("c_", "f_", "v_"):
                near = suggest(word, self.quantities.keywords())
                msg = f"Invalid keyword in thermo_style custom command: '{word}'{near}"
                raise ValueError(msg)
        return tuple(words)

    def per_atom_value(self, word: str) -> float | Floats:
        """Return a number, an equal-style or an atom-style variable ``v_NAME``.

        Raises
        ------
        ValueError
            If the word is neither.
        """
        if word.startswith("v_"):
            if self.world.interpreter.variable_style(word[2:]) == "atom":
                values: Floats = self.world.interpreter.atom_values(word[2:])
                return values
            return float(self.world.interpreter.value(word[2:]))
        try:
            return float(word)
        except ValueError:
            msg = f"expected a number or a variable v_NAME, found '{word}'"
            raise ValueError(msg) from None

    # -- fixes -----------------------------------------------------------------------------------

    def fixes_changed(self) -> None:
        """Note that walls may have new numbers: histories follow their walls."""
        self.world.lists_valid = False

    # -- particles -------------------------------------------------------------------------------

    def delete(self, who: NDArray[np.int64], *, compress: bool) -> None:
        """Delete particles; ids become 1..n again unless `compress` is False."""
        world = self.world
        state = world.state
        keep = np.ones(state.n, bool)
        keep[who] = False
        order = np.flatnonzero(keep)
        if len(who):
            world.lists.keep_only(keep)
            state.drop_ranks([int(i) for i in who[np.argsort(state.rank[who])]])
        state.take(order)
        if compress:
            place = np.argsort(state.rank[: state.n])
            new = dict(zip(state.ids[place].tolist(), range(1, state.n + 1), strict=True))
            state.ids[place] = 1 + np.arange(state.n)
            for flow in world.of_kind(MassFlow):
                flow.doomed = {new[number] for number in flow.doomed if number in new}
            state.top_id = state.n

    def clear(self) -> None:
        """Forget box, particles, fixes and settings; variables and the log stay."""
        self.close()
        self._files.clear()
        fresh = World(self.world.root)
        kept = ("root", "log", "warn", "interpreter")
        for item in fields(World):
            if item.name not in kept:
                setattr(self.world, item.name, getattr(fresh, item.name))
        self.newton, self.ghost_velocity, self.restored = True, False, None
        self._runner = Runner(self.world, self._runner.progress, self.stop, crew=self._runner.crew)
        self.report.reset_formats()

    def reset_step(self, step: int) -> None:
        """Set the step counter."""
        shift = step - self.world.step
        apply_restart(self, last=False)
        for fix in self.world.of_kind(Insert):
            if fix.inserter is not None:
                fix.inserter.shift_steps(shift)
        self._shift_flights(shift)
        self.world.step = step

    def _shift_flights(self, shift: int) -> None:
        """Move the steps of particles in flight; they start anew from where they are.

        As in LIGGGHTS their time of flight is not reset, so that they jump ahead; and a stream
        that has not been set up since a restart has no velocity yet, so that they stand still.
        """
        state = self.world.state
        flight = state.flight[: state.n]
        flying = flight[:, 4] >= 0.0
        flight[flying, :3] = state.row[: state.n][flying, :3]
        flight[flying, 3:5] += shift
        for fix in self.world.of_kind(Insert):
            if isinstance(fix.inserter, Stream):
                flight[flying, 5:8] = fix.inserter.flight_velocity

    # -- running ---------------------------------------------------------------------------------

    def run(self, steps: int, every: int, lines: Sequence[str]) -> None:
        """Run a number of steps."""
        if every <= 0:
            self._run(steps)
            return
        last = self.world.step + steps
        while self.world.step < last:
            self._run(min(every, last - self.world.step))
            for line in lines:
                if line != "NULL":
                    self.world.interpreter.execute_line(line)

    def _run(self, steps: int) -> None:
        world = self.world
        self._check_settings()
        world.begin_step, world.end_step = world.step, world.step + steps
        apply_restart(self)
        try:
            self._runner.prepare()
            self.report.setup()
            inserts = world.of_kind(Insert)
            for insert in inserts:
                if insert.inserter is not None:
                    insert.inserter.setup(world.dt, domain_of(world))
                    for line in insert.inserter.take_messages():
                        self.report.line(line)
            self._runner.setup()
            events = self._events()
            self.quantities.run_start = time.perf_counter()
            self._first_output()
            started = time.perf_counter()
            try:
                self._runner.run(world.step + steps, events, inserts)
            except RunInterrupted as err:
                err.restart = self.forced_restart()
                raise
            self.loop_s += time.perf_counter() - started
            self.particle_steps += steps * world.state.n
            self._last_output()
            self.report.loop(time.perf_counter() - started, steps, world.state.n)
        finally:
            world.begin_step = world.end_step = None

    def forced_restart(self) -> str:
        """Write a restart file because the run stops early; return its name."""
        name = f"restart_forced_liggghts_{self.world.step}.data"
        write_restart(self, inside(self.world.root, name))
        self.report.warning("Forced restart written")
        return name

    def _check_settings(self) -> None:
        """Refuse what LIGGGHTS refuses at the start of a run."""
        switches = self.world.pair.switches
        if switches is not None and self.newton:
            msg = "Pair granular with shear history requires newton pair off; use 'newton off'"
            raise ValueError(msg)
        if not self.ghost_velocity:
            msg = (
                "Pair granular requires ghost atoms store velocity; "
                "use 'communicate single vel yes'"
            )
            raise ValueError(msg)

    def _events(self) -> list[Event]:
        """Return what happens at the end of steps, checks before output."""
        found: list[Event] = [
            *check_events(self.world),
            *self.world.of_kind(PrintFix),
            *self.world.dumps.values(),
        ]
        if self.world.thermo.every > 0:
            found.append(ThermoEvent(self))
        if self.world.restarts is not None:
            found.append(RestartEvent(self, *self.world.restarts))
        return found

    def keep_flow_markers(self, names: tuple[str, ...]) -> None:
        """Take the present markers of particles as those of these flow counters."""
        self._runner._flow_key = names

    def _first_output(self) -> None:
        world = self.world
        for dump in world.dumps.values():
            due = world.step % dump.every == 0 or dump.first
            if due and dump.last != world.step:
                dump.act(world, world.step)
        self.report.thermo_header(world.thermo.columns)
        self.thermo_line()

    def _last_output(self) -> None:
        world = self.world
        if world.begin_step != world.step and (
            world.thermo.every == 0 or world.step % world.thermo.every
        ):
            self.thermo_line()

    def thermo_line(self) -> None:
        """Write the thermo columns now."""
        columns = self.world.thermo.columns
        self.report.thermo(columns, [self._thermo_value(name) for name in columns])

    def _thermo_value(self, name: str) -> float:
        if self.quantities.knows(name):
            return self.quantities.thermo(name)
        if name.startswith("v_"):
            return float(self.world.interpreter.value(name[2:]))
        base, *indices = name.replace("]", "").split("[")
        numbers = tuple(int(i) for i in indices)
        if base.startswith("c_"):
            return self.quantities.compute_value(base[2:], numbers)
        return self.quantities.fix_value(base[2:], numbers)

    def close(self) -> None:
        """Close all files and let helping threads end."""
        self._runner.crew.close()
        for file in self._files.values():
            file.close()
