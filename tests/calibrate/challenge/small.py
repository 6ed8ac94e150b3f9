"""Rules of a small suite on formulas."""

from __future__ import annotations

from dataclasses import replace

from calibrate.challenge.rules import Rules
from tests.calibrate.causes import studies

RULES = Rules(
    name="small", study="", runs="", nothing=1, single=2, foreign=1, repeats=4,
    noncentrality=[11.0], from_prior=0.0, other_numerics=0.0, liggghts=0.0, fresh=1.0,
)  # fmt: skip
TWINS = 12
FEW = replace(studies.FEW, held_out=True)
NOTE = {"seed": "a commit", "design": "a digest"}
