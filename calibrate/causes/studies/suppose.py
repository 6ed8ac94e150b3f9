"""What if something had been measured: the study with a measurement that nobody made yet."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from calibrate.causes.studies.from_study import considered
from calibrate.errors import CalibrationError, unknown_name
from calibrate.study.checks.known import known_at, with_known
from calibrate.study.data import StudyData
from calibrate.study.model import Study

__all__ = ["Supposed", "suppose"]


@dataclass(frozen=True)
class Supposed:
    """A measurement that is supposed to have been made.

    Attributes
    ----------
    name : str
        Candidate's effect, or parameter that the study frees.
    where : str
        Where, as candidates are called (``mass_flow_factor:conveyor_flat``) or the instance of a
        parameter; empty for everywhere.
    value, se : float
        In the unit of what is measured.
    """

    name: str
    where: str
    value: float
    se: float

    @property
    def called(self) -> str:
        """Name, and where."""
        return f"{self.name}:{self.where}" if self.where else self.name

    @property
    def word(self) -> str:
        """Say it as the option does."""
        return f"{self.called}={self.value:g}+-{self.se:g}"


def suppose(
    data: StudyData, supposed: Sequence[Supposed], option: str
) -> tuple[StudyData, list[str]]:
    """Return the study as if measurements stood in it under ``[known]``, and what they replace.

    Parameters
    ----------
    data : StudyData
    supposed : sequence of Supposed
    option : str
        What asked for them, for messages.

    Raises
    ------
    CalibrationError
        For a name that is no candidate and not free, a place where it does not act, a number that
        is not possible.
    """
    study, given = data.study, []
    for one in supposed:
        place = f"{option} {one.word}"
        _check_name(study, one.name, place)
        sites = [study.layout.site(one.name, p) for p in study.places]
        known = sorted({site for site in sites if site})
        if one.where and not known:
            msg = f"{place}: {one.name} is the same everywhere; leave out ':{one.where}'"
            raise CalibrationError(msg)
        if one.where and one.where not in known:
            msg = f"{place}: {unknown_name(one.where, known)}"
            raise CalibrationError(msg)
        given.append((one.name, known_at(study, one.name, one.where, one.value, one.se)))
    words = " ".join(f"{option} {one.word}" for one in supposed)
    more, replaced = with_known(study, given, words)
    return replace(data, study=more), replaced


def _check_name(study: Study, name: str, place: str) -> None:
    """Refuse what a diagnosis of the study has no place for."""
    names = [one.name for one in considered(study)]
    names += [one for one in dict.fromkeys(free for free, _ in study.free) if one not in names]
    if name in names:
        return
    if not study.layout.knows(name):
        msg = f"{place}: {unknown_name(name, names)}"
    elif study.layout.role(name) == "effect":
        msg = (
            f"{place}: {name} is no candidate cause in this study (it is on, acts in none of its "
            f"experiments, or its engine or grains do not have it); candidates: {', '.join(names)}"
        )
    else:
        msg = (
            f"{place}: {name} is not free in this study; free it under [parameter.{name}], or "
            f"name one of: {', '.join(names)}"
        )
    raise CalibrationError(msg)
