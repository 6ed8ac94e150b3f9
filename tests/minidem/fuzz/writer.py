"""Scripts that no one would write: valid ones changed, lines of random words, lying files."""

from __future__ import annotations

import random
import re
from dataclasses import dataclass, field

from tests.minidem.fuzz.bank import FOLDER, scripts
from tests.minidem.fuzz.vocabulary import EVERY, STYLED, SYNTAX, usages, words_of

__all__ = ["Sample", "sample"]

# fmt: off
NUMBERS = (
    "0", "1", "-1", "2", "3", "0.01", "0.05", "1e-3", "1e308", "1e-308", "nan", "inf", "-0.0",
    "1e9", "1e18", "9" * 20, "2147483647", "2147483648", "-2147483648", "4294967296", "0.5",
    "15485863", "32452867", "1e-15", "-1e-5", "1.5", "10", "100", "90", "360", "1e", "0x10", "1_0",
)
PATHS = (
    "..", ".", "../x", "../../x", "/etc/passwd", "/tmp/escaped", "sub/../../x", "link", "link/x",
    "loop", "loop/x", "file/x", "in.s", "x/*", "../*", "a" * 300, "a*b*c", "~/x", "sub", "in.s/x",
    "//x", "C:\\x", ".part", "-", "none", "con\x01x", "é",
)
ODD = (
    "$", "${", "${x}", "$(", "$(1/0)", "$(v_v)", "v_v", "v_a", "c_c", "f_f", "c_c[1]", "f_f[2][1]",
    "c_c[0]", "c_c[99999999999]", "f_f[-1]", '"', "'", '"a b"', "&", "#", "*", "1*2", "*3", "1*",
    "INF", "EDGE", "NULL", "SELF", "all", "none", "yes", "no", "on", "off", "x", "y", "z", "id",
    "type", "units", "box", "lattice", "%s", "%d", "%n", "%.17g", "%1000000d", "\\", "[", "]", "=",
)
# fmt: on
_DEFINING = re.compile(r"^\s*(fix|compute|region|variable|group|dump) +(\w+)", re.MULTILINE)
_SLOT = re.compile(r"[A-Z][A-Z0-9_]*")
FROM_BANK, GENTLE, REPAIRED = 0.9, 0.6, 0.6
WITH_FILE, CUT, FLIP, WITH_OPTIONS = 0.25, 0.06, 0.06, 0.06
MOST_CHANGES, MOST_LINES, MOST_WORDS = 3, 12, 10


@dataclass
class Sample:
    """A case to be run.

    Attributes
    ----------
    script : bytes
        Text of ``in.s``.
    files : dict
        Files beside it.
    arguments : list of str
        Of the command.
    repaired : bool
        Whether lines that are refused are taken out before it runs, so that what is odd and yet
        accepted is met by the engine.
    """

    script: bytes
    files: dict[str, bytes]
    arguments: list[str]
    repaired: bool = False


