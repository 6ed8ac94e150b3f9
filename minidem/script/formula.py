"""Formulas of variables: text to a flat list of instructions.

Grammar, loosest first, every binary operator grouping to the left as in LIGGGHTS::

    or      : and ( '||' and )*
    and     : equal ( '&&' equal )*
    equal   : order ( '==' | '!=' order )*
    order   : sum ( '<' | '<=' | '>' | '>=' sum )*
    sum     : product ( '+' | '-' product )*
    product : power ( '*' | '/' | '%' power )*
    power   : unary ( '^' unary )*
    unary   : ( '-' | '!' )* primary
    primary : number | '(' or ')' | word '(' arguments ')' | word '[' index ']'* | word

A minus sign binds tighter than ``^``: ``-2^2`` is 4. The result is postfix code, so that its
evaluation needs no recursion and a long sum cannot exhaust the stack.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NoReturn

from minidem.errors import InputError, MistakeError
from minidem.record import record
from minidem.script.lexer import WHITESPACE

__all__ = ["FormulaError", "Instruction", "compile_formula", "number_of"]

MAX_LENGTH = 20_000
"""Longest formula in characters."""
MAX_DEPTH = 30
"""Deepest nesting of parentheses, function calls and signs."""

DIGITS = frozenset("0123456789")
LETTERS = frozenset("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ")
WORD = DIGITS | LETTERS | {"_"}

LEVELS: tuple[tuple[str, ...], ...] = (
    ("||",),
    ("&&",),
    ("==", "!="),
    ("<=", ">=", "<", ">"),
    ("+", "-"),
    ("*", "/", "%"),
    ("^",),
)
ARITY = {
    **dict.fromkeys(["sqrt", "exp", "ln", "log", "abs", "sin", "cos", "tan", "asin", "acos"], 1),
    **dict.fromkeys(["atan", "ceil", "floor", "round"], 1),
    **dict.fromkeys(["atan2", "ramp", "stagger", "vdisplace"], 2),
    **dict.fromkeys(["random", "normal", "logfreq", "stride", "swiggle", "cwiggle"], 3),
}
"""Number of arguments of each mathematical function."""

GROUP_FUNCTIONS = frozenset(
    [
        "count",
        "mass",
        "charge",
        "xcm",
        "vcm",
        "fcm",
        "bound",
        "gyration",
        "ke",
        "angmom",
        "torque",
        "inertia",
        "omega",
    ]
)

VECTOR_FUNCTIONS = frozenset(["sum", "min", "max", "ave", "trap"])
"""Functions of all elements of a compute or fix."""

MASKS = {"gmask": 1, "rmask": 1, "grmask": 2}
"""Functions that are 1 for the particles of a group, a region or both, and their arguments."""


class FormulaError(InputError):
    """Raised when a formula cannot be understood or evaluated."""


class NoValueError(FormulaError, MistakeError):
    """Raised for a variable that there is not, or a word that has no value here."""


@record(frozen=True)
class Instruction:
    """One step of the postfix code.

    Attributes
    ----------
    kind : str
        ``num``, ``op``, ``sign``, ``call``, ``group``, ``vector``, ``mask`` or ``word``.
    text : str
        Operator, function name or word.
    value : float
        The number of ``num``.
    args : tuple of str
        Plain words of a group function.
    indices : tuple of int
        Numbers in brackets.
    """

    kind: str
    text: str = ""
    value: float = 0.0
    args: tuple[str, ...] = ()
    indices: tuple[int, ...] = ()


@lru_cache(maxsize=4096)
def compile_formula(text: str) -> tuple[Instruction, ...]:
    """Translate a formula to postfix code.

    Parameters
    ----------
    text : str
        Formula as the script has it.

    Returns
    -------
    tuple of Instruction

    Raises
    ------
    FormulaError
        With the place in the formula and what was expected.
    """
    if len(text) > MAX_LENGTH:
        msg = f"formula has {len(text)} characters, at most {MAX_LENGTH} are allowed"
        raise FormulaError(msg)
    parser = _Parser(text)
    parser.binary(0, 0)
    if parser.peek():
        parser.fail("an operator or the end of the formula")
    return tuple(parser.code)


class _Parser:
    """Recursive descent over one formula; appends to `code`."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.at = 0
        self.code: list[Instruction] = []

    def fail(self, expected: str) -> NoReturn:
        rest = self.text[self.at : self.at + 20]
        found = f"'{rest}'" if rest else "its end"
        msg = f"formula '{_short(self.text)}': expected {expected}, found {found}"
        raise FormulaError(msg)

    def peek(self) -> str:
        """Return the next character that is not blank, '' at the end."""
        while self.at < len(self.text) and self.text[self.at] in WHITESPACE:
            self.at += 1
        return self.text[self.at : self.at + 1]

    def take(self, chars: frozenset[str]) -> str:
        start = self.at
        while self.at < len(self.text) and self.text[self.at] in chars:
            self.at += 1
        return self.text[start : self.at]

    def binary(self, level: int, depth: int) -> None:
        """Parse one precedence level and all tighter ones."""
        if level == len(LEVELS):
            self.unary(depth)
            return
        self.binary(level + 1, depth)
        while op := self.operator(LEVELS[level]):
            self.binary(level + 1, depth)
            self.code.append(Instruction("op", op))

    def operator(self, choices: tuple[str, ...]) -> str:
        self.peek()
        for op in choices:
            if self.text.startswith(op, self.at):
                self.at += len(op)
                return op
        return ""

    def unary(self, depth: int) -> None:
        signs: list[str] = []
        while (char := self.peek()) in ("-", "!") and char:
            signs.append(char)
            self.at += 1
        self.primary(depth)
        self.code.extend(Instruction("sign", sign) for sign in reversed(signs))

    def primary(self, depth: int) -> None:
        if depth > MAX_DEPTH:
            msg = f"formula '{_short(self.text)}' is nested deeper than {MAX_DEPTH} levels"
            raise FormulaError(msg)
        char = self.peek()
        if char == "(":
            self.at += 1
            self.binary(0, depth + 1)
            self.expect(")")
        elif char and (char in DIGITS or char == "."):
            self.number()
        elif char and char in LETTERS:
            self.word(depth)
        else:
            self.fail("a number, a name or '('")

    def expect(self, char: str) -> None:
        if self.peek() != char:
            self.fail(f"'{char}'")
        self.at += 1

    def number(self) -> None:
        start = self.at
        self.take(DIGITS | {"."})
        if self.text[self.at : self.at + 1] in ("e", "E"):
            self.at += 1
            if self.text[self.at : self.at + 1] in ("+", "-"):
                self.at += 1
            self.take(DIGITS)
        text = self.text[start : self.at]
        try:
            value = float(text)
        except ValueError as err:
            msg = f"'{text[:40]}' in formula '{_short(self.text)}' is not a number"
            raise FormulaError(msg) from err
        self.code.append(Instruction("num", value=value))

    def word(self, depth: int) -> None:
        word = self.take(WORD)
        char = self.text[self.at : self.at + 1]
        if char == "(":
            self.at += 1
            self.call(word, depth)
            return
        indices: list[int] = []
        while self.text[self.at : self.at + 1] == "[":
            self.at += 1
            indices.append(self.index())
        self.code.append(Instruction("word", word, indices=tuple(indices)))

    def index(self) -> int:
        digits = self.take(DIGITS)
        if not digits or self.text[self.at : self.at + 1] != "]" or int(digits[:10]) == 0:
            self.fail("a positive index and ']'")
        self.at += 1
        return int(digits[:10])

    def call(self, word: str, depth: int) -> None:
        if word in GROUP_FUNCTIONS:
            self.code.append(Instruction("group", word, args=self.plain_arguments()))
            return
        if word in VECTOR_FUNCTIONS or word in MASKS:
            args, wanted = self.plain_arguments(), MASKS.get(word, 1)
            if len(args) != wanted:
                msg = f"function {word} takes {wanted} argument(s), got {len(args)}"
                raise FormulaError(msg)
            kind = "mask" if word in MASKS else "vector"
            self.code.append(Instruction(kind, word, args=args))
            return
        if word not in ARITY:
            msg = f"unknown function '{word[:40]}' in formula '{_short(self.text)}'"
            raise FormulaError(msg)
        count = 1
        self.binary(0, depth + 1)
        while self.peek() == ",":
            self.at += 1
            count += 1
            self.binary(0, depth + 1)
        self.expect(")")
        if count != ARITY[word]:
            msg = f"function {word} takes {ARITY[word]} argument(s), got {count}"
            raise FormulaError(msg)
        self.code.append(Instruction("call", word))

    def plain_arguments(self) -> tuple[str, ...]:
        stop = self.text.find(")", self.at)
        if stop < 0:
            self.fail("')'")
        words = tuple(word.strip(WHITESPACE) for word in self.text[self.at : stop].split(","))
        self.at = stop + 1
        return words


def number_of(name: str, text: str) -> float:
    """Return the text of a variable as a number; FormulaError if it is none."""
    try:
        return float(text.replace("_", "?"))
    except ValueError as err:
        msg = f"variable {name} is '{text[:40]}', which is not a number"
        raise FormulaError(msg) from err


def _short(text: str) -> str:
    return text if len(text) <= 60 else text[:57] + "..."
