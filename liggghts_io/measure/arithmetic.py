"""Arithmetic with names, as people write it in a definition or in a script; nothing else runs."""

from __future__ import annotations

import ast
import math
import operator
from collections.abc import Callable, Mapping
from typing import Any, Final

from liggghts_io.errors import CaseError, nearest

_LONGEST: Final = 500  # characters
_LARGEST_POWER: Final = 100.0
_OPERATORS: Final[dict[type[ast.AST], Callable[[Any, Any], float]]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
}
_FUNCTIONS: Final[dict[str, Callable[..., float]]] = {
    "sqrt": math.sqrt, "sin": math.sin, "cos": math.cos, "tan": math.tan, "exp": math.exp,
    "ln": math.log, "ceil": math.ceil, "floor": math.floor, "round": round, "abs": abs,
    "min": min, "max": max,
}  # fmt: skip


def evaluate(text: str, names: Mapping[str, float]) -> float:
    """Return the value of a formula of numbers, names, + - * / ^, and functions such as sqrt.

    Parameters
    ----------
    text : str
    names : Mapping[str, float]

    Raises
    ------
    CaseError
        For anything else, with the nearest known name, and for a value that is not finite.

    Examples
    --------
    >>> evaluate("2 * radius_m ^ 2", {"radius_m": 3.0})
    18.0
    """
    formula = text.strip().replace("^", "**") if len(text) <= _LONGEST else ""
    try:
        value = _value(ast.parse(formula, mode="eval").body, names)
    except CaseError:
        raise
    except (
        SyntaxError,
        ValueError,
        ArithmeticError,
        TypeError,
        RecursionError,
        MemoryError,
    ) as err:
        msg = f"{text[:80]!r} has no value; write numbers, names, + - * / ^ and brackets"
        raise CaseError(msg) from err
    if not math.isfinite(value):
        msg = f"{text[:80]!r} is not a finite number"
        raise CaseError(msg)
    return value


def _value(node: ast.AST, names: Mapping[str, float]) -> float:
    match node:
        case ast.Constant(value=int() | float() as number) if not isinstance(number, bool):
            return float(number)
        case ast.Name(id=name):
            if name not in names:
                msg = f"unknown name {name!r}{nearest(name, sorted(names))}"
                raise CaseError(msg)
            return float(names[name])
        case ast.UnaryOp(op=ast.USub(), operand=inner):
            return -_value(inner, names)
        case ast.BinOp(left=left, op=sign, right=right) if type(sign) in _OPERATORS:
            one, other = _value(left, names), _value(right, names)
            if isinstance(sign, ast.Pow) and abs(other) > _LARGEST_POWER:
                raise ValueError(other)
            return float(_OPERATORS[type(sign)](one, other))
        case ast.Call(func=ast.Name(id=name), args=args, keywords=[]) if name in _FUNCTIONS:
            return float(_FUNCTIONS[name](*(_value(one, names) for one in args)))
    raise ValueError(ast.dump(node))
