"""Tables of words: a module is imported when a script uses one of its words."""

from __future__ import annotations

import subprocess
import sys

import pytest

from minidem.registry import Registry
from tests.paths import ROOT

WORDS = """
import pkgutil
import sys
from importlib import import_module

import minidem
from minidem.contact.extensions import EXTENSIONS
from minidem.output.dump import DUMPS
from minidem.simulate import run_script
from minidem.world.compute import COMPUTES
from minidem.world.fix import FIXES

assert "minidem.fixes.forces.springs" not in sys.modules  # no script has used it yet
tables = (FIXES, COMPUTES, DUMPS, EXTENSIONS)
told = [{*table} for table in tables]
assert all(len(table.values()) == len(words) for table, words in zip(tables, told))
for module in pkgutil.walk_packages(minidem.__path__, "minidem."):
    if not module.name.endswith("__main__"):
        import_module(module.name)
print([sorted({*table} - words) for table, words in zip(tables, told)])
"""


def test_every_word_of_every_module_has_a_line():
    """Each module that a line names registers the words of the line, and no module others."""
    found = subprocess.run(
        [sys.executable, "-c", WORDS], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert (found.stdout, found.stderr) == ("[[], [], [], []]\n", "")


def test_a_module_that_does_not_register_its_word_is_named():
    table: Registry[int] = Registry("greeting")
    table.later("tests.paths", "hello")
    assert "hello" in table
    with pytest.raises(KeyError, match=r"tests\.paths does not register the greeting 'hello'"):
        table["hello"]