@dataclass
class _Writer:
    """Draws words for a script."""

    draw: random.Random
    names: list[str] = field(default_factory=list)

    def number(self) -> str:
        """Return a number, often one that is a trap."""
        if self.draw.random() < 0.3:
            return f"{self.draw.uniform(-1, 1) * 10 ** self.draw.randint(-6, 6):.4g}"
        return self.draw.choice(NUMBERS)

    def path(self) -> str:
        """Return a file name, often one that leads out."""
        return self.draw.choice((*PATHS, *FOLDER))

    def name(self) -> str:
        """Return a name of the script, or a reference to one."""
        known = self.draw.choice([*self.names, "all", "a", "c", "f", "v"])
        prefix = self.draw.choice(["", "", "", "c_", "f_", "v_"])
        index = self.draw.choice(["", "", "[1]", "[2]", "[1][2]"]) if prefix else ""
        return prefix + known + index

    def word(self, near: tuple[str, ...]) -> str:
        """Return any word; `near` are those that belong to the line."""
        kind = self.draw.random()
        if kind < 0.4 and near:
            return self.draw.choice(near)
        if kind < 0.7:
            return self.number()
        if kind < 0.85:
            return self.name()
        return self.draw.choice((self.path(), self.draw.choice(EVERY), self.draw.choice(ODD)))

    def line(self) -> str:
        """Return a line of a random style with random words, or with those of its usage."""
        kind = self.draw.choice(tuple(STYLED))
        style, entry = self.draw.choice(tuple(STYLED[kind].items()))
        shown = usages(entry)
        if shown and self.draw.random() < 0.5:
            words = self.draw.choice(shown).replace("[", " ").replace("]", " ").split()
            if kind != "command" and style not in words:
                words = [kind, "ID", "all", style, *words]
            elif kind == "command" and words[0] != style:
                words = [style, *words]
            return " ".join(self._filled(word) for word in words)
        near = (*words_of(entry), *self.draw.choices(SYNTAX, k=5))
        rest = [self.word(near) for _ in range(self.draw.randint(0, MOST_WORDS))]
        group = self.draw.choice(["all", self.name()])
        head = {
            "command": [style], "variable": ["variable", self.name(), style],
            "region": ["region", self.name(), style],
        }.get(kind, [kind, self.draw.choice([self.name(), "new"]), group, style])  # fmt: skip
        return " ".join([*head, *rest])

    def _filled(self, word: str) -> str:
        """Return something for a word in capitals, nearly always what fits."""
        if not _SLOT.fullmatch(word) or self.draw.random() < 0.05:
            return word
        if any(part in word for part in ("FILE", "PATH", "DIR")):
            return self.path()
        named = ("ID", "GROUP", "REGION", "MESH", "FIX", "NAME", "INPUT", "COLUMN", "G1", "G2")
        return self.name() if word in named else self.number()

    # -- a script as a whole ---------------------------------------------------------------------

    def fresh(self) -> str:
        """Return a script of random lines behind a box."""
        head = "region b block -0.1 0.1 -0.1 0.1 -0.1 0.2 units box\ncreate_box 2 b\n"
        lines = [self.line() for _ in range(self.draw.randint(1, MOST_LINES))]
        return self.draw.choice(["", head]) + "\n".join([*lines, "run 1"]) + "\n"

    def changed(self, script: str) -> str:
        """Return a valid script with some changes."""
        lines = script.splitlines()
        if self.draw.random() < 0.5:  # what happens every 100 steps happens in so short a run
            lines = [re.sub(r"(?<![\w.])[1-9]\d{1,3}(?![\w.])", "2", line) for line in lines]
        for _ in range(self.draw.randint(1, MOST_CHANGES)):
            at = self.draw.randrange(len(lines))
            kind = self.draw.random()
            if kind < 0.25:
                lines.insert(at if self.draw.random() < 0.5 else -1, self.line())
            elif kind < 0.32:
                lines.insert(self.draw.randrange(len(lines)), lines[at])
            elif kind < 0.40 and len(lines) > 1:
                del lines[at]
            else:
                lines[at] = self._line_changed(lines[at])
        return "\n".join(lines) + "\n"

    def _line_changed(self, line: str) -> str:
        words = line.split(" ")
        at = self.draw.randrange(len(words))
        if self.draw.random() < GENTLE:
            return " ".join([*words[:at], self._alike(words[at], words), *words[at + 1 :]])
        kind = self.draw.random()
        if kind < 0.35:
            words[at] = self.number()
        elif kind < 0.45:
            other = self.draw.randrange(len(words))
            words[at], words[other] = words[other], words[at]
        elif kind < 0.55:
            del words[at]
        elif kind < 0.65:
            words.insert(at, words[at])
        elif kind < 0.75:
            words[at] = self.path()
        else:
            words[at] = self.word(_near(words))
        return " ".join(words)

    def _alike(self, word: str, words: list[str]) -> str:
        """Return another word of the same sort: a number for a number, a name for a name."""
        try:
            value = float(word)
        except ValueError:
            if word in self.names:
                return self.draw.choice(self.names)
            known = next((table for table in STYLED.values() if word in table), None)
            return self.draw.choice(tuple(known or ()) or _near(words) or EVERY)
        factor = self.draw.choice([-1.0, 0.0, 0.1, 0.5, 2.0, 3.0, 10.0, 1e3, 1e-3, 1e6])
        if self.draw.random() < 0.3:
            return self.number()
        return f"{value * factor:.0f}" if word.isdigit() else f"{value * factor:g}"

    def damaged(self, data: bytes) -> bytes:
        """Return a file that is cut, flipped or claims something else."""
        kind = self.draw.random()
        if kind < 0.3:
            return data[: self.draw.randint(0, len(data))]
        if kind < 0.6 and data:
            changed = bytearray(data)
            for _ in range(self.draw.randint(1, 4)):
                changed[self.draw.randrange(len(data))] = self.draw.randrange(256)
            return bytes(changed)
        numbers = list(re.finditer(rb"[-+.\w]+", data))
        if not numbers:
            return b"\0" * self.draw.randint(0, 99)
        one = self.draw.choice(numbers)
        return data[: one.start()] + self.number().encode() + data[one.end() :]

    def options(self) -> list[str]:
        """Return the arguments of the command."""
        if self.draw.random() > WITH_OPTIONS:
            return ["-in", "in.s", "-screen", "none"]
        found = self.draw.choice([["-in", "in.s"], ["--check", "in.s"], ["-in", self.path()]])
        for _ in range(self.draw.randint(0, 3)):
            option = self.draw.choice(
                ["-log", "-screen", "-echo", "-threads", "-var", "-strict", "-folder", "-x"]
            )
            many = self.draw.randint(0, 2)
            found += [option, *(self.word(("none", "both", "1", "2", "v")) for _ in range(many))]
        return [word for word in found if "\0" not in word]


def sample(seed: int) -> Sample:
    """Return the case of a seed."""
    writer = _Writer(random.Random(seed))
    draw = writer.draw
    script = draw.choice(scripts())
    writer.names = [name for _, name in _DEFINING.findall(script)] or ["a"]
    text = writer.changed(script) if draw.random() < FROM_BANK else writer.fresh()
    data = text.encode(errors="surrogateescape")
    if draw.random() < CUT:
        data = data[: draw.randint(0, len(data))]
    if data and draw.random() < FLIP:
        at = draw.randrange(len(data))
        data = data[:at] + bytes([data[at] ^ 1 << draw.randint(0, 7)]) + data[at + 1 :]
    files = dict(FOLDER)
    if draw.random() < WITH_FILE:
        name = draw.choice(tuple(files))
        files[name] = writer.damaged(files[name])
        same = [old for old in files if old.endswith("." + name.split(".")[-1])]
        for old in same if draw.random() < 0.5 else ():  # let the script read it
            data = data.replace(old.encode(), name.encode())
    return Sample(data, files, writer.options(), draw.random() < REPAIRED)


def _near(words: list[str]) -> tuple[str, ...]:
    """Return the words of the styles on a line."""
    found = (table[word] for word in words for table in STYLED.values() if word in table)
    return tuple(word for entry in found for word in words_of(entry))
