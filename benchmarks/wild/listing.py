"""The list of scripts, and what is known of each."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Final, Self
from urllib.parse import quote

HERE: Final = Path(__file__).parent
SCRIPTS: Final = HERE / "scripts.csv"
RESULTS: Final = HERE / "results.csv"
PLAIN: Final = "plain spheres"
FEATURES: Final = {
    "heat": r"\bheat\b|thermalConductivity",
    "bonds": r"\bbond",
    "multisphere": r"multisphere|\brigid\b",
    "superquadric": r"superquadric",
    "SPH": r"\bsph\b",
    "couple/cfd": r"couple/(cfd|lb)|couple_every",
}
"""What minidem leaves out by intention, and how a script that needs it is known."""
_COMMENT: Final = re.compile(r"#.*")


@dataclass(frozen=True)
class Entry:
    """A script of a public repository.

    Attributes
    ----------
    repository, path, commit : str
        Where it is: owner/name on GitHub, file, hash.
    folder : str
        Folder of the repository in which an engine is started, '' for its top.
    what : str
        ``plain spheres``, or which features put it out of scope.
    after : str
        Scripts of the repository that are run before it in the same folder, joined by ``;``: they
        write what it reads.
    var : str
        Variables of the command line, ``NAME=VALUE`` or ``NAME=VALUE,VALUE``, separated by blanks,
        as the repository's own run script or text gives them.
    """

    repository: str
    path: str
    commit: str
    folder: str
    what: str
    after: str = ""
    var: str = ""

    @property
    def link(self) -> str:
        """Return the address of the script."""
        return f"https://github.com/{self.repository}/blob/{self.commit}/{quote(self.path)}"

    @property
    def chain(self) -> tuple[str, ...]:
        """Return the scripts to be run, in order, the entry's own at the end."""
        return (*filter(None, self.after.split(";")), self.path)

    @property
    def variables(self) -> dict[str, list[str]]:
        """Return the values of each variable of the command line.

        Examples
        --------
        >>> Entry("o/n", "in.a", "", "", PLAIN, var="N=5 R=1,2").variables
        {'N': ['5'], 'R': ['1', '2']}
        """
        pairs = (word.partition("=") for word in self.var.split())
        return {name: values.split(",") for name, _, values in pairs}

    def home(self, scripts: Path) -> Path:
        """Return the folder of the repository among the collected ones."""
        return scripts / self.repository.replace("/", "+")


@dataclass(frozen=True)
class Result:
    """What became of a script.

    Attributes
    ----------
    repository, path : str
        The script.
    liggghts, minidem : str
        ``runs``, ``refuses``, ``slow`` (not one step in the time given), ``fails`` (a crash;
        minidem: a fault of its own).
    liggghts_says, minidem_says : str
        First message of an engine that does not run it.
    refused : str
        All words that minidem refuses, joined by ``; ``.
    verdict : str
        ``same``, ``differs`` or ``nothing to compare``, without the refused statements; '' where
        LIGGGHTS does not run it.
    rows : int
        Lines of thermo output that both gave, of those that were compared.
    particles : int
        Particles at the last of them, LIGGGHTS.
    energy : float
        Largest relative difference of kinetic energy at the first lines with motion.
    """

    repository: str
    path: str
    liggghts: str
    liggghts_says: str
    minidem: str
    minidem_says: str
    refused: str
    verdict: str
    rows: int
    particles: int
    energy: float

    @classmethod
    def read(cls, row: dict[str, str]) -> Self:
        """Return a row of the table."""
        numbers = {"rows": int(row["rows"]), "particles": int(row["particles"])}
        return cls(**{**row, **numbers, "energy": float(row["energy"])})


def what_is(text: str) -> str:
    """Return ``plain spheres``, or the features of a script that minidem leaves out."""
    body = _COMMENT.sub("", text)
    found = [name for name, mark in FEATURES.items() if re.search(mark, body, re.IGNORECASE)]
    return ", ".join(found) or PLAIN


def entries(path: Path = SCRIPTS) -> list[Entry]:
    """Return the list of scripts."""
    with path.open(encoding="utf-8", newline="") as file:
        return [Entry(**row) for row in csv.DictReader(file)]


def results(path: Path = RESULTS) -> list[Result]:
    """Return stored results; none where there are none."""
    if not path.exists():
        return []
    with path.open(encoding="utf-8", newline="") as file:
        return [Result.read(row) for row in csv.DictReader(file)]


def store(rows: Iterable[Result], path: Path) -> None:
    """Write results, one line each."""
    with path.open("w", encoding="utf-8", newline="") as file:
        names = [field.name for field in fields(Result)]
        writer = csv.DictWriter(file, names, lineterminator="\n")
        writer.writeheader()
        writer.writerows(asdict(row) for row in rows)
