"""Render a template that a stranger wrote: it can reach nothing, and it comes to an end.

Only the parts of Jinja that a script needs are there, so that what is left can be bounded: no
macros, no changing of values, no attributes but those of loops and of an imported template. Every
list, text and number that is made, every turn of a loop and the time are counted.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping
from difflib import get_close_matches
from types import MappingProxyType
from typing import Any, Final

import jinja2
from jinja2 import nodes, sandbox
from jinja2.environment import TemplateModule
from jinja2.runtime import Context, LoopContext, Macro

from liggghts_io.errors import CaseError
from liggghts_io.scripts.bounded import (
    BOUNDED,
    BUDGET,
    budget_of,
    counted,
    joined,
    numbers_up_to,
    scalar,
)
from liggghts_io.scripts.budget import Budget
from liggghts_io.scripts.filters import GLOBALS
from liggghts_io.scripts.templating import RaiseTag, template_folder

COMMON: Final = "common.j2"

_TAGS: Final = (
    nodes.Template, nodes.Output, nodes.TemplateData, nodes.For, nodes.If, nodes.Assign,
    nodes.Import, nodes.CallBlock, nodes.ExtensionAttribute,
)  # fmt: skip
_EXPRESSIONS: Final = (
    nodes.Const, nodes.Name, nodes.List, nodes.Tuple, nodes.Call, nodes.Filter, nodes.Getitem,
    nodes.Getattr, nodes.Compare, nodes.Operand, nodes.And, nodes.Or, nodes.Not, nodes.Neg,
    nodes.Pos, nodes.Add, nodes.Sub, nodes.Mul, nodes.Div, nodes.FloorDiv, nodes.Mod,
    nodes.Pow, nodes.Concat, nodes.CondExpr, nodes.Test, nodes.Keyword,
)  # fmt: skip
_COUNTED: Final = (nodes.List, nodes.Tuple, nodes.Compare, nodes.Test)
"""What takes time and is neither a filter nor a call nor arithmetic, which look at the clock."""


class _Sandbox(sandbox.ImmutableSandboxedEnvironment):
    """Jinja without the ways to reach anything or to go on for ever."""

    intercepted_binops = frozenset({"+", "-", "*", "/", "//", "%", "**"})

    def is_safe_attribute(self, obj: Any, attr: str, value: Any) -> bool:
        """Whether a template may look at an attribute: of loops and imported templates only."""
        safe = isinstance(obj, LoopContext | TemplateModule) and not attr.startswith("_")
        return safe and super().is_safe_attribute(obj, attr, value)

    def call_binop(self, context: Context, operator: str, left: Any, right: Any) -> Any:
        """Return the result of an operation whose operands and result are small enough."""
        for one in (left, right):
            if isinstance(one, jinja2.Undefined):
                str(one)  # raises with its name, which arithmetic does not tell
        numbers = isinstance(left, int | float) and isinstance(right, int | float)
        alike = type(left) is type(right) and isinstance(left, str | list | tuple)
        if not numbers and not (operator == "+" and alike):
            msg = f"{type(left).__name__} {operator} {type(right).__name__}: write numbers"
            raise CaseError(msg)
        if operator == "**":
            left, right = float(left), float(right)
        return counted(context, super().call_binop(context, operator, left, right))

    def call(self, context: Context, obj: Any, *args: Any, **kwargs: Any) -> Any:
        """Call what a template may call: a macro of the shared template, or a known function."""
        budget_of(context).turn()
        if not isinstance(obj, Macro) and obj not in _CALLABLE:
            return super().call(context, obj, *args, **kwargs) if _of_tag(obj) else _no_call(obj)
        return counted(context, super().call(context, obj, *args, **kwargs))


def _of_tag(obj: Any) -> bool:
    """Whether something is the method behind the tag ``raise``."""
    return getattr(obj, "__func__", None) is RaiseTag._stop


def _no_call(obj: Any) -> None:
    msg = f"{getattr(obj, '__name__', type(obj).__name__)} cannot be called in a script"
    raise CaseError(msg)


_CALLABLE: Final = (numbers_up_to, joined, *GLOBALS.values())


@functools.cache
def _environment() -> jinja2.Environment:
    env = _Sandbox(
        loader=jinja2.FunctionLoader(_load),
        undefined=jinja2.StrictUndefined,
        extensions=[RaiseTag],
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,
        finalize=scalar,
    )
    env.filters = dict(BOUNDED)
    env.globals = {**GLOBALS, "range": numbers_up_to, "_joined": joined}
    return env


def _load(name: str) -> str | None:
    """Return the shared template, the only one that can be imported."""
    return (template_folder() / name).read_text(encoding="utf-8") if name == COMMON else None


def _bounded(node: nodes.Node, place: str) -> nodes.Node:
    """Return a part of a template in which loops, lists and texts are counted.

    Raises
    ------
    CaseError
        For a part of Jinja that a script does not need.
    """
    if not isinstance(node, (*_TAGS, *_EXPRESSIONS)):
        msg = (
            f"{place}:{node.lineno}: {type(node).__name__} is not available in a script; there are "
            "for, if, set, import, raise, filters and arithmetic"
        )
        raise CaseError(msg)
    if isinstance(node, nodes.Name) and node.name.startswith("_"):
        msg = f"{place}:{node.lineno}: {node.name!r}: names begin with a letter"
        raise CaseError(msg)
    for field, value in node.iter_fields():
        if isinstance(value, nodes.Node):
            setattr(node, field, _bounded(value, place))
        elif isinstance(value, list):
            items = [_bounded(v, place) if isinstance(v, nodes.Node) else v for v in value]
            setattr(node, field, items)
    return _counting(node, place)


def _counting(node: nodes.Node, place: str) -> nodes.Node:
    """Return a part of a template that counts what it takes, its own parts being bounded."""
    line = node.lineno

    def filtered(part: nodes.Node, name: str) -> nodes.Filter:
        return nodes.Filter(part, name, [], [], None, None, lineno=line)

    if isinstance(node, nodes.For):
        node.iter = filtered(node.iter, "_counted")
        if node.recursive:
            msg = f"{place}:{line}: 'recursive' is not available in a script"
            raise CaseError(msg)
    elif isinstance(node, nodes.Import):
        node.template = filtered(node.template, "_checked")
    elif isinstance(node, nodes.Concat):
        return nodes.Call(nodes.Name("_joined", "load"), node.nodes, [], None, None, lineno=line)
    elif isinstance(node, _COUNTED) and getattr(node, "ctx", "load") == "load":
        return filtered(node, "_checked")
    return node


@functools.lru_cache(maxsize=64)
def _template(source: str, place: str) -> jinja2.Template:
    env = _environment()
    tree = env.parse(source, filename=place)
    bounded = _bounded(tree, place)
    bounded.set_environment(env)
    code = env.compile(bounded, filename=place)  # type: ignore[call-overload]
    return jinja2.Template.from_code(env, code, dict(env.globals))


def render_foreign(
    source: str,
    variables: Mapping[str, Any],
    place: str,
    left_out: Mapping[str, str] = MappingProxyType({}),
) -> str:
    """Render a template that a stranger wrote.

    Parameters
    ----------
    source : str
    variables : Mapping[str, Any]
    place : str
        Name of the file, for messages.
    left_out : mapping of str to str, optional
        Why a name may have no value, and what to do then.

    Raises
    ------
    CaseError
        For a mistake in it with its line, an unknown name, and where it asks for more than a script
        needs.
    """
    budget = Budget()
    pieces = []
    try:
        for piece in _template(source, place).generate({**variables, BUDGET: budget}):
            budget.write(piece)
            pieces.append(piece)
    except jinja2.TemplateSyntaxError as err:
        where = place if err.filename in (None, place) else f"{err.filename}"
        msg = f"{where}:{err.lineno}: {err.message}"
        raise CaseError(msg) from err
    except CaseError as err:
        raise CaseError(_at(err, place, str(err))) from err
    except jinja2.UndefinedError as err:
        message = f"{err}{_hint(str(err), variables, left_out)}"
        raise CaseError(_at(err, place, message)) from err
    except (jinja2.TemplateError, ArithmeticError, TypeError, ValueError, LookupError) as err:
        raise CaseError(_at(err, place, str(err))) from err
    except (RecursionError, MemoryError) as err:
        msg = f"{place}: nested too deeply; make it simpler"
        raise CaseError(msg) from err
    return "".join(pieces)


def _hint(message: str, variables: Mapping[str, Any], left_out: Mapping[str, str]) -> str:
    """Return what ends a message about a name that has no value."""
    name = message.split("'")[1] if message.count("'") > 1 else ""
    if name in left_out:
        return f": {left_out[name]}"
    close = get_close_matches(name, [one for one in variables if one != BUDGET], n=1)
    return f"; did you mean {close[0]!r}?" if close else ""


def _at(err: BaseException, place: str, message: str) -> str:
    """Return a message with the line of the template, found in the traceback."""
    line, trace = 0, err.__traceback__
    while trace is not None:
        if trace.tb_frame.f_code.co_filename == place:
            line = trace.tb_lineno
        trace = trace.tb_next
    return (
        f"{place}:{line}: {message}"
        if line and not message.startswith(place)
        else (message if message.startswith(place) else f"{place}: {message}")
    )
