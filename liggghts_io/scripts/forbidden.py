"""What a script of a stranger may not do: run programs, leave its folder, or go on for ever.

The rules are about the text, so that they hold for every engine; minidem has its own besides.
"""

from __future__ import annotations

import re
from typing import Final

from liggghts_io.errors import CaseError, nearest
from liggghts_io.measure.script_text import logical_lines, words_of

_COMMANDS: Final = (
    "atom_modify atom_style boundary box change_box communicate compute compute_modify "
    "create_atoms create_box delete_atoms dimension displace_atoms dump dump_modify echo fix "
    "fix_modify group hard_particles if info label lattice mass modify_timing neigh_modify "
    "neighbor newton pair_coeff pair_modify pair_style print processors region replicate "
    "reset_timestep restart run run_style set soft_particles thermo thermo_modify thermo_style "
    "timestep uncompute undump unfix units variable velocity write_restart"
)
ALLOWED: Final = frozenset(_COMMANDS.split())
"""Commands that a script may use."""

_STYLES: Final = ("equal", "index", "string", "loop", "atom", "delete")
_WHY: Final = {
    "shell": "it runs a program",
    "jump": "a loop may never end; write the commands out, or use a template with {% for %}",
    "next": "a loop may never end; write the commands out, or use a template with {% for %}",
    "include": "put everything into the one script",
    "quit": "the end of a script proves that the run completed",
    "log": "the log proves that the run completed",
    "clear": "one script is one simulation",
    "read_restart": "a case begins at step 0 with its own grains",
    "read_data": "a case makes its own grains, with insert/pack or create_atoms",
}
_PLAIN: Final = re.compile(r"[A-Za-z0-9_+-][A-Za-z0-9_.+/-]*")
_SHELL: Final = frozenset(";`|<>")
_TEXT: Final = ("variable", "if", "print", "fix")
"""Commands with formulas or texts, in which these characters mean nothing to a shell."""
_PROGRAM: Final = re.compile(r"\.(gz|bz2|zst|xz)\b|\bmovie\b|\bimage\b")
_DEEPEST: Final = 5  # commands within commands


def check_script(script: str, place: str) -> None:
    """Refuse a script that could do more than simulate grains in its folder.

    Parameters
    ----------
    script : str
    place : str
        Name of the file, for messages.

    Raises
    ------
    CaseError
        With file, line, what is refused and why.
    """
    if "\0" in script:
        msg = f"{place}: not a text; it holds a zero byte"
        raise CaseError(msg)
    for number, line in logical_lines(script):
        try:
            _check_line(line, 0)
        except CaseError as err:
            msg = f"{place}:{number}: {err}"
            raise CaseError(msg) from err


def _check_line(line: str, depth: int) -> None:
    words = words_of(line)
    if not words:
        return
    command = words[0]
    if command not in ALLOWED:
        why = f"; {_WHY[command]}" if command in _WHY else nearest(command, sorted(ALLOWED))
        msg = f"the command {command[:40]!r} is not allowed in a script of an experiment{why}"
        raise CaseError(msg)
    if depth > _DEEPEST:
        msg = "commands within commands, too deep; write them out"
        raise CaseError(msg)
    _check_paths(command, words, line)
    if command == "variable":
        _check_variable(words)
    if command == "if":
        for word in _branches(words[1:]):
            _check_line(word, depth + 1)
    if command == "run":
        for word in words[words.index("every") + 2 :] if "every" in words else []:
            if word != "NULL":
                _check_line(word, depth + 1)


def _branches(words: list[str]) -> list[str]:
    """Return the commands of an `if`, without its conditions and keywords."""
    found = []
    for k, word in enumerate(words):
        condition = k == 0 or words[k - 1] == "elif"
        if not condition and word not in ("then", "elif", "else"):
            found.append(word)
    return found


def _check_paths(command: str, words: list[str], line: str) -> None:
    if ".." in line:
        msg = "'..' may lead out of the folder of the case; name files inside it"
        raise CaseError(msg)
    formula = command == "variable" and words[2:3] in (["equal"], ["atom"])
    for piece in [] if formula else " ".join(words).split():
        if piece.startswith(("/", "~", "\\")) and len(piece) > 1:
            msg = f"{piece[:60]!r} is an absolute path; name files inside the folder of the case"
            raise CaseError(msg)
    if command not in _TEXT and _SHELL & set(line):
        msg = f"the characters {' '.join(sorted(_SHELL & set(line)))} have no place here"
        raise CaseError(msg)
    if command in ("dump", "restart", "write_restart", "fix") and _PROGRAM.search(line):
        msg = "compressed files, images and films start other programs; write plain files"
        raise CaseError(msg)


def _check_variable(words: list[str]) -> None:
    style = words[2] if len(words) > 2 else ""
    if style not in _STYLES:
        msg = f"variable of the style {style[:40]!r}{nearest(style, _STYLES)}"
        raise CaseError(msg)
    values = words[3:] if style in ("index", "string") else []
    for value in values:
        if not _PLAIN.fullmatch(value) and not re.fullmatch(r"\$\{?\w+\}?", value):
            msg = (
                f"variable {words[1][:40]}: {value[:60]!r} must begin with a letter or digit and "
                "hold letters, digits and _.+-/ only"
            )
            raise CaseError(msg)
