"""The contact models to be tested: all that the registry of the engine knows."""

from __future__ import annotations

from minidem.contact import extensions
from minidem.contact import model as registry
from minidem.contact.model import BELONGS_TO, EXCLUDES, NEEDS
from tests.twins.scene import Model

UNLIKE = {
    "model": ("thornton_ning",),
    "cohesion": ("easo/capillary/viscous", "washino/capillary/viscous"),
}
"""Models without a twin, by keyword: most random contacts of the first end in nan, in LIGGGHTS too,
and the others act across gaps, where the twins have no contacts. What LIGGGHTS makes of them is
stored, see `tests.minidem.wet.wet_list`."""
MODELS = {
    key: tuple(name for name in names if name not in UNLIKE.get(key, ()))
    for key, names in registry.MODELS.items()
}
SETTINGS = tuple(
    setting
    for setting in registry.SETTINGS
    if set(BELONGS_TO.get(setting, ("", MODELS["model"]))[1]) - set(UNLIKE["cohesion"])
)

EXTENSIONS = tuple(extensions.SETTINGS)
ALL_SETTINGS = (*SETTINGS, *EXTENSIONS)


def without_strays(model: Model) -> Model:
    """Return a model without what does not exist beside its normal model."""
    names = dict(model.names)
    for (key, name), (_, normal) in NEEDS.items():
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
