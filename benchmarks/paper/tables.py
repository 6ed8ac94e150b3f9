"""The tables of the page, each a list of Markdown lines, from stored results alone."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import pandas as pd

from benchmarks.paper import sources

MISSING = "-"
NOT_YET = "Too few runs are stored yet; the commands above go on."
PLACES = {
    "angle": ("angle_of_repose", "angle_deg", "sem_deg"),
    "t100": ("conveyor", "t100_s", "sem_s"),
}
BOXES = ("m1_g", "m2_g", "m3_g", "m4_g")
FLAGS = {"no_intersection": "*", "unreachable": "†"}
SHARED_WALLS = ("steel", "alumina")


def _lines(head: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    return [
        f"| {' | '.join(head)} |",
        "|" + "---|" * len(head),
        *(f"| {' | '.join(row)} |" for row in rows),
    ]


def _pm(value: float, error: float, digits: int = 2) -> str:
    return f"{value:.{digits}f} ± {error:.{digits}f}"


def angles() -> list[str]:
    """Return Table B.4 as the studies read it."""
    return _measured("angle_of_repose", "angle_deg", "sem_deg", "deg")


def times() -> list[str]:
    """Return Table B.5 as the studies read it."""
    return _measured("conveyor", "t100_s", "sem_s", "s")


def _measured(name: str, column: str, error: str, unit: str) -> list[str]:
    table = sources.table(name)
    walls = list(dict.fromkeys(table["surface"]))
    rows = []
    for particle, part in table.groupby("particle", sort=False):
        by = part.set_index("surface")
        rows.append([str(particle), *(_pm(by[column][w], by[error][w]) for w in walls)])
    return _lines(["particle", *(f"{wall} ({unit})" for wall in walls)], rows)


def boxes() -> list[str]:
    """Return Table B.6 as the studies read it."""
    rows = [
        [
            one["particle"], one["surface"], f"{one['initial_g']:.2f}",
            *(_pm(one[box], one[f"{box.removesuffix('_g')}_sem"]) for box in BOXES),
        ]
        for one in sources.table("plate_impact").to_dict("records")
    ]  # fmt: skip
    heads = ["particle", "surface", "initial (g)", *(f"box {k} (g)" for k in range(1, 5))]
    return _lines(heads, rows)


def flows() -> list[str]:
    """Return Table B.9 as the studies read it."""
    rows = [
        [one["particle"], f"{one['flat_d_g_s']:.2f}", f"{one['glued_c_g_s']:.2f}"]
        for one in sources.table("funnel_mass_flow").to_dict("records")
    ]
    return _lines(["particle", "flat, (d) (g/s)", "glued, (c) (g/s)"], rows)


def _share(value: float) -> str:
    return MISSING if pd.isna(value) else f"{value:.2f}"


def _ours(found: pd.DataFrame, keys: Sequence[str]) -> str:
    """Return median and 90 % interval of an unknown under the first of its names that is there."""
    if found.empty:
        return MISSING
    by = found.set_index("name")
    key = next((one for one in keys if one in by.index), None)
    if key is None:
        return MISSING
    row = by.loc[key]
    text = f"{row['median']:.3g} [{row['low_90']:.2g}, {row['high_90']:.2g}]"
    return text if row["determined"] else f"({text})"


def parameters(study: str, names: Sequence[str] = sources.CONTACT) -> list[str]:
    """Return Table B.7 beside what a study gave."""
    if sources.result(f"parameters_{study}").empty:
        return [NOT_YET]
    found, table = sources.result(f"parameters_{study}"), sources.table("calibrated_parameters")
    rows = []
    for one in table.to_dict("records"):
        material = sources.MATERIALS[one["particle"]]
        if study == "hsp13" and material != "HSP13":
            continue
        cells = [one["particle"], one["surface"] + FLAGS.get(str(one["flag"]), "")]
        for name in names:
            theirs = MISSING if pd.isna(one[name]) else f"{one[name]:.3g}"
            keys = [f"{name}[{material}/{one['surface']}]", f"{name}[{one['surface']}]"]
            keys = [f"{name}[{material}]", name] if name.endswith("_pp") else keys
            cells.append(f"{theirs}; {_ours(found, keys)}")
        rows.append(cells)
    return _lines(["particle", "surface", *names], rows)


def apparatus(study: str) -> list[str]:
    """Return what a study says of the dimensions that the paper does not print."""
    found = sources.result(f"parameters_{study}")
    if found.empty:
        return [NOT_YET]
    held = sources.result("held_out_apparatus")
    names = [] if found.empty else [n for n in found["name"] if "." in n and "[" not in n]
    rows = [[name, _ours(found, [name]), _plain(held, name)] for name in names]
    return _lines(["dimension", "fitted", "HSP13 at the paper's parameters"], rows)


def _plain(found: pd.DataFrame, name: str) -> str:
    if found.empty or name not in set(found["name"]):
        return MISSING
    row = found.set_index("name").loc[name]
    return f"{row['median']:.3g} [{row['low_90']:.2g}, {row['high_90']:.2g}]"


def deviations(study: str) -> list[str]:
    """Return every target of a study with its deviation from what was measured."""
    found = sources.result(f"targets_{study}")
    if found.empty:
        return [NOT_YET]
    rows = []
    for one in found.to_dict("records"):
        off = 100.0 * (one["predicted"] / one["measured"] - 1.0)
        sd = 100.0 * one["predicted_sd"] / one["measured"]
        engine = MISSING if not one["seeds"] else f"{one['engine']:.3g} ({one['seeds']:.0f})"
        rows.append([
            one["name"], _pm(one["measured"], one["measured_se"]),
            _pm(one["predicted"], one["predicted_sd"]), f"{off:+.1f} ± {sd:.1f} %",
            f"{one['z']:+.1f}", f"{one['discrepancy']:.2f}", engine,
        ])  # fmt: skip
    heads = ["target", "measured", "ours", "deviation", "in standard errors", "cannot be met",
             "engine (seeds)"]  # fmt: skip
    return _lines(heads, rows)


def held_out() -> list[str]:
    """Return every target as predicted with the apparatus that HSP13 gave."""
    found = sources.result("held_out")
    rows = []
    for one in found.to_dict("records"):
        flag = "" if pd.isna(one["flag"]) else FLAGS.get(str(one["flag"]), "")
        rows.append([
            one["name"] + flag, "learnt from" if one["learnt"] else "predicted",
            _pm(one["measured"], one["measured_se"]), _pm(one["predicted"], one["predicted_sd"]),
            f"{100.0 * (one['predicted'] / one['measured'] - 1.0):+.0f} %", f"{one['z']:+.1f}",
        ])  # fmt: skip
    heads = ["target", "", "measured", "predicted", "error", "in standard errors"]
    return _lines(heads, rows)


def held_out_summary() -> list[str]:
    """Return how the predictions did, by observable."""
    found = sources.result("held_out")
    if found.empty:
        return []
    rows = []
    for learnt, word in ((True, "HSP13, learnt from"), (False, "the other four, predicted")):
        rest = found[found["learnt"] == learnt]
        for name, part in rest.groupby("observable", sort=False):
            off = (part["predicted"] / part["measured"] - 1.0).abs()
            rows.append([
                word, str(name), str(len(part)), f"{100.0 * off.median():.0f} %",
                f"{100.0 * off.max():.0f} %", f"{math.sqrt((part['z'] ** 2).mean()):.1f}",
                f"{(part['z'].abs() <= 2.0).sum()} of {len(part)}",
            ])  # fmt: skip
    heads = ["", "observable", "targets", "median error", "largest", "rms standard errors",
             "within two"]  # fmt: skip
    made = _lines(heads, rows)
    return made if not found["learnt"].all() else [*made, "", f"The other four: {NOT_YET}"]


def campaign(name: str) -> list[str]:
    """Return what the stored runs are and what they cost."""
    found = sources.result(f"campaign_{name}")
    rows = []
    for keys, one in found.groupby(["particle", "experiment", "surface"], sort=False):
        part = one.iloc[0]
        rows.append([
            *map(str, keys), f"{part['runs']:.0f}", f"{part['failed']:.0f}",
            f"{part['particle_steps'] / 1e9:.2f}", f"{part['wall_s'] / 3600.0:.2f}",
        ])  # fmt: skip
    if rows:
        total = found[["runs", "failed", "particle_steps", "wall_s"]].sum()
        rows.append([
            "**all**", "", "", f"{total['runs']:.0f}", f"{total['failed']:.0f}",
            f"{total['particle_steps'] / 1e9:.2f}", f"{total['wall_s'] / 3600.0:.2f}",
        ])  # fmt: skip
    heads = ["particle", "experiment", "surface", "runs", "failed", "1e9 particle-steps",
             "hours on the clock"]  # fmt: skip
    return _lines(heads, rows)


def quality(study: str) -> list[str]:
    """Return how well the emulators of a study know runs that they have not seen."""
    if sources.result(f"quality_{study}").empty:
        return [NOT_YET]
    rows = [
        [
            one["experiment"], one["kind"], one["output"], f"{one['n']:.0f}",
            _share(one["Q2"]), f"{one['z_rms']:.2f}",
        ]
        for one in sources.result(f"quality_{study}").to_dict("records")
    ]  # fmt: skip
    return _lines(["experiment", "surface", "output", "runs", "Q2", "error in stated errors"], rows)


def sensitivity() -> list[str]:
    """Return how far each parameter moves each observable over its range, one at a time."""
    found = sources.result("sensitivity")
    rows = []
    if not found.empty:
        for keys, part in found.groupby(["experiment", "surface", "observable"], sort=False):
            by = part.set_index("parameter")
            cells = [
                f"{by['span'][name]:.2g} ({by['at_high'][name] - by['at_low'][name]:+.2g})"
                if name in by.index else MISSING
                for name in sources.CONTACT
            ]  # fmt: skip
            rows.append([f"{keys[0]}, {keys[1]}", keys[2], *cells, f"{part['sd'].median():.2g}"])
    heads = ["experiment", "observable", *sources.CONTACT, "emulator's error"]
    return _lines(heads, rows)


def sensitivity_engine() -> list[str]:
    """Return how far runs of the engine move, one parameter at a time; luck is not counted."""

    def cell(one: pd.Series) -> str:
        if one["direction"] == "not seen":
            return f"not seen ({one['span']:.2g})"
        return f"{one['span']:.2g}, {one['direction']}"

    found = sources.result("sensitivity_engine")
    return _crossed(found[found["span"].notna()] if len(found) else found, cell)


def sobol() -> list[str]:
    """Return first and total Sobol indices; * no larger than what the emulator's error makes."""

    def cell(one: pd.Series) -> str:
        return f"{one['first']:.2f}, {one['total']:.2f}{'' if one['seen'] else '*'}"

    found = sources.result("sensitivity_engine")
    return _crossed(found[found["total"].notna()] if len(found) else found, cell)


def _crossed(found: pd.DataFrame, cell: Callable[[pd.Series], str]) -> list[str]:
    """Return a row for each place and output, a column for each parameter."""
    if found.empty:
        return [NOT_YET]
    names = list(dict.fromkeys(found["parameter"]))
    rows = []
    for keys, part in found.groupby(["place", "output"], sort=False):
        cells = {one["parameter"]: cell(one) for _, one in part.iterrows()}
        rows.append([*keys, *(cells.get(name, MISSING) for name in names)])
    return _lines(["place", "output", *names], rows)


def contours() -> list[str]:
    """Return the pictures of the particles that have runs enough for one."""
    found = []
    for theirs, ours in sources.MATERIALS.items():
        path = sources.contours_of(ours)
        picture = f"![Contours of {theirs}](images/{path.name})"
        found += [f"{theirs}:", "", picture if path.exists() else NOT_YET, ""]
    return found[:-1]
