"""Write what docs/challenge.md shows of the suites that are in cases/challenge.

    python -m benchmarks.suites

From the sealed truths of a suite, and, once they are opened, from its scores:

    bulkcal challenge make cases/challenge/suite_1.toml --out suite_1 --seed COMMIT
    bulkcal challenge score suite_1 --rules cases/challenge/suite_1.toml --forecasts \
cases/challenge/suite_1/forecasts.zip

`make` takes the runs of a suite from its table, if that lies in its folder.
"""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any, Final

ROOT: Final = Path(__file__).resolve().parents[1]
SUITES: Final = ROOT / "cases" / "challenge"
PAGE: Final = ROOT / "docs" / "challenge.md"
MARKED: Final = re.compile(
    r"(<!-- (?P<name>suite_\d+) -->\n).*?(<!-- end (?P=name) -->)", re.DOTALL
)
KNOWN: Final = " (known)"
"""Ends a requirement that is on the column `known`."""


def missed(row: dict[str, Any]) -> str:
    """Return the column in which a figure misses what is required of it; '' if none does."""
    column = "known" if row["required"].endswith(KNOWN) else "ours"
    asked, value = row["required"].removesuffix(KNOWN), row.get(column)
    if not asked or value is None or math.isnan(value):
        return ""
    if asked.startswith("<="):
        met = value <= float(asked[2:])
    elif asked.startswith(">="):
        met = value >= float(asked[2:])
    else:
        low, high = map(float, asked.split(" to "))
        met = low <= value <= high
    return "" if met else column


def number(value: Any) -> str:
    """Return a figure as the page shows it."""
    return "-" if value is None or math.isnan(value) else f"{value:.2f}"


def figures(rows: list[dict[str, Any]]) -> list[str]:
    """Return the table of all figures; what misses its requirement is bold."""
    methods = [name for name in rows[0] if name not in ("figure", "required", "studies")]
    lines = [
        f"| figure | required | studies | {' | '.join(methods)} |",
        "|---" * (3 + len(methods)),
    ]
    lines[1] += "|"
    for row in rows:
        bold = missed(row)
        cells = [f"**{number(row[m])}**" if m == bold else number(row[m]) for m in methods]
        required = row["required"].replace("<=", "at most").replace(">=", "at least")
        lines.append(f"| {row['figure']} | {required} | {row['studies']} | {' | '.join(cells)} |")
    return lines


def reliability(rows: list[dict[str, Any]]) -> list[str]:
    """Return stated probabilities beside how often they held."""
    lines = ["| answers | stated | held |", "|---|---|---|"]
    return lines + [f"| {r['answers']} | {r['stated']:.2f} | {r['held']:.2f} |" for r in rows]


def causes(rows: list[dict[str, Any]]) -> list[str]:
    """Return how every cause fares."""
    names = ["named", "in a set of two", "in a set", "probability"]
    lines = [f"| cause | studies | {' | '.join(names)} |", "|---" * 6 + "|"]
    return lines + [
        f"| {r['cause']} | {r['studies']} | {' | '.join(f'{r[name]:.2f}' for name in names)} |"
        for r in rows
    ]


def shown(name: str) -> list[str]:
    """Return what the page shows of a suite."""
    folder = SUITES / name
    seals = folder / "sealed.json"
    if not seals.exists():
        return ["Not made yet."]
    known = json.loads(seals.read_text(encoding="utf-8"))
    facts = f"{len(known['digests'])} studies, drawn from commit {known['seed'][:7]}"
    scores = folder / "scores.json"
    if not scores.exists():
        return [f"{facts}; the truths are sealed, and no forecast is scored yet."]
    found = json.loads(scores.read_text(encoding="utf-8"))
    return [
        f"{facts}. Bold: misses what is required.", "", *figures(found["scores"]), "",
        "Stated probabilities, and how often they held:", "", *reliability(found["reliability"]),
        "", "Causes that are hidden alone, from non-centrality 5.6:", "", *causes(found["causes"]),
    ]  # fmt: skip


def filled(text: str) -> str:
    """Return the text of the page with what it shows of every suite made anew."""
    return MARKED.sub(lambda m: m[1] + "\n".join(["", *shown(m["name"]), "", ""]) + m[3], text)


def main() -> None:
    """Write the page."""
    PAGE.write_text(filled(PAGE.read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main()
