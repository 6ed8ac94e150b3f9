"""From emulators and measured values to what is known of the unknowns.

Arrays in, arrays out: nothing here knows a study or a run. A `Problem` says what is unknown
(`Space`) and what was measured where (`Place`, `Reading`); `sample` gives its `Posterior`.
"""

from calibrate.inference.determined import Determined, determined
from calibrate.inference.intervals import Interval
from calibrate.inference.likelihood import log_likelihood
from calibrate.inference.posterior import Posterior, Region
from calibrate.inference.predictive import predictive, scores
from calibrate.inference.priors import Prior
from calibrate.inference.problem import Known, Place, Problem, Reading, Source
from calibrate.inference.sampler.target import Stopped
from calibrate.inference.sampling import sample
from calibrate.inference.space import Space, Tie, Unknown
from calibrate.inference.store import load_posterior, posterior_record, save_posterior

__all__ = [
    "Determined",
    "Interval",
    "Known",
    "Place",
    "Posterior",
    "Prior",
    "Problem",
    "Reading",
    "Region",
    "Source",
    "Space",
    "Stopped",
    "Tie",
    "Unknown",
    "determined",
    "load_posterior",
    "log_likelihood",
    "posterior_record",
    "predictive",
    "sample",
    "save_posterior",
    "scores",
]
