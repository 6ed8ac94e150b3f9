"""The engine: executes the commands of a script on a world."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial

from minidem.computes.energy import Kinetic
from minidem.computes.temperature import Temperature
from minidem.errors import RunInterrupted
from minidem.fixes.wet.liquid import provide_liquid
from minidem.output.dump import Dump
from minidem.output.quantities import Quantities
from minidem.output.report import Report
from minidem.run.boundaries import follow_particles
from minidem.run.losses import LossWatch
from minidem.run.new_lists import Asked, forget_contacts, lists_asked
from minidem.run.ready import check_ready
from minidem.run.restarts.handed_on import apply_restart
from minidem.run.runner import Runner
from minidem.run.threads import Crew
from minidem.script import inside
from minidem.world.event import Scheduled
from minidem.world.fix import all_fixes
from minidem.world.world import World

__all__ = ["Engine"]

_WITH_PLAN = 2  # lines of thermo output of a run in which its schedule had a step
_USUAL = (("thermo_temp", "temp", Temperature), ("thermo_kin_eng", "ke", Kinetic))


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

    Attributes
    ----------
    loop_s : float
        Wall-clock time spent in run loops, s.
    particle_steps : int
        Sum over all steps of the number of particles.
    settled : bool
        Whether nothing has changed since the last run that another one has to be set up for.
    """

    def __init__(
        self, world: World, report: Report, progress: Callable[[int, int], None] | None = None,
        threads: int = 1, stop: Callable[[], bool] | None = None,
    ) -> None:  # fmt: skip
        self.world = world
        self.report = report
        self.loop_s = 0.0
        self.particle_steps = 0
        self.settled = False
        self._asked: Asked | None = None
        self.quantities = Quantities(world)
        self._lines, self._last_line = 0, -1  # of thermo output: in this run, and at which step
        self._losses = LossWatch()
        self._runner = Runner(world, progress, stop, crew=Crew(threads))
        self._add_usual()

    def _add_usual(self) -> None:
        """Add the computes that every script of LIGGGHTS begins with."""
        everyone = self.world.bit("all")
        for name, style, kind in _USUAL:
            self.world.computes[name] = kind(name, style, everyone)

    def clear(self) -> None:
        """Forget box, particles, fixes and settings; variables and the log stay."""
        self.world.clear()
        before = self._runner
        before.crew.close()
        self._runner = Runner(self.world, before.progress, before.stop, crew=before.crew)
        self._asked, self.settled = None, False
        self.report.reset_formats()
        self._add_usual()

    def close(self) -> None:
        """Close all files and let helping threads end."""
        self._runner.crew.close()
        self.world.close()

    # -- running ---------------------------------------------------------------------------------

    def run(self, steps: int, every: int, lines: Sequence[str], *, anew: bool = True) -> None:
        """Run a number of steps; after each `every` of them execute some lines, 0 for never.

        Without `anew` the forces of the last step are gone on with, as with ``pre no``.
        """
        if every <= 0:
            self._run(steps, anew=anew or self._one_begins_anew())
            return
        world, last, first = self.world, self.world.step + steps, True
        while world.step < last:
            begin = world.step
            self._run(min(every, last - begin), anew=anew or first)
            first = False
            with self.between(begin):
                for line in lines:
                    if line != "NULL":
                        world.interpreter.execute_line(line)

    @contextmanager
    def between(self, begin: int) -> Iterator[None]:
        """Execute lines of ``run every``: as in LIGGGHTS the run from `begin` is not over then."""
        world = self.world
        world.begin_step, world.end_step = begin, world.step
        try:
            yield
        finally:
            world.begin_step = world.end_step = None

    def _one_begins_anew(self) -> bool:
        """Tell whether a fix begins with every run, and say so."""
        for fix in all_fixes(self.world):
            if fix.begins_with_run:
                self.world.warn_once(
                    f"run ... pre no: fix {fix.name} ({fix.style}) begins with every run, so that "
                    "everything is set up; LIGGGHTS goes to the sizes of the run before once more"
                )
                return True
        return False

    def _run(self, steps: int, *, anew: bool) -> None:
        world = self.world
        if not (anew or self.settled) and self._asked is not None:
            world.warn_once(
                "run ... pre no: something has changed since the run before, so that everything is "
                "set up; LIGGGHTS goes on with forces and lists that do not know of it"
            )
        check_ready(world)
        world.begin_step, world.end_step = world.step, world.step + steps
        provide_liquid(world)
        apply_restart(world)
        self._losses.start(world)
        for dump in world.dumps.values():
            dump.begin(world)
        try:
            if anew or not self.settled:
                self._set_up()
            written = self._schedule()
            world.run_start = time.perf_counter()
            self._first_output()
            for one in written:
                one.plan(world)
            started = time.perf_counter()
            try:
                self._runner.run(world.step + steps, [*all_fixes(world), *written])
            except RunInterrupted as err:
                err.restart = self.forced_restart()
                raise
            self.loop_s += time.perf_counter() - started
            self.particle_steps += steps * world.state.n
            self.settled = True
            self._last_output()
            self.report.loop(time.perf_counter() - started, steps, world.state.n)
        finally:
            world.begin_step = world.end_step = None

    def _set_up(self) -> None:
        """Make lists and forces."""
        world = self.world
        world.set_up_at = world.step
        for compute in world.computes.values():
            compute.begin(world)
        asked = lists_asked(world)
        forget_contacts(world, self._asked or asked, asked)
        self._asked = asked
        self._runner.prepare()
        self.report.setup()
        follow_particles(world)  # an insertion measures its region in the box that this makes
        for fix in all_fixes(world):
            fix.setup(world)
        self._runner.setup()
        for compute in world.computes.values():
            compute.start(world)
        for fix in all_fixes(world):
            fix.start(world)

    def _schedule(self) -> list[Scheduled]:
        """Return what is written at the end of steps."""
        world = self.world
        found = [
            Scheduled(one.schedule, f"dump_modify {one.name} every", partial(one.act, world))
            for one in world.dumps.values()
        ]
        self._lines = 0
        found.append(Scheduled(world.thermo.schedule, "thermo", self.thermo_line))
        if world.restarts is not None:
            schedule, path = world.restarts
            found.append(Scheduled(schedule, "restart", partial(self.write_restart, path)))
        if world.restart_turns is not None:
            found.append(Scheduled(world.restart_turns[0], "restart", self._write_in_turns))
        return found

    # -- output ----------------------------------------------------------------------------------

    def write_restart(self, pattern: str) -> None:
        """Write a restart file; the first ``*`` of its name becomes the step.

        ``%``, for which LIGGGHTS has a file of each process and one called base, becomes base.
        """
        self._keep(pattern.replace("*", str(self.world.step), 1).replace("%", "base", 1))

    def _keep(self, name: str) -> None:
        from minidem.run.restarts.own_file import write_restart  # few scripts do

        write_restart(self.world, inside(self.world.root, name))

    def write_data(self, pattern: str, shift: int) -> None:
        """Write a data file; the first ``*`` of its name becomes the step."""
        from minidem.output.data_file import write_data  # few scripts do

        name = pattern.replace("*", str(self.world.step), 1)
        self.report.screen("System init for write_data ...")
        follow_particles(self.world)
        write_data(self.world, inside(self.world.root, name), shift)

    def write_dump(self, dump: Dump) -> None:
        """Write a snapshot now."""
        dump.act(self.world)

    def _write_in_turns(self) -> None:
        """Write the restart file that was not written last; no ``*`` of its name is a step."""
        turns = self.world.restart_turns
        if turns is not None:
            self._keep(turns[1][0].replace("%", "base", 1))
            turns[1].reverse()

    def forced_restart(self) -> str:
        """Write a restart file because the run stops early; return its name."""
        name = f"restart_forced_liggghts_{self.world.step}.data"
        self.write_restart(name)
        self.report.warning("Forced restart written")
        return name

    def _first_output(self) -> None:
        world = self.world
        for dump in world.dumps.values():
            if dump.due_at_start(world.step):
                dump.act(world)
        world.thermo.marks.clear()
        self.report.thermo_header(self._columns(), several=world.thermo.several)
        self.thermo_line()

    def _columns(self) -> tuple[str, ...]:
        """Return the columns of the thermo output."""
        thermo = self.world.thermo
        if thermo.custom:
            return thermo.columns
        grows = any(set(face) & set("sm") for face in self.world.need_box().boundary)
        return (*thermo.columns, "vol") if grows else thermo.columns

    def _last_output(self) -> None:
        """Write a line for the last step if there is none yet.

        As in LIGGGHTS there is none, either, if a variable named no step of the run.
        """
        world = self.world
        unplanned = world.thermo.schedule.variable and self._lines < _WITH_PLAN
        if self._last_line != world.step and not unplanned:
            self.thermo_line()

    def thermo_line(self) -> None:
        """Write the thermo columns now."""
        self._lines, self._last_line = self._lines + 1, self.world.step
        warning = self._losses.look(self.world)
        if warning:
            self.report.screen("WARNING: " + warning)
        values = [self.quantities.thermo_value(name) for name in self._columns()]
        self.report.thermo(values, self.world.step, self.quantities.thermo("cpu"))
