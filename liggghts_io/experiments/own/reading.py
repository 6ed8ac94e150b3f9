"""Read a definition: every mistake with its file, line, value and remedy, all at once."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, Final, TypeVar

from pydantic import BaseModel, ValidationError

from liggghts_io.errors import CaseError, nearest, told
from liggghts_io.experiments.own.definition import (
    LISTS,
    CurveTable,
    Head,
    MeshTable,
    ObservableTable,
    ParameterTable,
    field_names,
    plain_value,
)
from liggghts_io.experiments.own.effect_table import EffectTable
from liggghts_io.measure.extract import CURVE_EXTRACTORS, EXTRACTORS, CurveExtractor, Extractor
from liggghts_io.toml_lines import Key, Lines

_MOST_TABLES: Final = 200
_Model = TypeVar("_Model", bound=BaseModel)


@dataclass
class Mistakes:
    """Mistakes in a definition, to be told together.

    Attributes
    ----------
    place : str
        Name of the file.
    lines : Lines
    found : list of (int, str)
        Line and message.
    """

    place: str
    lines: Lines
    found: list[tuple[int, str]] = field(default_factory=list)

    def add(self, key: Key, message: str) -> None:
        """Note a mistake at a key."""
        line = self.lines.of(key)
        place = f"{self.place}:{line}" if line else self.place
        entry = (line or 0, f"{place}: {message}")
        if entry not in self.found:
            self.found.append(entry)

    def tell(self) -> None:
        """Raise all mistakes as one error, if there are any.

        Raises
        ------
        CaseError
        """
        if self.found:
            raise CaseError("\n".join(message for _, message in sorted(self.found)))


@dataclass(frozen=True)
class Definition:
    """A definition whose parts are valid one by one.

    Attributes
    ----------
    head : Head
    parameters : Mapping[str, ParameterTable]
    meshes : tuple of MeshTable
    observables : tuple of (ObservableTable, Extractor)
    curves : tuple of (CurveTable, CurveExtractor)
    effects : tuple of EffectTable
    """

    head: Head
    parameters: Mapping[str, ParameterTable]
    meshes: tuple[MeshTable, ...]
    observables: tuple[tuple[ObservableTable, Extractor], ...]
    curves: tuple[tuple[CurveTable, CurveExtractor], ...]
    effects: tuple[EffectTable, ...]


def read_definition(text: str, place: str) -> tuple[Definition, Mistakes]:
    """Read a definition.

    Returns
    -------
    (Definition, Mistakes)
        The mistakes are empty; whoever finds what does not belong together adds to them.

    Raises
    ------
    CaseError
        With every mistake, each with file and line.
    """
    try:
        raw = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError) as err:
        msg = f"{place}: not a TOML file: {err}"
        raise CaseError(msg) from err
    reader = _Reader(Mistakes(place, Lines(text)))
    rest = {key: value for key, value in raw.items() if key not in (*LISTS, "parameters")}
    head = reader.checked(Head, rest, (), [*field_names(Head), *LISTS, "parameters"])
    parameters = reader.table(raw.get("parameters", {}), ("parameters",))
    found = Definition(
        head or Head(name="unknown", title="unknown"),
        {
            name: one
            for name, value in parameters.items()
            if (one := reader.checked(ParameterTable, value, ("parameters", name))) is not None
        },
        tuple(reader.all_of(MeshTable, raw, "mesh")),
        tuple(reader.extracted(ObservableTable, EXTRACTORS, raw, "observable")),
        tuple(reader.extracted(CurveTable, CURVE_EXTRACTORS, raw, "curve")),
        tuple(reader.all_of(EffectTable, raw, "effect")),
    )
    if not raw.get("observable") and not raw.get("curve"):
        reader.mistakes.add((), "it gives nothing; add an [[observable]] or a [[curve]]")
    reader.mistakes.tell()
    return found, reader.mistakes


@dataclass
class _Reader:
    """Checks parts of a definition and notes their mistakes."""

    mistakes: Mistakes

    def checked(
        self, model: type[_Model], value: Any, key: Key, known: list[str] | None = None
    ) -> _Model | None:
        """Return a part, None where it has mistakes."""
        try:
            return model.model_validate(value)
        except ValidationError as err:
            for one in err.errors(include_url=False):
                self._note(one, value, key, known or field_names(model))
            return None

    def _note(self, one: Any, value: Any, key: Key, known: list[str]) -> None:
        way: list[str | int] = []
        inner = value
        for step in one["loc"]:  # pydantic adds names of types, which stand nowhere in the file
            try:
                inner = inner[step]
            except (KeyError, IndexError, TypeError):
                if one["type"] == "missing":
                    way.append(step)
                continue
            way.append(step)
        # A value in a list is told with the key of the list.
        word = next((step for step in reversed(way) if isinstance(step, str)), "")
        message = told(one)
        if one["type"] == "extra_forbidden":
            hint = nearest(word, known) if len(way) == 1 else ""
            self.mistakes.add((*key, *way), f"unknown key {word!r}{hint}")
        elif one["type"] == "missing":
            self.mistakes.add(key, f"{word} is missing; add {word} = ...")
        elif way:
            self.mistakes.add((*key, *way), f"{word} = {plain_value(inner)}: {message}")
        else:
            self.mistakes.add(key, message)

    def table(self, value: Any, key: Key) -> dict[str, Any]:
        if not isinstance(value, dict):
            self.mistakes.add(key, f"{key[-1]} = {plain_value(value)}: write [{key[-1]}.NAME]")
            return {}
        if len(value) > _MOST_TABLES:
            self.mistakes.add(key, f"{len(value)} of them; at most {_MOST_TABLES} are taken")
            return {}
        return value

    def tables(self, raw: Mapping[str, Any], word: str) -> list[Any]:
        value = raw.get(word, [])
        if not isinstance(value, list) or len(value) > _MOST_TABLES:
            what = f"at most {_MOST_TABLES} of [[{word}]]"
            self.mistakes.add((word,), f"{word} = {plain_value(value)}: write {what}")
            return []
        return value

    def all_of(self, model: type[_Model], raw: Mapping[str, Any], word: str) -> Iterable[_Model]:
        """Yield the valid tables of a list."""
        for k, value in enumerate(self.tables(raw, word)):
            one = self.checked(model, value, (word, k))
            if one is not None:
                yield one

    def extracted(
        self,
        model: type[_Model],
        extractors: Mapping[str, type[Any]],
        raw: Mapping[str, Any],
        word: str,
    ) -> Iterable[tuple[_Model, Any]]:
        """Yield the valid tables of a list, each with its extractor."""
        for k, value in enumerate(self.tables(raw, word)):
            if not isinstance(value, dict):
                self.mistakes.add((word, k), f"{plain_value(value)}: write [[{word}]]")
                continue
            own = field_names(model)
            kind = extractors.get(str(value.get("extract", "")))
            if kind is None:
                said = plain_value(value["extract"]) if "extract" in value else "missing"
                hint = nearest(str(value.get("extract", "")), list(extractors))
                message = f"extract = {said}: unknown extractor{hint}"
                self.mistakes.add((word, k, "extract"), message)
                continue
            known = [*own, *field_names(kind)]
            table = {name: one for name, one in value.items() if name in own}
            options = {name: one for name, one in value.items() if name not in own}
            first = self.checked(model, table, (word, k), known)
            second = self.checked(kind, options, (word, k), known)
            if first is not None and second is not None:
                yield first, second
