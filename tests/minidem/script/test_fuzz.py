"""Any text is a script that runs, or an error with file and line: no crash, no hang, no escape."""

from __future__ import annotations

import contextlib

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from minidem.errors import ScriptError
from minidem.script import Command, EmptyContext, Hooks, Interpreter
from minidem.script.evaluate import Evaluator
from minidem.script.formula import FormulaError

# Long enough for a loaded machine; a hang would last for ever.
DEADLINE_MS = 5000

# fmt: off
WORDS = st.sampled_from([
    "variable", "equal", "atom", "index", "loop", "string", "if", "then", "elif", "else",
    "jump", "SELF", "label", "next", "include", "print", "file", "append", "shell", "quit",
    "run", "fix", "a", "b", "s", "${a}", "$b", "$(a+1)", "$(v_b)", "$", "{", "}", "(", ")",
    "&", "#", "'", '"', "1", "0", "1e9", "-3", "../x", "/etc/passwd", "in.script", "==", "&&",
    "v_a", "v_b", "sqrt(2)", "random(0,1,10007)", "\\", "é", "pad", "delete",
])
# fmt: on
LINE = st.lists(WORDS, min_size=1, max_size=8).map(" ".join)
SCRIPT = st.one_of(
    st.lists(LINE, max_size=12).map("\n".join),
    st.text(alphabet=st.characters(exclude_categories=["Cs"]), max_size=200),
)
# fmt: off
TOKENS = [
    "1", "2.5", "x", "vx", "PI", "(", ")", "+", "-", "*", "/", "^",
    "sqrt(", "ln(", "atan2(", ",", "&&", "!", "<", "0", "1e300",
]
# fmt: on
FORMULA = st.one_of(
    st.text("0123456789.eE+-*/^%()!&|<>=, xvc_[]abPI", max_size=60),
    st.lists(
        st.sampled_from(TOKENS),
        max_size=25,
    ).map("".join),
)


@settings(deadline=DEADLINE_MS, max_examples=150)
@given(text=SCRIPT)
def test_any_text_runs_or_is_refused(tmp_path_factory, text):
    top = tmp_path_factory.mktemp("fuzz")
    root = top / "case"
    root.mkdir()
    script = root / "in.script"
    script.write_text(text, encoding="utf-8")
    commands: list[Command] = []

    def execute(command: Command) -> None:
        commands.append(command)
        if len(commands) > 200:
            raise ScriptError(command.file, command.line, "enough")

    try:
        interpreter = Interpreter(
            script,
            root=root,
            variables={},
            context=EmptyContext(),
            known=["run", "fix"],
            hooks=Hooks(),
        )
        interpreter.check()
        interpreter.run(execute)
    except ScriptError as error:
        place = (error.file, error.line)
    else:
        place = (str(script), 0)
    assert place[0]
    assert place[1] >= 0
    assert [path.name for path in top.iterdir()] == ["case"], "a file outside the root"
    assert all(isinstance(command.name, str) for command in commands)


class OneParticle(EmptyContext):
    """Knows x and vx of two particles."""

    def atom_vector(self, name):
        """Return two values."""
        values = {"id": [1.0, 2.0], "x": [0.0, 3.0], "vx": [-1.0, 2.0]}
        return np.array(values[name]) if name in values else super().atom_vector(name)


@settings(deadline=DEADLINE_MS, max_examples=300)
@given(text=FORMULA, per_atom=st.booleans())
def test_any_formula_has_a_value_or_an_error(text, per_atom):
    evaluator = Evaluator(OneParticle(), lambda name, per_atom: 1.0)
    try:
        value = evaluator.evaluate(text, per_atom=per_atom)
    except FormulaError:
        return
    assert isinstance(value, float | np.ndarray)


@settings(deadline=DEADLINE_MS, max_examples=60)
@given(
    numbers=st.lists(st.floats(-1e3, 1e3, allow_subnormal=False), min_size=2, max_size=12),
    signs=st.data(),
)
def test_sums_and_products_equal_those_of_python(numbers, signs):
    operators = [signs.draw(st.sampled_from("+-*")) for _ in numbers[1:]]
    text = f"({numbers[0]!r})" + "".join(
        f"{operator}({number!r})" for operator, number in zip(operators, numbers[1:], strict=True)
    )
    total, product, pending = 0.0, numbers[0], "+"
    for operator, number in zip([*operators, "+"], [*numbers[1:], 0.0], strict=True):
        if operator == "*":
            product = product * number
        else:
            total = total + product if pending == "+" else total - product
            product, pending = number, operator
    evaluator = Evaluator(EmptyContext(), lambda name, per_atom: 0.0)
    assert evaluator.evaluate(text) == total + 0.0


@settings(deadline=DEADLINE_MS, max_examples=40)
@given(depth=st.integers(1, 4000), kind=st.sampled_from(["(", "-", "!", "sqrt(", "1+", "2^"]))
def test_deep_and_long_formulas_end(depth, kind):
    close = ")" * depth if kind.endswith("(") else ""
    evaluator = Evaluator(EmptyContext(), lambda name, per_atom: 0.0)
    with contextlib.suppress(FormulaError):
        evaluator.evaluate(kind * depth + "1" + close)
