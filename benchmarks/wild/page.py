"""docs/wild.md: text stands in it, tables between markers are made from the results."""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final

from benchmarks.wild.listing import PLAIN, Entry, Result, entries, results

PAGE: Final = Path(__file__).parents[2] / "docs" / "wild.md"
_LONGEST: Final = 90


class Book:
    """The list and its results, and the tables made of them.

    Parameters
    ----------
    listed : sequence of Entry
        The scripts.
    known : sequence of Result
        What became of them.
    """

    def __init__(self, listed: Sequence[Entry], known: Sequence[Result]) -> None:
        self._by = {(row.repository, row.path): row for row in known}
        self._listed = listed
        self._plain = [entry for entry in listed if entry.what == PLAIN]
        self._taken = [(e, r) for e in self._plain if (r := self._of(e)) and r.liggghts == "runs"]

    def _of(self, entry: Entry) -> Result | None:
        return self._by.get((entry.repository, entry.path))

    def summary(self) -> list[str]:
        """Return how many there are, and how many run."""
        counts = Counter(row.minidem for _, row in self._taken)
        agree = Counter(row.verdict for _, row in self._taken if row.minidem == "runs")
        rest = Counter(row.verdict for _, row in self._taken if row.minidem != "runs")
        left = rest.total() - rest["same"] - rest["differs"]
        share = 100.0 * counts["runs"] / max(len(self._taken), 1)
        return [
            "| | scripts | repositories |",
            "|---|---|---|",
            _row("listed", self._listed),
            _row("of these plain spheres", self._plain),
            _row("of these put through the engines", [e for e in self._plain if self._of(e)]),
            _row("of these run by LIGGGHTS 3.8.0", [entry for entry, _ in self._taken]),
            _row("of these run by minidem", [e for e, r in self._taken if r.minidem == "runs"]),
            "",
            f"{share:.0f} % of the plain-sphere scripts that LIGGGHTS accepts run unmodified. "
            f"Of these {agree['same']} agree with LIGGGHTS at the first lines of thermo output, "
            f"{agree['differs']} differ, {agree['nothing to compare']} had no "
            "particles in the time given. Of the others, without the refused statements, "
            f"{rest['same']} agree, {rest['differs']} differ and "
            f"{left} were not compared.",
        ]

    def words(self) -> list[str]:
        """Return the refused words, and how many scripts each stops."""
        scripts: dict[str, list[Entry]] = defaultdict(list)
        alone: Counter[str] = Counter()
        for entry, row in self._taken:
            found = row.refused.split("; ") if row.refused else []
            alone[found[0] if len(found) == 1 else ""] += 1
            for word in found:
                scripts[word].append(entry)
        order = sorted(scripts, key=lambda word: (-len(scripts[word]), word))
        return [
            "| refused | scripts | repositories | the only one in |",
            "|---|---|---|---|",
            *(
                f"| `{word.replace('|', '/')}` {_counts(scripts[word])} {alone[word]} |"
                for word in order
            ),
        ]

    def scripts(self) -> list[str]:
        """Return every plain-sphere script that LIGGGHTS accepts."""
        lines = ["| script | minidem | agreement | what stops it |", "|---|---|---|---|"]
        for entry, row in self._taken:
            name = _name(entry)
            agree = row.verdict
            if row.verdict in ("same", "differs"):
                agree += f", {row.rows} lines, energy to {row.energy:.0e}"
            stops = _cell(row.refused or row.minidem_says)
            lines.append(f"| {name} | {row.minidem} | {agree} | {stops} |")
        return lines

    def others(self) -> list[str]:
        """Return the scripts that LIGGGHTS does not run, and those that are out of scope."""
        lines = ["| script | why it is not counted |", "|---|---|"]
        for entry in self._listed:
            row = self._of(entry)
            if entry.what != PLAIN:
                why = f"needs {entry.what}"
            elif row and row.liggghts != "runs":
                why = f"LIGGGHTS: {row.liggghts_says[:_LONGEST] or 'no step in 20 s'}"
            else:
                continue
            lines.append(f"| {_name(entry)} | {_cell(why)} |")
        return lines


def _row(name: str, found: Sequence[Entry]) -> str:
    return f"| {name} {_counts(found)}"


def _name(entry: Entry) -> str:
    """Return repository and script with its address, and what is run before it or given to it."""
    files = [path.rsplit("/", 1)[-1] for path in entry.chain]
    name = f"[{entry.repository}: {_cell(files[-1])}]({entry.link})"
    given = [f"after {_cell(file)}" for file in files[:-1]]
    given += [f"-var {_cell(name)} {' '.join(v)}" for name, v in entry.variables.items()]
    return f"{name} ({', '.join(given)})" if given else name


def _counts(found: Sequence[Entry]) -> str:
    return f"| {len(found)} | {len({entry.repository for entry in found})} |"


def _code(text: str) -> str:
    """Return a text that fits into a cell of a table as code."""
    return text.replace("|", "/").replace("`", "'")


def _cell(text: str) -> str:
    """Return a text that fits into a cell of a table."""
    return re.sub(r"([|*_<>`\[\]])", r"\\\1", text)


def filled(text: str, book: Book | None = None) -> str:
    """Return the text of the page with every table made anew.

    Raises
    ------
    ValueError
        Where a table has no markers on the page.
    """
    book = book or Book(entries(), results())
    parts: dict[str, Callable[[], list[str]]] = {
        "summary": book.summary,
        "words": book.words,
        "scripts": book.scripts,
        "others": book.others,
    }
    for name, make in parts.items():
        pattern = re.compile(rf"(<!-- {name} -->\n).*?(<!-- end {name} -->)", re.DOTALL)
        if not pattern.search(text):
            msg = f"{PAGE.name}: no markers for '{name}'"
            raise ValueError(msg)
        body = "\n".join(["", *make(), "", ""])
        text = pattern.sub(lambda found, body=body: found[1] + body + found[2], text)
    return text


def write() -> None:
    """Write the page."""
    PAGE.write_text(filled(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
