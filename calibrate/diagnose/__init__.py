"""What the calibrated simulation still gets wrong, and which cause fits.

`diagnose(problem, runner, rng=...)` refits all parameters jointly, says per observable how far the
simulation is off, which candidate causes could be seen at all, and reaches a verdict with
calibrated error rates: nothing significant, one named cause, a group, or unknown.
"""

from calibrate.diagnose.local.design import DesignOptions
from calibrate.diagnose.pipeline import Diagnosis, Options, diagnose
from calibrate.diagnose.problem import Candidate, Nuisance, Observable, Parameter, Problem
from calibrate.diagnose.verdict import Levels

__all__ = [
    "Candidate",
    "DesignOptions",
    "Diagnosis",
    "Levels",
    "Nuisance",
    "Observable",
    "Options",
    "Parameter",
    "Problem",
    "diagnose",
]
