"""The table of what minidem understands, made from the registry of commands.

``python -m minidem.compatibility docs/compatibility.md`` writes the page; without a file name it
prints it. A test compares the page with the code.
"""

from __future__ import annotations

import sys
from collections.abc import Collection, Sequence
from pathlib import Path

from minidem.commands.command import COMMANDS
from minidem.contact.extensions import EXTENSIONS
from minidem.contact.model import LACKING, MODELS, ONLY_OFF, SETTINGS
from minidem.contact.properties import values_of_models
from minidem.insertion.region import STYLES as REGIONS
from minidem.output.dump import DUMPS
from minidem.script import names
from minidem.script.control import CONTROL
from minidem.script.formula import ARITY, GROUP_FUNCTIONS, MASKS, VECTOR_FUNCTIONS
from minidem.script.variables import STYLES
from minidem.world.compute import COMPUTES
from minidem.world.fix import FIXES

__all__ = ["main", "page"]

_HEAD = """# What minidem understands of LIGGGHTS

This page is made from the code: `python -m minidem.compatibility docs/compatibility.md`.
Reference is LIGGGHTS-PUBLIC 3.8.0. *Supported* means: same meaning, checked against that program
where a test can; [what differs](differences.md) has a page of its own. Anything else is refused
before the first step with file, line and word, never skipped silently;
[`minidem --check`](how-to/check-a-script.md) lists it all without a run:

    in.script:12: unknown fix 'wall/grann'; did you mean 'wall/gran'?
    in.script:41: command 'minimize' exists in LIGGGHTS but not in minidem
"""
_EXTENSIONS = """## Extensions of minidem

Effects that LIGGGHTS 3.8.0 lacks. A script with one of these words runs on minidem only; with
`minidem --strict` it is refused:

    in.script:12: 'drag/sphere' is an extension of minidem that LIGGGHTS 3.8.0 does not have;
    take it out, or run without --strict

Without strength (equal friction coefficients, exponent 0, deviation 0, stiffness factor 1, drag
factor 0) the result is that of the base model, bit for bit. Pairs with an extended contact law run
in a plainer loop, about half as fast; so do all pairs of the models `hooke/stiffness`,
`hertz/stiffness`, `hooke/hysteresis`, `luding`, `edinburgh`, `edinburgh/stiffness`,
`thornton_ning`, of `rolling_friction epsd3` and `luding`, and of the liquid bridges of
`cohesion easo/capillary/viscous` and `washino/capillary/viscous`, which have no loop of their own.
"""


def _list(words: Collection[str]) -> str:
    return ", ".join(f"`{word}`" for word in sorted(words)) or "none"


def _section(title: str, supported: Collection[str], all_names: Collection[str]) -> list[str]:
    """Return a section: what is supported and what LIGGGHTS has besides."""
    missing = set(all_names) - set(supported)
    return [
        f"## {title}",
        "",
        "| | names |",
        "|---|---|",
        f"| supported | {_list(supported)} |",
        f"| refused: *exists in LIGGGHTS but not in minidem* | {_list(missing)} |",
        "",
    ]


def _extensions() -> list[str]:
    """Return the section of what LIGGGHTS lacks."""
    lines = [_EXTENSIONS]
    for one in EXTENSIONS.values():
        values = ", ".join(f"`{name}`".replace(" (", "` (", 1).rstrip("`") for name in one.values)
        lines += [
            f"**`{one.word}`**: {one.usage}.",
            *([f"Values: {values}."] if values else []),
            f"Law: `{one.law}`; {one.terms}.",
            f"Source: {one.source}.",
            "",
        ]
    return lines


def page() -> str:
    """Return the page as Markdown."""
    commands = {*COMMANDS, *CONTROL}
    lines = [_HEAD]
    lines += _section("Commands", commands, names.COMMANDS)
    lines += _section("Fix styles", {*FIXES} - {*EXTENSIONS}, names.FIXES)
    lines += _section("Compute styles", COMPUTES, names.COMPUTES)
    lines += _section("Dump styles", DUMPS, names.DUMPS)
    lines += [
        "## Regions, contact models and variables",
        "",
        "| | names |",
        "|---|---|",
        f"| region styles | {_list(REGIONS)} |",
        *(f"| contact model keyword `{key}` | {_list(found)} |" for key, found in MODELS.items()),
        f"| contact model settings | {_list(SETTINGS)} |",
        f"| contact model settings, `off` only | {_list(ONLY_OFF)} |",
        f"| variable styles | {_list(STYLES)} |",
        f"| functions in formulas | {_list({*ARITY, *MASKS, *VECTOR_FUNCTIONS})} |",
        f"| group functions (those the engine answers) | {_list(GROUP_FUNCTIONS - {'charge'})} |",
        "",
        "Values that contact models take with `fix property/global`, beside `youngsModulus`,",
        "`poissonsRatio` and `coefficientRestitution`, which the stiffness models do without:",
        "",
        "| model | values |",
        "|---|---|",
        *(f"| `{model}` | {_list(values)} |" for model, values in values_of_models().items()),
        "",
        "## What to use instead of what is refused",
        "",
        "The message for these words ends with it.",
        "",
        "| refused | instead |",
        "|---|---|",
        *(f"| `{word}` | {remedy} |" for word, remedy in sorted(names.REMEDIES.items())),
        *(f"| `{start}...` | {why} |" for start, why in names.OUT_OF_SCOPE),
        *(f"| contact model `{name}` | {why} |" for name, why in LACKING.items()),
        "",
        *_extensions(),
    ]
    return "\n".join(lines).rstrip() + "\n"


def main(words: Sequence[str]) -> int:
    """Write the page to the named file, or to the screen; return the exit code."""
    if words:
        Path(words[0]).write_text(page(), encoding="utf-8")
    else:
        sys.stdout.write(page())
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
