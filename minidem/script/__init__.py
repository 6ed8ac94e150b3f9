"""The script language of LIGGGHTS: words, variables, formulas, control flow."""

from minidem.script.context import Context as Context
from minidem.script.context import EmptyContext as EmptyContext
from minidem.script.interpreter import Hooks as Hooks
from minidem.script.interpreter import Interpreter as Interpreter
from minidem.script.lexer import Command as Command
from minidem.script.paths import CaseFolder as CaseFolder
from minidem.script.paths import inside as inside

__all__ = ["CaseFolder", "Command", "Context", "EmptyContext", "Hooks", "Interpreter", "inside"]
