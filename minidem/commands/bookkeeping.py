"""Commands that change neither motion nor output: how LIGGGHTS computes, and what grains lack."""

from __future__ import annotations

from minidem.commands.command import COMMANDS
from minidem.errors import InputError, UnknownWordError
from minidem.run.engine import Engine
from minidem.words import Words, integer

_MINIMIZERS = ("cg", "hftn", "sd", "quickmin", "fire")


def before_box(engine: Engine, command: str) -> None:
    """Refuse a command that stands behind ``create_box``.

    Raises
    ------
    InputError
        With the remedy.
    """
    if engine.world.box is not None:
        msg = f"{command} command after simulation box is defined; move it before create_box"
        raise InputError(msg)


def _ignored(engine: Engine, words: Words, what: str) -> None:
    """Pass over all words of a command that would change how LIGGGHTS computes."""
    words.rest()
    engine.world.warn(f"{what} is passed over: it changes how fast LIGGGHTS is, not what it finds")


@COMMANDS.register("processors")
def _processors(engine: Engine, words: Words) -> None:
    before_box(engine, "processors")
    words.take("a value")
    words.rest()


@COMMANDS.register("package")
def _package(engine: Engine, words: Words) -> None:
    before_box(engine, "package")
    words.choice(("cuda", "gpu", "omp"), "style")
    _ignored(engine, words, "package")


@COMMANDS.register("suffix")
def _suffix(engine: Engine, words: Words) -> None:
    words.take("on, off or a suffix")
    words.finish()
    _ignored(engine, words, "suffix")


@COMMANDS.register("modify_timing")
def _modify_timing(engine: Engine, words: Words) -> None:
    del engine
    words.choice(("on", "off", "verbose"), "value")


@COMMANDS.register("partition")
def _partition(engine: Engine, words: Words) -> None:
    words.need(3, "partition yes 1 COMMAND ...")
    wanted = words.yes_no()
    low, star, high = words.take("a partition").partition("*")
    first = integer(low, "partition") if low else 1
    last = first if not star else (integer(high, "partition") if high else 1)
    line = " ".join(_quoted(word) for word in words.rest())
    if (first <= 1 <= last) == wanted:
        engine.world.interpreter.execute_line(line)


def _quoted(word: str) -> str:
    """Return a word as it may stand in a line."""
    if word and not set(word) & set(" \t#'\"&"):
        return word
    return f"'{word}'" if '"' in word else f'"{word}"'


@COMMANDS.register("box")
def _box(engine: Engine, words: Words) -> None:
    before_box(engine, "box")
    words.expect("tilt")
    words.choice(("small", "large"), "tilt")


@COMMANDS.register("pair_modify")
def _pair_modify(engine: Engine, words: Words) -> None:
    del engine
    words.need(1, "pair_modify KEYWORD VALUE")
    while not words.done():
        key = words.choice(
            ("mix", "shift", "table", "table/disp", "tabinner", "tabinner/disp", "tail", "compute")
        )
        if key == "mix":
            words.choice(("geometric", "arithmetic", "sixthpower"), key)
        elif key in ("shift", "tail"):
            words.yes_no()
        elif key != "compute":
            words.number()
        elif not words.yes_no():
            msg = "pair_modify compute no is not supported; use neigh_modify exclude group all all"
            raise UnknownWordError(msg)


@COMMANDS.register("dielectric")
def _dielectric(engine: Engine, words: Words) -> None:
    del engine
    words.number()


@COMMANDS.register("kspace_style")
def _kspace_style(engine: Engine, words: Words) -> None:
    del engine
    words.choice(("none",), "style")


@COMMANDS.register("special_bonds", "min_modify")
def _of_bonds(engine: Engine, words: Words) -> None:
    del engine
    words.take("a keyword")
    words.rest()


@COMMANDS.register("run_style")
def _run_style(engine: Engine, words: Words) -> None:
    engine.world.need_box()
    words.choice(("verlet",), "style")


@COMMANDS.register("min_style")
def _min_style(engine: Engine, words: Words) -> None:
    engine.world.need_box()
    words.choice(_MINIMIZERS, "style")


@COMMANDS.register("write_restart_on_signal")
def _write_on_signal(engine: Engine, words: Words) -> None:
    if not words.yes_no():
        engine.world.warn("write_restart_on_signal no is passed over: a run that is stopped writes")


@COMMANDS.register("rotate")
def _rotate(engine: Engine, words: Words) -> None:
    words.rest()
    engine.world.warn("rotate does nothing, as in LIGGGHTS 3.8.0; see 'displace_atoms ... rotate'")


@COMMANDS.register("force_dt_reset")
def _force_dt_reset(engine: Engine, words: Words) -> None:
    del engine
    words.yes_no()
