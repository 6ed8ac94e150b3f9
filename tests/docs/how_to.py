"""Follow a how-to page to the letter in a copy of the project.

A page is ordinary Markdown. What a reader has to do stands in fenced blocks, and their first words
say what kind they are:

- a block after a line that ends in ``Create `PATH`:`` is the text of a new file;
- a ``diff`` block after a line that ends in ``In `PATH`:`` changes a file: lines that begin with a
  space stand there already, together and once, lines with ``+`` are added, with ``-`` taken out;
- a ``console`` block holds commands after ``$``, each followed by parts of what it prints; a line
  ``...`` stands for anything.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from minidem.kernels.machine.cache import SHIPPED
from tests.paths import ROOT

LIMIT_S = 600
_FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_CREATE = re.compile(r"Create `([^`]+)`:\s*\Z")
_CHANGE = re.compile(r"In `([^`]+)`:\s*\Z")


class PageError(AssertionError):
    """A page does not say what is true."""


@dataclass(frozen=True)
class Step:
    """One block of a page: what to do, to which file, and its text."""

    kind: str  # "create", "change" or "run"
    path: str
    text: str


def steps_of(page: str) -> list[Step]:
    """Return what a page asks for, in order; blocks of other kinds are only to look at."""
    found = []
    for block in _FENCE.finditer(page):
        before = page[: block.start()]
        create, change = _CREATE.search(before), _CHANGE.search(before)
        if create:
            found.append(Step("create", create.group(1), block.group(2)))
        elif change and block.group(1) == "diff":
            found.append(Step("change", change.group(1), block.group(2)))
        elif block.group(1) == "console":
            found.append(Step("run", "", block.group(2)))
    return found


def copy_of_the_project(target: Path) -> Path:
    """Copy what git knows and what is new, and the machine code that came with it."""
    listed = subprocess.run(
        ["git", "ls-files", "-co", "--exclude-standard", "-z"],
        capture_output=True, text=True, check=True, cwd=ROOT,
    )  # fmt: skip
    for name in filter(None, listed.stdout.split("\0")):
        source = ROOT / name
        if source.is_file():
            place = target / name
            place.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, place)
    if SHIPPED.is_dir():
        shutil.copytree(SHIPPED, target / SHIPPED.relative_to(ROOT))
    return target


def changed(text: str, diff: str, path: str) -> str:
    """Apply the lines of a ``diff`` block to a text."""
    lines = diff.splitlines()
    old = "\n".join(line[1:] for line in lines if not line.startswith("+"))
    new = "\n".join(line[1:] for line in lines if not line.startswith("-"))
    if f"\n{text}\n".count(f"\n{old}\n") != 1:
        msg = f"{path} does not hold these lines together and once:\n{old}"
        raise PageError(msg)
    return f"\n{text}\n".replace(f"\n{old}\n", f"\n{new}\n")[1:-1]


def follow(page: Path, home: Path, instead: Mapping[str, str] | None = None) -> None:
    """Do in `home`, a copy of the project, everything that a page says.

    Parameters
    ----------
    page, home : Path
    instead : mapping, optional
        Lines of the page and what is done in their place; the page itself has to offer it.

    Raises
    ------
    PageError
        At the first step that does not work as written.
    """
    text = page.read_text(encoding="utf-8")
    for line, other in (instead or {}).items():
        if text.count(f"{line}\n") != 1:
            msg = f"{page.name} does not hold this line once: {line}"
            raise PageError(msg)
        text = text.replace(f"{line}\n", f"{other}\n")
    steps = steps_of(text)
    if {step.kind for step in steps} < {"create", "run"}:
        msg = f"{page.name}: a page has at least a file to create and a command to run"
        raise PageError(msg)
    for step in steps:
        place = home / step.path
        if step.kind == "create":
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_text(step.text, encoding="utf-8")
        elif step.kind == "change":
            place.write_text(changed(place.read_text(), step.text, step.path), encoding="utf-8")
        else:
            _run_all(step.text, home)


def _run_all(text: str, home: Path) -> None:
    """Run the commands of a ``console`` block and look for what they are said to print."""
    for part in re.split(r"^\$ ", text, flags=re.MULTILINE)[1:]:
        while "\\\n" in part:
            part = part.replace("\\\n", " ")
        command, _, wanted = part.partition("\n")
        programs = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
        done = subprocess.run(
            ["bash", "-c", command], capture_output=True, text=True, check=False, cwd=home,
            timeout=LIMIT_S, env=os.environ | {"PATH": programs, "PYTHONPATH": str(home)},
        )  # fmt: skip
        shown = done.stdout + done.stderr
        if done.returncode != 0:
            msg = f"$ {command}\nexit code {done.returncode}\n{shown}"
            raise PageError(msg)
        for line in wanted.splitlines():
            if line.strip() not in ("", "...") and line.strip() not in shown:
                msg = f"$ {command}\ndid not print {line.strip()!r} but\n{shown}"
                raise PageError(msg)
