"""Random contact models of those that few scripts have, for `random_scripts`."""

from __future__ import annotations

import random
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3]))


from tests.twins.model_list import MODELS, SETTINGS, without_strays
from tests.twins.scene import Model
from tests.twins.strategies import rare_materials

__all__ = ["further_materials", "further_models"]

KNOWN = ("hertz", "hooke")


def further_models(draw: random.Random) -> tuple[str, str]:
    """Return model words and settings; normal model or rolling model are none of the usual ones."""
    names = {key: draw.choice(found) for key, found in MODELS.items()}
    if names["model"] in KNOWN:
        names["rolling_friction"] = "epsd3"
    on = frozenset(name for name in SETTINGS if draw.random() < 0.4)
    model = without_strays(Model(names, on, frozenset(SETTINGS) - on))
    words = [f"{key} {name}" for key, name in model.names.items() if name != "off"]
    return " ".join(words), model.settings()


def further_materials(seed: int) -> list[str]:
    """Return the lines of values that these models take, of two types."""
    lines = []
    for name, values in rare_materials(np.random.default_rng(seed)).items():
        form = "peratomtypepair 2" if np.ndim(values) else "scalar"
        numbers = " ".join(f"{value:.6g}" for value in np.ravel(values))
        lines.append(f"fix v_{name} all property/global {name} {form} {numbers}")
    return lines
