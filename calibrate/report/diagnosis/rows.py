"""The tables of a diagnosis as words, for page and screen alike."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, Final, TypeAlias

from calibrate.causes.judging.probabilities import NONE, UNKNOWN
from calibrate.causes.told.numbers import result_words, short, with_unit
from calibrate.causes.told.words import KINDS
from calibrate.report.numbers import plus_minus
from calibrate.significance import shown, significant

__all__ = [
    "CHANGE",
    "ENGINE",
    "GROUPS",
    "HELD_OUT",
    "NEXT",
    "RESIDUALS",
    "SHARES",
    "VISIBLE",
    "change_rows",
    "engine_rows",
    "group_rows",
    "held_out_rows",
    "is_large",
    "next_rows",
    "residual_rows",
    "share_rows",
    "supposed_words",
    "visible_rows",
]

TOLD: Final = 0.02
"""Probability from which an answer is told, before or after."""

Record: TypeAlias = Mapping[str, Any]

SHARES: Final = ("cause", "alone", "alone or in a pair", "ln ratio", "strength", "95 % interval")
VISIBLE: Final = (
    "cause", "imitated", "alone seen from", "told from", "possible up to", "if ignored",
    "looks like",
)  # fmt: skip
RESIDUALS: Final = ("target", "measured", "simulated", "z", "z left out")
GROUPS: Final = ("left out as a whole", "", "z")
ENGINE: Final = ("target", "measured", "engine", "z")
HELD_OUT: Final = ("left out", "log density")
CHANGE: Final = ("answer", "before", "with it", "change")
NEXT: Final = ("measure", "called", "good to", "hours", "tells", "what a result would mean")


def share_rows(record: Record) -> list[list[str]]:
    """Return a row for every candidate: how probable it is and how strong, most probable first."""
    return [
        [
            one["name"],
            f"{one['probability']:.2f}",
            f"{one['inclusion']:.2f}",
            f"{one['log_ratio']:+.1f} ± {one['log_ratio_error']:.1f}",
            with_unit(short(one["strength"]), one["unit"]),
            f"{short(one['low_95'])} to {short(one['high_95'])}",
        ]
        for one in _ordered(record)
    ]


def visible_rows(record: Record) -> list[list[str]]:
    """Return a row for every candidate: what the data could show of it, as `share_rows`."""
    return [
        [
            one["name"],
            f"{100.0 * one['absorbed']:.0f} %",
            _size(one, "detectable") if one["visible"] else "not seen",
            _achieved(one),
            _size(one, "limit"),
            _bias(one),
            ", ".join(one["alike"]) or "-",
        ]
        for one in _ordered(record)
    ]


def _ordered(record: Record) -> list[Record]:
    return sorted(record["candidates"], key=lambda one: -one["inclusion"])


def _size(one: Record, what: str) -> str:
    return with_unit(short(one[what]), one["unit"])


def _achieved(one: Record) -> str:
    """Return the strength that is told, or what does the same instead."""
    if _finite(one["achieved"]):
        return _size(one, "achieved")
    other = one.get("instead")
    if other is None:
        return "not told"
    return f"not told: as {other['parameter']} {short(other['then'])}"


def _bias(one: Record) -> str:
    """Return the largest error of a parameter if the cause is ignored where it is just seen."""
    if not (one["bias"] and _finite(one["detectable"])):
        return "-"
    strength = min(one["detectable"], one["limit"])
    name = max(one["bias"], key=lambda key: abs(one["bias"][key]))
    return f"{name} {100.0 * strength * one['bias'][name]:+.0f} %"


def _finite(value: float | None) -> bool:
    return value is not None and math.isfinite(value)


def residual_rows(record: Record) -> list[list[str]]:
    """Return a row for every reading: measured, simulated, and their distance in errors."""
    rows, after = record["residuals"], record["residuals_after"]
    found = []
    for k, row in enumerate(rows):
        cells = [
            row["name"],
            plus_minus(row["measured"], row["measured_sd"]),
            plus_minus(row["simulated"], row["simulated_sd"]),
            shown(row["z"]),
            shown(row["z_left_out"]),
        ]
        found.append([*cells, shown(after[k]["z_left_out"])] if after else cells)
    return found


def group_rows(record: Record) -> list[list[str]]:
    """Return a row for every experiment, material and wall that was left out as a whole."""
    return [[one["kind"], one["name"], shown(one["z"]).lstrip("+")] for one in record["groups"]]


def engine_rows(record: Record) -> list[list[str]]:
    """Return a row for every target: measured, and what the engine gives without and with.

    Of a curve it is the level that is furthest off, with the cause perhaps another one.
    """
    after = {row["name"]: row for row in record["engine_after"]}
    found = []
    for row in record["engine_before"]:
        cells = [
            f"{row['label']}{_level(row)}",
            f"{plus_minus(row['measured'], row['measured_se'])} {row['unit']}",
            *_engine(row),
        ]
        if after:
            then = after[row["name"]]
            value, z = _engine(then)
            if then["level"] != row["level"] and z:
                measured = plus_minus(then["measured"], then["measured_se"])
                value = f"{value}{_level(then)}, measured {measured}"
            cells += [value, z]
        found.append(cells)
    return found


def _level(row: Record) -> str:
    return f" at {row['level']:g}" if _finite(row["level"]) else ""


def _engine(row: Record) -> list[str]:
    if not row["seeds"] or not _finite(row["simulated"]):
        return ["every run failed", ""]
    return [plus_minus(row["simulated"], row["simulated_se"] or math.nan), shown(row["z"])]


def held_out_rows(gain: Record) -> list[list[str]]:
    """Return a row for every place that was left out, and for all of them."""
    rows = [[name, f"{value:+.1f}"] for name, value in gain["by_place"].items()]
    return [*rows, ["all", f"{gain['log_density']:+.1f}"]]


def next_rows(record: Record) -> list[list[str]]:
    """Return a row for all that would tell of the cause, the best first."""
    return [
        [
            one["words"],
            one["name"],
            ", ".join(with_unit(f"{read['se']:g}", read["unit"]) for read in one["reads"]),
            f"{one['hours']:g}",
            f"{one['nats']:.2f} nats",
            "; ".join(_meaning(result, one["reads"]) for result in one["outcomes"]),
        ]
        for one in record["measure_next"]["offers"]
    ]


def _meaning(result: Record, reads: Sequence[Record]) -> str:
    names, units = [one["name"] for one in reads], [one["unit"] for one in reads]
    shares = ", ".join(f"{name} {p:.2f}" for name, p in result["probability"].items())
    return f"{result_words(result['values'], names, units)}: {shares}"


def supposed_words(record: Record) -> str:
    """Return what is supposed to have been measured, empty for a plain diagnosis."""
    return ", ".join(
        f"{one['name']} = {one['value']:g} ± {one['se']:g}" for one in record["supposed"]
    )


def change_rows(record: Record) -> list[list[str]]:
    """Return verdict and probabilities before a supposed measurement and with it."""
    before = record["before"]
    found = [["verdict", _verdict(before), _verdict(record), ""]]
    old, new = _answers(before), _answers(record)
    for name in sorted(new, key=lambda one: -max(old.get(one, 0.0), new[one])):
        was, now = old.get(name, 0.0), new[name]
        if max(was, now) >= TOLD:
            found.append([name, f"{was:.2f}", f"{now:.2f}", f"{now - was:+.2f}"])
    return found


def _answers(record: Record) -> dict[str, float]:
    """Return the probabilities of none, unknown, and of each cause alone or in a pair."""
    shares = record["probabilities"]
    return {**{name: shares[name] for name in (NONE, UNKNOWN)}, **record["inclusion"]}


def _verdict(record: Record) -> str:
    kind = KINDS[record["verdict"]]
    return f"{kind}: {', '.join(record['names'])}" if record["names"] else kind


def is_large(heading: str, cell: str) -> bool:
    """Whether a cell is a difference that the errors do not explain.

    Parameters
    ----------
    heading : str
        Of its column; differences in standard errors are called z.
    cell : str
    """
    try:
        return heading.startswith("z") and significant(float(cell))
    except ValueError:
        return False
