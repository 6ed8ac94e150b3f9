"""What the parts of a study have to do with each other and with the experiments.

Each check notes all that it finds; the first run starts only when nobody found anything.
"""

from calibrate.study.checks.parts import check_parts
from calibrate.study.checks.runs import check_runs

__all__ = ["check_parts", "check_runs"]
