"""What a study says of a parameter: value, range, prior, scope, tie."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, model_validator

from calibrate.study.places import ScopeName
from calibrate.study.schema.words import Bounds, NumberByInstance, RangeByInstance, Table

__all__ = ["Parameter", "Prior"]

_SEEN = 4.0
"""Standard deviations of a half-normal prior beyond which nothing of it is left."""


class Prior(Table):
    """What is believed of a free parameter before the data; uniform where nothing is given.

    Attributes
    ----------
    normal : (float, float), optional
        Mean and standard deviation.
    half_normal : float, optional
        Standard deviation of what is above zero.
    """

    normal: Bounds | None = None
    half_normal: Annotated[float, Field(gt=0.0)] | None = None

    @model_validator(mode="after")
    def _one(self) -> Prior:
        if self.normal is not None and self.half_normal is not None:
            msg = "a prior is normal or half_normal; give one of them"
            raise ValueError(msg)
        if self.normal is not None and self.normal[1] <= 0.0:
            msg = f"normal = [{self.normal[0]:g}, {self.normal[1]:g}]: give [mean, sd] with sd > 0"
            raise ValueError(msg)
        return self

    @property
    def uniform(self) -> bool:
        """Whether every value of the range is as likely as any other."""
        return self.normal is None and self.half_normal is None

    def misses(self, low: float, high: float) -> bool:
        """Whether a range holds nothing of what is believed."""
        if self.normal is not None:
            return not low <= self.normal[0] <= high
        return self.half_normal is not None and (high <= 0.0 or low >= _SEEN * self.half_normal)


def _prior(given: Any) -> Any:
    return {} if given == "uniform" else given


class Parameter(Table):
    """What a study says of one parameter; with a range it is free.

    Attributes
    ----------
    range : dict of str to (float, float)
        By instance; empty when it is not free.
    value : dict of str to float
        By instance: until a stage frees it, or for good.
    published : dict of str to float
        By instance: shown beside the result, used nowhere.
    scope : str, optional
        Between what it may differ; its name decides where this is left out.
    spacing : {"linear", "log"}
        On what scale the range is searched.
    prior : Prior
    tie : {"material", "surface"}, optional
        Between what it is alike, up to a spread that is inferred.
    """

    range: RangeByInstance = Field(default_factory=dict)
    value: NumberByInstance = Field(default_factory=dict)
    published: NumberByInstance = Field(default_factory=dict)
    scope: ScopeName | None = None
    spacing: Literal["linear", "log"] = "linear"
    prior: Annotated[Prior, BeforeValidator(_prior)] = Prior()
    tie: Literal["material", "surface"] | None = None

    @model_validator(mode="after")
    def _check(self) -> Parameter:
        for low, high in self.range.values():
            if not low < high:
                msg = f"range = [{low:g}, {high:g}] is no range; give [low, high] with low < high"
                raise ValueError(msg)
            if self.spacing == "log" and low <= 0.0:
                msg = f"range = [{low:g}, {high:g}] has no logarithm; begin above zero"
                raise ValueError(msg)
            if self.prior.misses(low, high):
                msg = f"prior lies outside range = [{low:g}, {high:g}]; correct one of them"
                raise ValueError(msg)
        if not self.range and not self.value:
            msg = "neither range nor value; give range = [low, high] to free it, or value = number"
            raise ValueError(msg)
        if not self.range and (self.tie or not self.prior.uniform or self.spacing == "log"):
            msg = "tie, prior and spacing are for a free parameter; add range = [low, high]"
            raise ValueError(msg)
        return self
