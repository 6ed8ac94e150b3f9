"""What a small suite on formulas is drawn from."""

from __future__ import annotations

import pytest

from calibrate.challenge.learnt import cause_cases, learn
from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.runs import make_runs
from tests.calibrate.causes import studies
from tests.calibrate.challenge.small import TWINS


@pytest.fixture(scope="session")
def design(tmp_path_factory):
    """Return the study of a suite on formulas and what its design teaches."""
    data = studies.study(tmp_path_factory.mktemp("challenge"), {}, 3)
    base = studies.base_runs(data)
    specs = [one for one in cause_cases(data, base, TWINS) if set(one.effects) & set(studies.GAINS)]
    twins = make_runs(specs, "", studies.run, forms_of(data))
    return data, learn(data, base.joined(twins))
