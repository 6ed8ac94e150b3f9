"""A stage of a staged calibration."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field, model_validator

from calibrate.study.schema.words import Bounds, Label, Name, Table, Words, also_named

__all__ = ["Stage"]


class Stage(Table):
    """Parameters that are freed together and the targets that decide them.

    Attributes
    ----------
    name, title : str
        Short name, and words for a reader.
    material : str
        Whose parameters are freed.
    free : list of str
        Names of the parameters.
    range : dict of str to (float, float)
        Ranges for this stage only.
    targets : list of str
        Names of the targets.
    points : int
        Size of the Latin hypercube.
    repeats : int
        How many of its points are run with a second seed; they measure the noise.
    infill : int
        How many points are added near the optimum.
    """

    name: Name
    title: Words
    material: Label
    free: Annotated[list[str], Field(min_length=1)]
    range: dict[str, Bounds] = Field(default_factory=dict)
    targets: Annotated[list[str], Field(min_length=1)]
    points: Annotated[int, Field(ge=8, le=2000)]
    repeats: Annotated[int, Field(ge=0, le=2000)] = 4
    infill: Annotated[int, Field(ge=0, le=200)] = 0

    @model_validator(mode="before")
    @classmethod
    def _titled(cls, data: Any) -> Any:
        return also_named(data, "title", "name")

    @model_validator(mode="after")
    def _check(self) -> Stage:
        for key, (low, high) in self.range.items():
            if not low < high:
                msg = f"range.{key} = [{low}, {high}] is no range; give [low, high] with low < high"
                raise ValueError(msg)
        if self.repeats > self.points:
            msg = f"repeats = {self.repeats} exceeds points = {self.points}"
            raise ValueError(msg)
        for what, words in (("free", self.free), ("targets", self.targets)):
            for word in words:
                if words.count(word) > 1:
                    msg = f"{what}: '{word}' appears twice in stage '{self.name}'; take one out"
                    raise ValueError(msg)
        return self
