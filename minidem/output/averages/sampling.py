"""When averaging fixes take samples: every N steps, M of them before each multiple of a period."""

from __future__ import annotations

from minidem.errors import InputError
from minidem.record import record
from minidem.words import Words
from minidem.world.event import NEVER
from minidem.world.fix import Fix
from minidem.world.world import World

__all__ = ["SampledFix", "Sampling", "refuse_missed"]


@record
class Sampling:
    """The steps at which samples are taken.

    Attributes
    ----------
    every : int
        Steps between samples.
    repeat : int
        Samples of an average.
    period : int
        Steps between averages.
    first : int
        No average before this step.
    due : int
        Step of the next sample.
    taken : int
        Samples of the present average so far.
    """

    every: int
    repeat: int
    period: int
    first: int = 0
    due: int = -1
    taken: int = 0

    @classmethod
    def read(cls, words: Words) -> Sampling:
        """Read the three numbers."""
        made = cls(words.interval(), words.interval(), words.interval())
        if made.period % made.every or (made.repeat - 1) * made.every >= made.period:
            msg = (
                f"{made.repeat} samples, {made.every} steps apart, must fit into {made.period} "
                f"steps, a multiple of {made.every}"
            )
            raise InputError(msg)
        return made

    def restart(self, step: int) -> None:
        """Begin a new average if the next sample was due before a step."""
        if self.due >= step:
            return
        self.taken = 0
        due = (step // self.period + 1) * self.period
        while due < self.first:
            due += self.period
        if due - self.period == step and self.repeat == 1:
            due = step
        else:
            due -= (self.repeat - 1) * self.every
        self.due = due if due >= step else due + self.period

    def done(self, step: int) -> bool:
        """Note a sample; return True if it was the last of an average."""
        self.taken += 1
        if self.taken < self.repeat:
            self.due = step + self.every
            return False
        self.taken = 0
        self.due = step + self.period - (self.repeat - 1) * self.every
        return True

    def due_after(self, step: int) -> int:
        """Return the step of the next sample if all up to a step have been taken."""
        due, taken = self.due, self.taken
        due += max(0, (step - due) // self.period) * self.period
        while due <= step:
            taken = (taken + 1) % self.repeat
            due += self.every if taken else self.period - (self.repeat - 1) * self.every
        return due

    def next_step(self, step: int) -> int:
        """Return the step of the next sample after a step."""
        return self.due if self.due > step else NEVER


def refuse_missed(fix: Fix, due: int, step: int) -> None:
    """Refuse a ``reset_timestep`` to a step behind the next sample of a fix, as LIGGGHTS does.

    In a rehearsal no sample is taken, so that `due` is worked out anew.
    """
    if step > due:
        msg = (
            f"fix {fix.name} ({fix.style}) takes its next sample at step {due} and would miss it; "
            "unfix it before, and define it again"
        )
        raise InputError(msg)


@record
class SampledFix(Fix):
    """A fix that takes samples.

    Attributes
    ----------
    sampling : Sampling
        When it takes them.
    """

    sampling: Sampling

    def start(self, world: World) -> None:
        """Take a sample at the start of a run if one is due."""
        self.sampling.restart(world.step)
        if self.sampling.due == world.step:
            self.act(world)

    def next_step(self, step: int) -> int:
        """Return the step of the next sample."""
        return self.sampling.next_step(step)

    def steps_shifted(self, world: World, shift: int) -> None:
        """Keep the step of the next sample, as LIGGGHTS does."""
        refuse_missed(self, self.sampling.due_after(world.step), world.step + shift)
