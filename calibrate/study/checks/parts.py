"""Every check that needs no measured data and no whole study."""

from __future__ import annotations

from calibrate.study.checks.measured import check_measured
from calibrate.study.checks.parameters import check_parameters
from calibrate.study.checks.rigs import check_rigs
from calibrate.study.checks.stages import check_stages
from calibrate.study.draft import Draft
from calibrate.study.mistakes import Mistakes

__all__ = ["check_parts"]


def check_parts(draft: Draft, mistakes: Mistakes) -> None:
    """Note every mistake that needs no measured data and no whole study."""
    check_measured(draft, mistakes)
    check_rigs(draft, mistakes)
    check_parameters(draft, mistakes)
    check_stages(draft, mistakes)
