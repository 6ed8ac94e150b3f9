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
from calibrate.study.data import StudyData
from tests.paths import ROOT

CASES = ROOT / "cases" / "challenge"
RUNS = ["one_material", "small_strengths", "cohesion_again", "plate_impact_twins"]
RULES = Rules(
    name="hidden", study="one_material.toml", runs=[f"runs/{one}.csv.gz" for one in RUNS],
    repeats=6, errors="runs",
)  # fmt: skip
NOTE = {"seed": "chosen", "design": " ".join(RUNS)}
NAMES = ("mu_pp", "mu_roll_pp", "mu_pw", "mu_roll_pw", "e_pp", "e_pw")
ORDINARY = (0.3, 0.15, 0.25, 0.2, 0.5, 0.7)
SLIDING = (0.29, 0.48, 0.33, 0.49, 0.84, 0.56)
ROLLING = (0.32, 0.14, 0.2, 0.43, 0.7, 0.6)
LEVEL = (0.27, 0.23, 0.26, 0.26, 0.75, 0.45)
TRUTHS = (
    ("nothing", ORDINARY, ()),
    ("single", LEVEL, (Hidden("plate_tilt_deg", -5.8),)),
    ("single", ORDINARY, (Hidden("cohesion_J_m3", 7.5e4),)),
    ("single", ROLLING, (Hidden("size_distribution", 1.5),)),
    ("single", SLIDING, (Hidden("restitution_slope", 0.5),)),
    ("pair", SLIDING, (Hidden("mass_flow_factor", -0.2), Hidden("restitution_slope", 0.5))),
    ("foreign", ORDINARY, (Hidden("box_width", 0.036),)),
    ("single", LEVEL, (Hidden("plate_tilt_deg", 3.0),)),
)
"""Kind, parameters, and what is hidden."""


def plan(data: StudyData) -> Plan:
    """Return what is hidden, and the runs."""
    truths = tuple(
        Truth(number, kind, dict(zip(NAMES, values, strict=True)), hidden)
        for number, (kind, values, hidden) in enumerate(TRUTHS, start=1)
    )
    cases = tuple(study_cases(data, one, RULES.repeats) for one in truths)
    return Plan(truths, cases, ({},) * len(truths))


def main(out: Path) -> None:
    """Run the laboratory; runs that are in the table there are not made again."""
    data, learnt = learnt_of(RULES, CASES)
    out.mkdir(parents=True, exist_ok=True)
    bar = RunsBar("studies", Console(stderr=True))
    with running(out, RunOptions(workers=2), bar) as campaign:
        make_suite(RULES, data, learnt, plan(data), campaign, Suite(out), NOTE, bar.say)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
