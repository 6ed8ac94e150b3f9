"""Runs on one of the two loops that may run a model, whichever the engine would choose."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from minidem.kernels.step.phases import GENERAL, Model
from minidem.run import loop
from minidem.run.code import Code, code_of


def _own(model: Model, *, several: bool) -> Code:
    found = code_of(model, several=several)
    return Code(model, several, found.own, found.general, patience=0.0)


def _general(model: Model, *, several: bool) -> Code:
    del model
    return _own(GENERAL, several=several)


@contextmanager
def own_loops() -> Iterator[None]:
    """Run with loops that are compiled for their models, as long runs end up with."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(loop, "code_of", _own)
        yield


@contextmanager
def general_loops() -> Iterator[None]:
    """Run with the loop of all models, as runs begin with."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(loop, "code_of", _general)
        yield
