"""What runs cases."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeAlias

import pandas as pd

from liggghts_io import CaseSpec

__all__ = ["Runner"]

Runner: TypeAlias = Callable[[Sequence[CaseSpec], str], pd.DataFrame]
"""Runs cases under a label and returns one row per case in their order (see `campaign`)."""
