"""What `experiment.toml` may say of an effect of its own."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, model_validator

from liggghts_io.measure.extract.base import Number, Word

__all__ = ["EffectTable", "Name", "Table", "Text"]

Name = Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_]{0,63}$")]
Text = Annotated[str, Field(max_length=500)]


class Table(BaseModel):
    """A table of the definition; an unknown key is refused."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class EffectTable(Table):
    """An effect of this experiment alone.

    Attributes
    ----------
    name : str
    title, unit, meaning, settled_by : str
    variable : str
        Parameter, or variable of the script, that it changes.
    how : str
        "add": the strength is added; "scale": the variable is multiplied by 1 + strength.
    step : float
        Ordinary strength.
    limits : (float, float), optional
        Allowed strengths; ten steps where they are not given.
    sign : str
        "positive" where strengths below zero make no sense, else "both".
    candidate : bool
        Whether the diagnosis tries it without being asked.
    settled_se : float
        Standard error of what `settled_by` says, in the unit of the strength; 0: nobody knows.
    settled_hours : float
        Hours that it takes.
    """

    name: Name
    title: Word
    unit: Word
    meaning: Text
    settled_by: Text
    variable: Name
    how: Literal["add", "scale"]
    step: Annotated[float, Field(strict=True, gt=0.0, allow_inf_nan=False)]
    limits: tuple[Number, Number] | None = None
    sign: Literal["positive", "both"] = "both"
    candidate: Annotated[bool, Field(strict=True)] = True
    settled_se: Annotated[float, Field(strict=True, ge=0.0, allow_inf_nan=False)] = 0.0
    settled_hours: Annotated[float, Field(strict=True, gt=0.0, allow_inf_nan=False)] = 1.0

    @property
    def bounds(self) -> tuple[float, float]:
        """Allowed strengths."""
        if self.limits is not None:
            return self.limits
        return (0.0 if self.sign == "positive" else -10.0 * self.step, 10.0 * self.step)

    @model_validator(mode="after")
    def _check(self) -> EffectTable:
        low, high = self.bounds
        if not low <= 0.0 <= high or not low < high:
            msg = f"limits = [{low:g}, {high:g}] must hold 0, which is the base model"
            raise ValueError(msg)
        if self.sign == "positive" and low < 0.0:
            msg = f"sign = 'positive', but the limits begin at {low:g}"
            raise ValueError(msg)
        return self
