"""``run``, and the clock of steps."""

from __future__ import annotations

from math import ceil

from minidem.commands.command import COMMANDS
from minidem.errors import InputError
from minidem.run.engine import Engine
from minidem.run.restarts.handed_on import apply_restart
from minidem.words import Words
from minidem.world.fix import all_fixes
from minidem.world.world import World

MOST_STEPS = 2**31 - 1
"""Steps of one run, as in LIGGGHTS; more are asked for in several runs."""


@COMMANDS.register("run")
def _run(engine: Engine, words: Words) -> None:
    words.need(1, 'run N [upto] [every M "command"]')
    _go(engine, words.integer(), words)


@COMMANDS.register("run_time")
def _run_time(engine: Engine, words: Words) -> None:
    words.need(1, "run_time SECONDS [upto]")
    engine.world.need_box()
    steps = ceil(max(-1.0, min(words.number() / engine.world.dt, 2.0 * MOST_STEPS)))
    if not words.done():
        words.expect("upto")
        words = Words(["upto"], "run_time")
    _go(engine, steps, words)


def _go(engine: Engine, steps: int, words: Words) -> None:
    """Make steps as the words behind their number say."""
    world, every, anew = engine.world, 0, True
    lines: list[str] = []
    series: dict[str, int] = {}
    while not words.done():
        key = words.choice(("upto", "every", "pre", "post", "start", "stop"))
        if key == "upto":
            if steps < world.step:
                msg = f"run {steps} upto: step {world.step} is later already"
                raise InputError(msg)
            steps -= world.step
        elif key == "every":
            words.need(2, 'run N every M "command"')
            every, lines = words.interval(), words.rest()
        elif key in ("start", "stop"):
            series[key] = words.interval(least=0)
        elif key == "pre":
            anew = words.yes_no()
        else:
            words.yes_no()
    if not 0 <= steps <= MOST_STEPS:
        msg = f"run: {steps} steps; expected 0 to {MOST_STEPS}, as in LIGGGHTS"
        raise InputError(msg)
    first, last = series.get("start", world.step), series.get("stop", world.step + steps)
    if first > world.step or last < world.step + steps:
        steps_made = f"{world.step} to {world.step + steps}"
        msg = f"run: start {first} and stop {last} must enclose the steps {steps_made}"
        raise InputError(msg)
    # what changes over several runs (ramp and its like) counts from start to stop
    world.series = (first, last) if series else None
    try:
        engine.run(steps, every, lines, anew=anew)
    finally:
        world.series = None


@COMMANDS.register("timestep")
def _timestep(engine: Engine, words: Words) -> None:
    words.need(1, "timestep DT")
    # LIGGGHTS takes any number; with zero nothing moves, below it energy comes from nowhere
    engine.world.change_timestep(words.positive())


@COMMANDS.register("reset_timestep")
def _reset_timestep(engine: Engine, words: Words) -> None:
    words.need(1, "reset_timestep STEP")
    set_step(engine.world, words.interval(least=0))


def set_step(world: World, step: int) -> None:
    """Let a world go on from another step; fixes follow."""
    shift = step - world.step
    apply_restart(world, last=False)
    for fix in all_fixes(world):
        fix.steps_shifted(world, shift)
    world.state.shift_flights(shift)
    if world.set_up_at is not None:
        world.set_up_at += shift
    if world.seen is not None:
        world.seen.step += shift
    world.clock = step, max(0.0, world.time() + shift * world.dt)  # as in LIGGGHTS never below 0
    world.step += shift
