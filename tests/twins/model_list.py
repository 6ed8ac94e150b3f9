"""The contact models to be tested: all that the registry of the engine knows."""

from __future__ import annotations

from itertools import product

from minidem.contact import extensions
from minidem.contact.model import BELONGS_TO, MODELS, SETTINGS
from tests.twins.scene import Model

EXTENSIONS = tuple(extensions.SETTINGS)
ALL_SETTINGS = (*SETTINGS, *EXTENSIONS)


def without_strays(model: Model) -> Model:
    """Return a model without the settings that do not exist beside it."""
    stray = {
        setting for setting, (key, names) in BELONGS_TO.items() if model.names[key] not in names
    }
    return Model(model.names, model.on - stray, model.off - stray)


def variant(k: int) -> Model:
    """Return the k-th of a few models of LIGGGHTS; together they have every name and setting."""
    names = {key: found[k % len(found)] for key, found in MODELS.items()}
    on = frozenset(name for at, name in enumerate(SETTINGS) if (k + at) % 2)
    return without_strays(Model(names, on, frozenset(SETTINGS) - on))


FEW = tuple(variant(k) for k in range(max(len(found) for found in MODELS.values())))
"""Models that the compiled engine is tested with; each is compiled once, which takes seconds."""


def combinations() -> int:
    """Return the number of different models and settings."""
    return len(list(product(*MODELS.values()))) * 2 ** len(ALL_SETTINGS)
