"""All words of a script that minidem refuses, each taken out before the next is looked for.

    python -m benchmarks.wild.refusals SCRIPT TOP [NAME=VALUE,VALUE ...]

prints them, one line each: what is refused, the message, the line, with tabs in between; what only
follows from a statement that was taken out has its line only. It changes the script. TOP is the
folder that it may use, as ``-folder`` gives it, values are of variables, as ``-var`` gives them.
"""

from __future__ import annotations

import os
import re
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

from benchmarks.wild.lines import first_word, statement_at, without, without_jumps, without_runs
from minidem.checking import check_script
from minidem.errors import DemError, RunInterrupted, ScriptError
from minidem.script import CaseFolder
from minidem.simulate import run_script

MOST: Final = 80
_QUOTED: Final = re.compile(r"'([^']*)'")
_STYLED: Final = {"fix": 3, "compute": 3, "dump": 3, "variable": 2, "region": 2, "group": 2}
"""At which word of a command its style stands."""
_FOLLOWS: Final = re.compile(
    r"[Cc]ould not find group|does not exist|unknown \w+ ID|there is no|is not defined"
    r"|no (fix|compute|group|region|variable|dump|such)|not known"
    r"|needs a box|before create_box|no box|unknown (variable|group|region|id|mesh|wall.gran mesh)",
)
"""Messages that may follow from a statement that was taken out before."""
_ENDLESS: Final = "does a loop of jumps ever end?"
"""What a loop that waits for something to move comes to where runs are left out."""


def label(statement: str, message: str) -> str:
    """Return what is refused, in words that are the same for all scripts.

    Examples
    --------
    >>> label("fix a all heal/gran 1", "fix 'heal/gran' exists in LIGGGHTS but not in minidem")
    'fix heal/gran'
    >>> label("fix m all mesh/surface file a.stl heal auto", "mesh/surface: unknown 'heal'")
    'fix mesh/surface: heal'
    """
    words = statement.split()
    command = first_word(statement)
    at = _STYLED.get(command, 0)
    head = f"{command} {words[at]}" if at and len(words) > at else command
    found = _QUOTED.search(message)
    word = found[1] if found else re.sub(r"[\d.]+", "N", message)[:50]
    shown = word.replace(";", ",")[:50]
    return head if word in (*head.split(), "") else f"{head}: {shown}"


def refusals(
    script: Path,
    seconds: float = 60.0,
    variables: Mapping[str, Sequence[str]] | None = None,
    top: Path = Path(),
) -> list[tuple[str, str]]:
    """Return what minidem refuses in a script, with its messages.

    What only follows from a statement that was taken out is left out, and so is a mistake at which
    LIGGGHTS stops as well, after the same steps. Runs are left out, so that the script is read to
    its end. The script and what it includes are changed.
    """
    found: list[tuple[str, str]] = []
    folder = CaseFolder(top.resolve(), os.path.relpath(Path.cwd(), top))
    shared = {
        (one.error.file, one.error.line)
        for one in check_script(script, root=folder, variables=variables)
        if one.shared
    }
    script.write_text(without_runs(_text(script)), encoding="utf-8")
    end = time.process_time() + seconds
    while len(found) < MOST and time.process_time() < end:
        try:
            run_script(
                script, root=folder, variables=variables, log=None,
                stop=lambda: time.process_time() > end,
            )  # fmt: skip
        except ScriptError as err:
            file = script if Path(err.file).name == script.name else Path(err.file)
            if _ENDLESS in err.message:
                file.write_text(without_jumps(_text(file)), encoding="utf-8")
                continue
            statement = statement_at(_text(file), err.line)
            if not statement or statement.lstrip().startswith("#"):
                found.append((label(statement, err.message), err.message))
                break
            follows = bool(found) and _FOLLOWS.search(err.message)
            follows = follows or (err.file, err.line) in shared
            if not follows:
                found.append((label(statement, err.message), err.message))
            shown = ("", "") if follows else found[-1]
            print(*shown, err.line if file == script else 0, sep="\t", flush=True)
            file.write_text(without(_text(file), err.line), encoding="utf-8")
        except RunInterrupted:
            break
        except DemError as err:
            found.append((label("", str(err)), str(err)))
            print(*found[-1], 0, sep="\t", flush=True)
            break
        except Exception as fault:
            found.append((f"fault: {type(fault).__name__}", str(fault)))
            print(*found[-1], 0, sep="\t", flush=True)
            break
        else:
            break
    return found


def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8", errors="replace")


if __name__ == "__main__":
    pairs = (word.partition("=") for word in sys.argv[3:])
    given = {name: values.split(",") for name, _, values in pairs}
    refusals(Path(sys.argv[1]), variables=given, top=Path(sys.argv[2]))
