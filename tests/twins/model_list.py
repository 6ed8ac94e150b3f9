"""The contact models to be tested: all that the registry of the engine knows."""

from __future__ import annotations

from minidem.contact import extensions
from minidem.contact.model import BELONGS_TO, EXCLUDES, MODELS, NEEDS, SETTINGS
from tests.twins.scene import Model

EXTENSIONS = tuple(extensions.SETTINGS)
ALL_SETTINGS = (*SETTINGS, *EXTENSIONS)


def without_strays(model: Model) -> Model:
    """Return a model without what does not exist beside its normal model."""
    names = dict(model.names)
    for (key, name), normal in NEEDS.items():
        if names[key] == name and names["model"] not in normal:
            names[key] = MODELS[key][1]
    stray = {setting for setting, (key, known) in BELONGS_TO.items() if names[key] not in known}
    stray |= {one for one, others in EXCLUDES.items() if model.on & {*others}}
    return Model(names, model.on - stray, model.off - stray)


def variant(k: int) -> Model:
    """Return the k-th of some models of LIGGGHTS; together they have every name and setting."""
    names = {key: found[k % len(found)] for key, found in MODELS.items()}
    on = frozenset(name for at, name in enumerate(SETTINGS) if (k + at) % 2)
    return without_strays(Model(names, on, frozenset(SETTINGS) - on))


FEW = variant(1), variant(2)
"""Models of which the loops of their own are tested; to compile one takes half a minute."""
