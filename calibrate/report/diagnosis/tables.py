"""A diagnosis on the screen."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from rich.table import Table

from calibrate.report.diagnosis import rows

__all__ = ["diagnosis_tables", "what_if_tables"]


def diagnosis_tables(record: Mapping[str, Any]) -> list[Table]:
    """Return residuals, causes, what to measure next and what the engine says, as tables.

    Parameters
    ----------
    record : mapping
        The diagnosis as plain data.
    """
    after = [f"left out, {' and '.join(record['leading'])}"] if record["residuals_after"] else []
    found = [
        _table(
            "Measured and simulated, all parameters free",
            [*rows.RESIDUALS, *after],
            rows.residual_rows(record),
        ),
        *_groups(record),
        _table("What these data could show of each cause", rows.VISIBLE, rows.visible_rows(record)),
        _table("How probable each cause is", rows.SHARES, rows.share_rows(record)),
    ]
    if record["engine_before"]:
        engine = [f"with {' and '.join(record['leading'])}", "z"] if record["engine_after"] else []
        title = "The engine itself at the best values, fresh seeds"
        found.append(_table(title, [*rows.ENGINE, *engine], rows.engine_rows(record)))
    if record["measure_next"]["offers"]:
        found.append(_table("What to measure next", rows.NEXT, rows.next_rows(record)))
    return found


def _groups(record: Mapping[str, Any]) -> list[Table]:
    title = "Whole parts left out: how far off the others predict them"
    return [_table(title, rows.GROUPS, rows.group_rows(record))] if record["groups"] else []


def what_if_tables(record: Mapping[str, Any]) -> list[Table]:
    """Return verdict and probabilities before and after a supposed measurement, and what is next.

    Parameters
    ----------
    record : mapping
        The diagnosis with it as plain data.
    """
    title = f"What if {rows.supposed_words(record)} had been measured"
    found = [_table(title, rows.CHANGE, rows.change_rows(record))]
    if record["measure_next"]["offers"]:
        found.append(_table("What to measure next, then", rows.NEXT, rows.next_rows(record)))
    return found


def _table(title: str, head: Sequence[str], body: Sequence[Sequence[str]]) -> Table:
    table = Table(title=title, title_justify="left")
    for number, name in enumerate(head):
        table.add_column(name, justify="right" if number else "left", overflow="fold")
    for row in body:
        table.add_row(*row)
    return table
