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


def _model(normal: str, tangential: str, cohesion: str, rolling: str, *on: str) -> Model:
    names = {"model": normal, "tangential": tangential, "cohesion": cohesion}
    names |= {"rolling_friction": rolling, "surface": "default"}
    return without_strays(Model(names, frozenset(on), frozenset(SETTINGS) - {*on}))


FEW = (
    _model("hertz", "history", "sjkr", "epsd2", "tangential_damping", "torsionTorque"),
    _model("hooke", "no_history", "sjkr2", "cdt", "limitForce", "tangential_reduce", "ktToKnUser"),
)
"""Models that have loops of their own, which are tested; to compile one takes half a minute."""
