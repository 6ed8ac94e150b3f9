"""Which machine code runs a loop: that of its model, or meanwhile that which serves all models.

The loop of a model takes the compiler half a minute. The general loop gives the same trajectories
to the last bit at two thirds of the speed, or better, and is compiled once for all models. So runs
begin with it, and where it has worked for some seconds another process compiles the loop of the
model, which takes over when it is there.
"""

from __future__ import annotations

import math
import os
import pickle
import sys
from collections.abc import Callable
from functools import cache
from typing import TYPE_CHECKING, Any, Final

from minidem.kernels.machine.cache import FREE
from minidem.kernels.scene import Tables
from minidem.kernels.step.phases import GENERAL, Model
from minidem.kernels.step.step import advance_for
from minidem.kernels.step.team import helper_for
from minidem.record import record

if TYPE_CHECKING:
    import subprocess

__all__ = ["PATIENCE", "Code", "LoopCode", "code_of", "compile_asked"]

PATIENCE: Final = 2.0
"""Seconds that the general loop has worked for a model before its own is compiled."""
ASKED: Final = {"first": 0.0, "never": math.inf}
"""The same for words in MINIDEM_COMPILE: before the first step, as for timing, or not at all."""
NICE: Final = 10
Kernel = Callable[[Tables], None]


@record(frozen=True)
class LoopCode:
    """The kernels of one loop.

    Attributes
    ----------
    advance : callable
        The loop.
    help_out : callable or None
        What a helping thread runs; None with one thread.
    """

    advance: Kernel
    help_out: Kernel | None

    def is_ready(self, tables: Tables) -> bool:
        """Whether it can run at once: interpreted, or as machine code that is there."""
        return all(one.is_ready(tables) for one in self.machine_code)

    def provide(self, tables: Tables) -> None:
        """Compile it if it is not there."""
        for one in self.machine_code:
            if not one.is_ready(tables):
                one.make(one.codes(tables))

    @property
    def machine_code(self) -> list[Any]:
        """The kernels that are `minidem.kernels.machine.native.Native`; none if interpreted."""
        return [one for one in (self.advance, self.help_out) if one is not None and FREE]


@record
class Code:
    """The loops that may run a model; the same object serves all runs of a process.

    Attributes
    ----------
    model : Model
    several : bool
        True for several threads.
    own, general : LoopCode
        The loop of the model, and that of all.
    patience : float
        See `PATIENCE`; with 0 the loop of the model is compiled before the first step.
    spent : float
        Seconds that the general loop has worked for this model.
    """

    model: Model
    several: bool
    own: LoopCode
    general: LoopCode
    patience: float = PATIENCE
    spent: float = 0.0
    _settled: LoopCode | None = None
    _provided: LoopCode | None = None
    _maker: subprocess.Popen[bytes] | None = None

    def pick(self, tables: Tables) -> LoopCode:
        """Return the loop to enter now; what it needs is there.

        Parameters
        ----------
        tables : Tables
            Its argument.
        """
        if self._settled is None:
            made = self._maker is not None and self._maker.poll() is not None
            if self.patience == 0.0 or ((made or self.spent == 0.0) and self.own.is_ready(tables)):
                self._settled = self.own
            elif made:
                self._settled = self.general  # what failed once would fail again
        picked = self._settled or self.general
        if picked is not self._provided:
            picked.provide(tables)  # here, or compiling would count as work
            self._provided = picked
        return picked

    def worked(self, seconds: float, tables: Tables) -> None:
        """Count how long the loop that was picked has worked; let the other be compiled in time."""
        if self._settled is not None:
            return
        self.spent += seconds
        if self.spent > self.patience and self._maker is None and sys.executable:
            self._maker = _compiling(self.model, self.several, tables)


@cache
def code_of(model: Model, *, several: bool) -> Code:
    """Return the loops of a model.

    Parameters
    ----------
    model : Model
    several : bool
        True for several threads.
    """
    patience = ASKED.get(os.environ.get("MINIDEM_COMPILE", ""), PATIENCE)
    return Code(model, several, _loop(model, several), _loop(GENERAL, several), patience)


@cache
def _loop(model: Model, several: bool) -> LoopCode:
    return LoopCode(advance_for(model, several=several), helper_for(model) if several else None)


def _compiling(model: Model, several: bool, tables: Tables) -> subprocess.Popen[bytes]:
    """Start a process that compiles the loop of a model; it goes on when this one ends."""
    import subprocess  # few runs need it

    codes = _loop(model, several).machine_code[0].codes(tables)
    word = pickle.dumps((model, several, codes)).hex()
    return subprocess.Popen(
        [sys.executable, "-c", f"from {__name__} import compile_asked; compile_asked()", word],
        stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        start_new_session=True,
    )  # fmt: skip


def compile_asked() -> None:
    """Compile the loop that the last argument of this process describes."""
    if hasattr(os, "nice"):
        os.nice(NICE)
    model, several, codes = pickle.loads(bytes.fromhex(sys.argv[-1]))  # ours: `_compiling` wrote it
    for kernel in _loop(model, several).machine_code:
        kernel.make(codes)
