"""The words that scripts are fuzzed with, taken from the program's own tables and source.

Styles come from the registries, and the words that belong to a style from the text of the module
that it is registered in and of those that this one imports: a word that is added to minidem is
fuzzed without a line here.
"""

from __future__ import annotations

import ast
import inspect
import re
import sys
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path

import minidem.simulate  # registers every word
from minidem.commands.command import COMMANDS
from minidem.contact.model import MODELS, SETTINGS
from minidem.insertion.region import STYLES as REGIONS
from minidem.insertion.region import making
from minidem.output.columns import COLUMNS
from minidem.output.dump import DUMPS
from minidem.output.thermo_words import THERMO
from minidem.script.control import CONTROL
from minidem.script.formula import ARITY, GROUP_FUNCTIONS, MASKS, VECTOR_FUNCTIONS
from minidem.script.variables import STYLES
from minidem.world.compute import COMPUTES
from minidem.world.fix import FIXES

__all__ = ["EVERY", "STYLED", "SYNTAX", "usages", "words_of"]

STYLED: Mapping[str, Mapping[str, object]] = {
    "fix": FIXES,
    "compute": COMPUTES,
    "dump": DUMPS,
    "command": {**dict.fromkeys(CONTROL), **COMMANDS},
    "region": dict.fromkeys(REGIONS, making),
    "variable": dict.fromkeys(STYLES),
}
"""Tables of words that begin a line or name a style."""
SYNTAX = tuple(
    sorted(
        {*MODELS, *SETTINGS, *COLUMNS, *THERMO, *ARITY, *GROUP_FUNCTIONS, *MASKS, *VECTOR_FUNCTIONS}
        | {word for words in MODELS.values() for word in words}
    )
)
"""Words of contact models, columns, thermo output and formulas."""
EVERY = tuple(sorted({*SYNTAX, *(word for table in STYLED.values() for word in table)}))
"""All of them."""
_WORD = re.compile(r"[a-z][A-Za-z0-9_/]{0,29}|[A-Z]{2,12}")
_PLAIN = ("minidem.errors", "minidem.words", "minidem.registry", "minidem.files", "minidem.run")
"""Modules whose words belong to no style."""


def words_of(entry: object) -> tuple[str, ...]:
    """Return the words that the source of an entry of a table knows."""
    return _words(_home(entry))


def usages(entry: object) -> tuple[str, ...]:
    """Return what messages say of how an entry is used: ``spring tether K X Y Z R0``."""
    return _usages(_home(entry))


def _home(entry: object) -> str:
    """Return the name of the module that an entry comes from."""
    return entry.__name__ if inspect.ismodule(entry) else str(getattr(entry, "__module__", ""))


@lru_cache
def _words(module: str) -> tuple[str, ...]:
    near = [one for one in _imported(module) if not one.startswith(_PLAIN)]
    texts = {text for one in (module, *near) for text in _texts(one)}
    return tuple(sorted(text for text in texts if _WORD.fullmatch(text)))


@lru_cache
def _usages(module: str) -> tuple[str, ...]:
    texts = {text for text in _texts(module) if " " in text and _shows_use(text)}
    return tuple(sorted(texts))


def _shows_use(text: str) -> bool:
    """Tell whether a text has words to be filled in and is no sentence."""
    words = text.split()
    slots = any(word.strip("[]").isupper() for word in words)
    return slots and words[0].islower() and "`" not in text and not text.endswith(".")


@lru_cache
def _tree(module: str) -> ast.Module:
    source = inspect.getsourcefile(sys.modules[module]) if module in sys.modules else None
    return ast.parse(Path(source).read_text(encoding="utf-8") if source else "")


@lru_cache
def _texts(module: str) -> tuple[str, ...]:
    """Return all strings in the source of a module."""
    found = (node.value for node in ast.walk(_tree(module)) if isinstance(node, ast.Constant))
    return tuple(text for text in found if isinstance(text, str) and len(text) < 200)


@lru_cache
def _imported(module: str) -> tuple[str, ...]:
    """Return the modules of minidem that a module imports."""
    nodes = [node for node in ast.walk(_tree(module)) if isinstance(node, ast.ImportFrom)]
    named = (node.module or "" for node in nodes)
    return tuple(name for name in named if name.startswith("minidem.") and name in sys.modules)


assert minidem.simulate
