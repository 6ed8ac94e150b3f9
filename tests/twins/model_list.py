"""The contact models to be tested: all that the registry of the engine knows."""

from __future__ import annotations

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
    """Return the k-th of some models of LIGGGHTS; together they have every name and setting."""
    names = {key: found[k % len(found)] for key, found in MODELS.items()}
    on = frozenset(name for at, name in enumerate(SETTINGS) if (k + at) % 2)
    return without_strays(Model(names, on, frozenset(SETTINGS) - on))


FEW = variant(1), variant(2)
"""Models of which the loops of their own are tested; to compile one takes half a minute."""
