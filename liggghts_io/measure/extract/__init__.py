"""What a definition can ask of a finished run: one file each, one line each in the registry."""

from __future__ import annotations

from typing import Final

from liggghts_io.measure.extract.base import CurveExtractor, Extractor
from liggghts_io.measure.extract.grains.angle import Angle
from liggghts_io.measure.extract.grains.count import Count
from liggghts_io.measure.extract.grains.grain_mean import GrainMean
from liggghts_io.measure.extract.grains.grain_percentile import GrainPercentile
from liggghts_io.measure.extract.grains.mass import Mass
from liggghts_io.measure.extract.grains.profile import Profile
from liggghts_io.measure.extract.run import Run
from liggghts_io.measure.extract.tables.columns import Columns
from liggghts_io.measure.extract.tables.extreme import Extreme
from liggghts_io.measure.extract.tables.last import Last
from liggghts_io.measure.extract.tables.mean import Mean
from liggghts_io.measure.extract.tables.rate import Rate
from liggghts_io.measure.extract.tables.time_to import TimeTo

EXTRACTORS: Final[dict[str, type[Extractor]]] = {
    "last": Last,
    "mean": Mean,
    "extreme": Extreme,
    "time_to": TimeTo,
    "rate": Rate,
    "count": Count,
    "mass": Mass,
    "grain_mean": GrainMean,
    "grain_percentile": GrainPercentile,
    "angle": Angle,
}
CURVE_EXTRACTORS: Final[dict[str, type[CurveExtractor]]] = {
    "columns": Columns,
    "profile": Profile,
}

__all__ = ["CURVE_EXTRACTORS", "EXTRACTORS", "CurveExtractor", "Extractor", "Run"]
