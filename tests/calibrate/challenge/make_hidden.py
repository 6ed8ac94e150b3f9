"""Make the studies with hidden causes that the tests diagnose, by the engine.

    python -m tests.calibrate.challenge.make_hidden tests/data/hidden

Parameters and causes are chosen, not drawn; everything else is as in a suite.
"""

from __future__ import annotations

import sys
from pathlib import Path

from rich.console import Console

from calibrate.challenge.folders import Suite
from calibrate.challenge.laboratory import study_cases
from calibrate.challenge.learnt import learnt_of
from calibrate.challenge.making import Plan, make_suite
from calibrate.challenge.rules import Rules
from calibrate.challenge.truths import Hidden, Truth
from calibrate.cli.running import running
from calibrate.cli.show.progress import RunsBar
from calibrate.runs.executors.run_options import RunOptions
from tests.paths import ROOT

CASES = ROOT / "cases" / "challenge"
RULES = Rules(name="hidden", study="one_material.toml", runs="runs/one_material.csv.gz", repeats=4)
VALUES = {"mu_pp": 0.3, "mu_roll_pp": 0.15, "mu_pw": 0.25, "mu_roll_pw": 0.2, "e_pp": 0.5,
          "e_pw": 0.7}  # fmt: skip
TRUTHS = (
    ("nothing", ()),
    ("single", (Hidden("plate_tilt_deg", 2.5),)),
    ("single", (Hidden("cohesion_J_m3", 6e4),)),
    ("single", (Hidden("size_distribution", 1.0),)),
    ("single", (Hidden("restitution_slope", 0.2),)),
    ("pair", (Hidden("mass_flow_factor", -0.15), Hidden("restitution_slope", 0.2))),
    ("single", (Hidden("plate_period", 0.08),)),
    ("foreign", (Hidden("box_width", 0.6),)),
)


def main(out: Path) -> None:
    """Run the laboratory."""
    data, learnt = learnt_of(RULES, CASES)
    truths = tuple(
        Truth(number, kind, VALUES, hidden) for number, (kind, hidden) in enumerate(TRUTHS, start=1)
    )
    cases = tuple(study_cases(data, one, RULES.repeats) for one in truths)
    plan = Plan(truths, cases, ({},) * len(truths))
    note = {"seed": "chosen", "design": RULES.runs}
    out.mkdir(parents=True, exist_ok=True)
    bar = RunsBar("studies", Console(stderr=True))
    with running(out, RunOptions(workers=2), bar) as campaign:
        make_suite(RULES, data, learnt, plan, campaign, Suite(out), note, bar.say)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
