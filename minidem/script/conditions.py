"""Conditions of the ``if`` command.

LIGGGHTS compares plain numbers there: variables are substituted before, arithmetic belongs into
an equal-style variable or ``$(...)``.
"""

from __future__ import annotations

from minidem.script.formula import FormulaError, compile_formula
from minidem.script.operators import BINARY, sign

__all__ = ["condition_holds"]

_ARITHMETIC = frozenset("+*/^%")


def condition_holds(text: str) -> bool:
    """Evaluate a condition after substitution of variables.

    Parameters
    ----------
    text : str
        Numbers joined by ``== != < <= > >= && || !`` and parentheses.

    Raises
    ------
    FormulaError
        If it holds anything else.

    Examples
    --------
    >>> condition_holds("(3 >= 2) && !0")
    True
    """
    stack: list[float] = []
    for step in compile_formula(text):
        if step.kind == "num":
            stack.append(step.value)
        elif step.kind == "sign":
            stack.append(float(sign(step.text, stack.pop())))
        elif step.kind == "op" and step.text not in _ARITHMETIC and step.text != "-":
            right = stack.pop()
            stack.append(float(BINARY[step.text](stack.pop(), right)))
        else:
            msg = (
                f"condition '{text[:60]}' may only compare numbers, found '{step.text}'; "
                "compute it with $(...) first"
            )
            raise FormulaError(msg)
    return stack[0] != 0.0
