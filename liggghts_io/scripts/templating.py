"""Render script templates: undefined names are errors, `{% raise "..." %}` stops with a reason."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NoReturn

import jinja2
from jinja2 import nodes
from jinja2.ext import Extension
from jinja2.parser import Parser

from liggghts_io.errors import CaseError
from liggghts_io.scripts.filters import FILTERS, GLOBALS


class RaiseTag(Extension):
    """The tag `{% raise expression %}`: the case is impossible, and the message says why."""

    tags = {"raise"}  # noqa: RUF012 - the base class declares it as a plain set

    def parse(self, parser: Parser) -> nodes.Node:
        """Turn the tag into a call of `_stop` with the message."""
        line = next(parser.stream).lineno
        message = parser.parse_expression()
        call = self.call_method("_stop", [message, nodes.Const(line)], lineno=line)
        return nodes.CallBlock(call, [], [], []).set_lineno(line)

    def _stop(self, message: str, line: int, caller: Any) -> NoReturn:
        msg = f"{message} (template line {line})"
        raise CaseError(msg)


def template_folder() -> Path:
    """Return the folder of the templates: in the wheel inside the package, else beside it.

    Raises
    ------
    CaseError
        If neither exists.
    """
    here = Path(__file__).resolve().parents[1]
    for folder in (here / "templates", here.parent / "templates"):
        if folder.is_dir():
            return folder
    msg = f"no script templates beside {here}: reinstall bulkcal"
    raise CaseError(msg)


@functools.cache
def environment() -> jinja2.Environment:
    """Return the Jinja environment of the script templates."""
    env = jinja2.Environment(
        loader=jinja2.FileSystemLoader(template_folder()),
        undefined=jinja2.StrictUndefined,
        extensions=[RaiseTag],
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,
    )
    env.filters.update(FILTERS)
    env.globals.update(GLOBALS)
    return env


def render(template: str, variables: Mapping[str, Any]) -> str:
    """Render a template to a script.

    Raises
    ------
    CaseError
        For a missing variable or impossible input.
    """
    try:
        return environment().get_template(template).render(**variables)
    except jinja2.UndefinedError as err:
        msg = f"template {template}: {err.message}"
        raise CaseError(msg) from err
