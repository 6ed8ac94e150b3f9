"""An executor that knows how many runs it takes at once and how to end in a hurry."""

from __future__ import annotations

from abc import abstractmethod
from concurrent.futures import Executor
from types import TracebackType
from typing import Literal

__all__ = ["SizedExecutor"]


class SizedExecutor(Executor):
    """An executor of the standard library with a size and an end.

    As a context manager it waits for runs under way at the end of its block, and stops them when
    an error or Ctrl-C ends the block.
    """

    @property
    @abstractmethod
    def workers(self) -> int:
        """How many runs it takes at once."""

    @abstractmethod
    def close(self, *, at_once: bool) -> None:
        """Stop the workers.

        Parameters
        ----------
        at_once : bool
            Stop runs under way as well, where they are ours to stop; their cases simply count as
            not done.
        """

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """End, as the standard library asks for it."""
        self.close(at_once=cancel_futures and not wait)

    def __exit__(
        self,
        exc_type: type[BaseException] | None,
        exc_val: BaseException | None,
        exc_tb: TracebackType | None,
    ) -> Literal[False]:
        """End, at once when an error or Ctrl-C ends the block."""
        self.close(at_once=exc_type is not None)
        return False
