"""The twins have every contact model and setting that the engine has."""

from __future__ import annotations

import pytest

from tests.twins.model_list import ALL_SETTINGS, FEW, MODELS
from tests.twins.slow import contact


@pytest.mark.parametrize("key", sorted(MODELS))
def test_every_model_has_a_twin(key: str):
    missing = set(MODELS[key]) - set(contact.MODELS.get(key, ()))
    assert not missing, (
        f"'{key}' has names without a slow twin: {', '.join(sorted(missing))}. Write each as a "
        f"function on 3-vectors from its published formula in tests/twins/contact.py, enter it in "
        f"MODELS['{key}'] there, and give its material values a range in tests/twins/strategies.py"
    )


def test_every_setting_has_a_twin():
    missing = set(ALL_SETTINGS) - set(contact.SETTINGS)
    assert not missing, (
        f"settings without a slow twin: {', '.join(sorted(missing))}. Say in "
        "tests/twins/contact.py what `contact` does when they are on, enter their defaults in "
        "SETTINGS there, and give their material values a range in tests/twins/strategies.py"
    )


def test_the_twins_have_no_model_that_is_gone():
    assert {key: set(found) for key, found in contact.MODELS.items()} == {
        key: set(found) for key, found in MODELS.items()
    }
    assert set(contact.SETTINGS) == set(ALL_SETTINGS)


def test_some_models_differ_in_every_name():
    assert all(FEW[0].names[key] != FEW[1].names[key] for key in MODELS if len(MODELS[key]) > 1)
