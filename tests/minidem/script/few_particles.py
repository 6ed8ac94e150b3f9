"""A script language without an engine: three particles stand in for one."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from minidem.errors import InputError, UnknownNameError
from minidem.script import Command, EmptyContext, Hooks, Interpreter


class FewParticles(EmptyContext):
    """Three particles at step 20 of a run from 10 to 30."""

    def thermo(self, keyword):
        """Return thermo keywords."""
        values = {"step": 20.0, "beginstep": 10.0, "endstep": 30.0, "dt": 0.5, "atoms": 3.0}
        return _known(values, keyword)

    def group_value(self, function, args):
        """Return group functions."""
        if args[0] != "all":
            msg = f"unknown group '{args[0]}'"
            raise InputError(msg)
        return _known({"count": 3.0, "mass": 6.0}, function)

    def compute_value(self, id, indices):
        """Return computes."""
        return _known({("rke", ()): 1.5, ("red", (2,)): 7.0}, (id, indices))

    def fix_value(self, id, indices):
        """Return fixes."""
        return _known({("mf", (1,)): 0.25}, (id, indices))

    def atom_vector(self, name):
        """Return per-particle values."""
        vectors = {"id": [3, 1, 2], "x": [0.0, 1.0, 4.0], "vx": [1.0, -1.0, 2.0]}
        return np.array(_known(vectors, name), dtype=np.float64)


def _known(values, name):
    """Return a value as the engine's context does."""
    if name not in values:
        raise UnknownNameError(str(name))
    return values[name]


def execute(tmp_path: Path, text: str, known=("run", "fix", "log"), **options):
    """Run a script; return printed lines and the commands that reached the engine."""
    script = tmp_path / "in.script"
    script.write_text(text)
    printed: list[str] = []
    commands: list[Command] = []
    interpreter = Interpreter(
        script,
        root=tmp_path,
        variables=options.pop("variables", {}),
        context=options.pop("context", FewParticles()),
        known=known,
        hooks=Hooks(emit=printed.append, **options),
    )
    interpreter.check()
    interpreter.run(commands.append)
    return printed, commands


def printed(tmp_path: Path, text: str, **options) -> list[str]:
    return execute(tmp_path, text, **options)[0]
