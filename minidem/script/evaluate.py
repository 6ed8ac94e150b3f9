"""Evaluation of compiled formulas."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import cast

import numpy as np
from numpy.typing import NDArray

from minidem.errors import InputError, UnknownNameError
from minidem.script.context import Context
from minidem.script.formula import FormulaError, Instruction, compile_formula
from minidem.script.marsaglia import Marsaglia
from minidem.script.operators import BINARY, FUNCTIONS, OF_ELEMENTS, SERIES, Value, sign

__all__ = ["Evaluator"]

MAX_WORK = 200_000
"""Instructions one evaluation may execute, those of nested variables included."""

ATOM_VECTORS = frozenset(
    [
        "id",
        "mass",
        "type",
        "x",
        "y",
        "z",
        "vx",
        "vy",
        "vz",
        "fx",
        "fy",
        "fz",
        "omegax",
        "omegay",
        "omegaz",
        "tqx",
        "tqy",
        "tqz",
        "r",
        "density",
    ]
)


class Evaluator:
    """Evaluates formulas against a context.

    Parameters
    ----------
    context : Context
        Answers thermo keywords, group functions, computes, fixes and per-particle properties.
    variable : callable
        ``variable(name, per_atom)``: value of another variable.
    """

    def __init__(self, context: Context, variable: Callable[[str, bool], Value]) -> None:
        self._context = context
        self._variable = variable
        self._random: dict[bool, Marsaglia] = {}
        self._work = 0

    def evaluate(self, text: str, *, per_atom: bool = False, nested: bool = False) -> Value:
        """Return the value of a formula.

        Parameters
        ----------
        text : str
            The formula.
        per_atom : bool
            Whether it may use per-particle values; the result may then be an array.
        nested : bool
            Whether this is part of the evaluation of another formula (they share one budget).

        Returns
        -------
        float or (N,) ndarray

        Raises
        ------
        FormulaError
            If the formula is not understood or has no value.
        """
        if not nested:
            self._work = 0
        code = compile_formula(text)
        self._work += len(code)
        if self._work > MAX_WORK:
            msg = f"evaluation needs more than {MAX_WORK} operations; simplify nested variables"
            raise FormulaError(msg)
        stack: list[Value] = []
        for step in code:
            self._execute(step, stack, per_atom)
        return stack[0]

    def _execute(self, step: Instruction, stack: list[Value], per_atom: bool) -> None:
        if step.kind == "num":
            stack.append(step.value)
        elif step.kind == "op":
            right = stack.pop()
            stack[-1] = BINARY[step.text](stack[-1], right)
        elif step.kind == "sign":
            stack[-1] = sign(step.text, stack[-1])
        elif step.kind == "call":
            self._call(step.text, stack, per_atom)
        elif step.kind == "group":
            stack.append(self._ask(lambda: self._context.group_value(step.text, step.args), step))
        elif step.kind == "vector":
            stack.append(self._of_elements(step))
        elif step.kind == "mask":
            stack.append(self._mask(step, per_atom))
        else:
            stack.append(self._word(step, per_atom))

    def _ask(self, question: Callable[[], Value], step: Instruction) -> Value:
        """Put a question to the context and name the word if it has no answer."""
        shown = step.text + "".join(f"[{i}]" for i in step.indices)
        try:
            return question()
        except FormulaError:
            raise
        except UnknownNameError as err:
            msg = f"'{shown}' is not known in a formula: {err}"
            raise FormulaError(msg) from err
        except InputError as err:
            msg = f"'{shown}': {err}"
            raise FormulaError(msg) from err

    def _word(self, step: Instruction, per_atom: bool) -> Value:
        word, context = step.text, self._context
        if word == "PI":
            return math.pi
        if word[:2] in ("c_", "f_"):
            return self._ask(lambda: self._reference(step, per_atom), step)
        if word.startswith("v_"):
            if step.indices:
                vector = self._variable(word[2:], True)
                return self._ask(lambda: self._of_atom(np.asarray(vector), step.indices[0]), step)
            return self._variable(word[2:], per_atom)
        if step.indices and word in ATOM_VECTORS:
            vector = self._ask(lambda: context.atom_vector(word), step)
            return self._ask(lambda: self._of_atom(np.asarray(vector), step.indices[0]), step)
        if word in ATOM_VECTORS:
            if not per_atom:
                msg = f"'{word}' has one value per particle; use a variable of style atom"
                raise FormulaError(msg)
            return self._ask(lambda: context.atom_vector(word), step)
        return self._ask(lambda: context.thermo(word), step)

    def _of_elements(self, step: Instruction) -> float:
        """Return a function of all elements of a compute or fix."""
        word = step.args[0]
        if word[:2] not in ("c_", "f_"):
            msg = f"{step.text}({word[:40]}): expected c_ID or f_ID, or a column c_ID[2]"
            raise FormulaError(msg)
        values = np.asarray(self._ask(lambda: self._context.elements(word), step))
        if step.text == "trap":
            return float(values.sum() - 0.5 * (values[0] + values[-1])) if len(values) > 1 else 0.0
        return float(OF_ELEMENTS[step.text](values))

    def _mask(self, step: Instruction, per_atom: bool) -> Value:
        """Return 1 for the particles of a group, a region or both, 0 for the others."""
        shown = f"{step.text}({','.join(step.args)})"
        if not per_atom:
            msg = f"'{shown}' has one value per particle; use a variable of style atom"
            raise FormulaError(msg)
        return self._ask(lambda: self._context.atom_vector(shown), step)

    def _reference(self, step: Instruction, per_atom: bool) -> Value:
        kind, name = step.text[0], step.text[2:]
        if per_atom:
            shown = step.text + "".join(f"[{i}]" for i in step.indices)
            try:
                return self._context.atom_vector(shown)
            except UnknownNameError:
                pass
        ask = self._context.compute_value if kind == "c" else self._context.fix_value
        try:
            return ask(name, step.indices)
        except UnknownNameError:
            vector = self._of_particles(step)
            if vector is None:
                raise
        return self._of_atom(vector, step.indices[0])

    def _of_particles(self, step: Instruction) -> NDArray[np.float64] | None:
        """Return what ``c_ID[i]`` or ``c_ID[i][column]`` has for all particles, None if nothing."""
        name = step.text + "".join(f"[{i}]" for i in step.indices[1:])
        try:
            return np.asarray(self._context.atom_vector(name)) if step.indices else None
        except UnknownNameError:
            return None

    def _of_atom(self, vector: NDArray[np.float64], tag: int) -> float:
        """Return the value of the particle with id `tag`, 0 if there is none."""
        self._context.need_map()
        ids = self._context.atom_vector("id")
        found = np.flatnonzero(ids == tag)
        return float(np.broadcast_to(vector, ids.shape)[found[0]]) if found.size else 0.0

    def _call(self, name: str, stack: list[Value], per_atom: bool) -> None:
        function = FUNCTIONS.get(name)
        if function is not None:
            if name == "atan2":
                right = stack.pop()
                stack[-1] = function(stack[-1], right)
            else:
                stack[-1] = function(stack[-1])
            return
        if name in ("random", "normal"):
            seed = stack.pop()
            second = stack.pop()
            stack[-1] = self._draw(name, (stack[-1], second, seed), per_atom)
            return
        count = 3 if name in ("logfreq", "stride", "swiggle", "cwiggle") else 2
        values = [_plain(name, value) for value in stack[-count:]]
        del stack[-count:]
        # Per particle LIGGGHTS computes cwiggle where swiggle is written.
        stack.append(self._schedule("cwiggle" if per_atom and name == "swiggle" else name, values))

    def _draw(self, name: str, args: tuple[Value, ...], per_atom: bool) -> Value:
        low, high, seed = args
        if per_atom not in self._random:
            self._random[per_atom] = Marsaglia(_whole(name, float(np.asarray(seed).flat[0])))
        source = self._random[per_atom]
        draw = source.uniform if name == "random" else source.gaussian
        if not per_atom:
            return _spread(name, float(cast(float, low)), float(cast(float, high)), draw())
        count = self._context.atom_vector("id").size
        lows, highs = np.broadcast_to(low, count), np.broadcast_to(high, count)
        return np.array(
            [_spread(name, float(a), float(b), draw()) for a, b in zip(lows, highs, strict=True)]
        )

    def _schedule(self, name: str, values: list[float]) -> float:
        """Evaluate a function of the time step."""
        step = int(self._ask_thermo("step", name))
        if name in ("stagger", "logfreq", "stride"):
            return float(SERIES[name](step, *(_whole(name, value) for value in values)))
        begin = self._ask_thermo("beginstep", name)
        delta = step - begin
        if name == "ramp":
            end = self._ask_thermo("endstep", name)
            fraction = delta / (end - begin) if end > begin else 0.0
            return values[0] + fraction * (values[1] - values[0])
        elapsed = delta * self._ask_thermo("dt", name)
        if name == "vdisplace":
            return values[0] + values[1] * elapsed
        if values[2] == 0.0:
            msg = f"{name}: the period must not be zero"
            raise FormulaError(msg)
        angle = 2.0 * math.pi / values[2] * elapsed
        wave = math.sin(angle) if name == "swiggle" else 1.0 - math.cos(angle)
        return values[0] + values[1] * wave

    def _ask_thermo(self, keyword: str, function: str) -> float:
        try:
            return self._context.thermo(keyword)
        except UnknownNameError as err:
            msg = f"{function}() has a value only during a run"
            raise FormulaError(msg) from err


def _plain(name: str, value: Value) -> float:
    """Return an argument that must be one number, not one per particle."""
    if isinstance(value, np.ndarray) and value.ndim:
        msg = f"{name}(): an argument has one value per particle; it must be a number"
        raise FormulaError(msg)
    return float(value)


def _whole(name: str, value: float) -> int:
    """Return an argument of which only the whole part counts."""
    if not math.isfinite(value):
        msg = f"{name}(): an argument is {value:g}; it must be a finite number"
        raise FormulaError(msg)
    return int(value)


def _spread(name: str, a: float, b: float, number: float) -> float:
    return number * (b - a) + a if name == "random" else a + b * number
