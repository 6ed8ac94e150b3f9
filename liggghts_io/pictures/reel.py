"""All frames of a run as pictures show them; only one frame is in memory."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final

from liggghts_io.errors import CaseError
from liggghts_io.experiments import Notes
from liggghts_io.measure.dumps import Frame
from liggghts_io.pictures.colouring import Colouring, checked_colour, colouring_of
from liggghts_io.pictures.shot import FloatArray, Shot, Window, seen_in

BEST: Final = "best"
_LONG: Final = 10  # digits of a number that is no frame's


def no_notes(_frame: Frame) -> Notes:
    """Return nothing: a picture without words."""
    return Notes()


@dataclass(frozen=True)
class Reel:
    """The frames of a run, and what is around the grains in all of them.

    Attributes
    ----------
    last : int
        Number of the last frame; the first one is 0.
    frames : callable
        Numbers of frames, or None for all, to these frames in their order.
    best : int
        Number of the frame that shows most.
    title : str
    meshes : Mapping[str, (n, 3, 3) float64]
        Triangles that are drawn [m].
    opacities : Mapping[str, float]
        Of the meshes.
    window : (float, float, float, float), optional
        Left, right, bottom and top seen from the side [m].
    notes : callable
        Frame to what is written on its picture.
    """

    last: int
    frames: Callable[[Collection[int] | None], Iterator[Frame]]
    best: int
    title: str
    meshes: Mapping[str, FloatArray] = field(default_factory=dict)
    opacities: Mapping[str, float] = field(default_factory=dict)
    window: Window | None = None
    notes: Callable[[Frame], Notes] = no_notes

    def shot(self, word: str, colour: str) -> Shot:
        """Return one frame as it is drawn.

        Parameters
        ----------
        word : str
            "best" (or the nearest one with a grain in it), "first", "middle", "last" or a number.
        colour : str
            What colours say.

        Raises
        ------
        CaseError
            If there is no such frame, it holds no grain or not what colours are to say.
        """
        checked_colour(colour)
        number, frame = self._with_a_grain() if word == BEST else self._chosen(word)
        return self._of(number, frame, colouring_of([frame], colour, seen_in(self.window)))

    def film(self, colour: str) -> Iterator[Shot]:
        """Yield all frames in the same colours; they are read twice.

        Raises
        ------
        CaseError
            If no frame holds a grain, or one not what colours are to say.
        """
        checked_colour(colour)
        self._with_a_grain()
        filled = (one for one in self.frames(None) if one.count)
        colouring = colouring_of(filled, colour, seen_in(self.window))
        for number, frame in enumerate(self.frames(None)):
            yield self._of(number, frame, colouring)

    def _of(self, number: int, frame: Frame, colouring: Colouring) -> Shot:
        return Shot(
            frame, colouring, self.meshes, self.opacities, number, self.last, self.window,
            f"{self.title}, frame {number} of {self.last}", self.notes(frame),
        )  # fmt: skip

    def _chosen(self, word: str) -> tuple[int, Frame]:
        number = frame_number(word, self.last)
        frame = next(self.frames([number]))
        if not frame.count:
            msg = f"step {frame.step}: no grain in this frame; draw another (--frame)"
            raise CaseError(msg)
        return number, frame

    def _with_a_grain(self) -> tuple[int, Frame]:
        for number in [*range(self.best, self.last + 1), *reversed(range(self.best))]:
            frame = next(self.frames([number]))
            if frame.count:
                return number, frame
        msg = f"{self.title}: no frame holds a grain"
        raise CaseError(msg)


def frame_number(word: str, last: int) -> int:
    """Return the number of the frame that a word asks for: first, middle, last or a number.

    Raises
    ------
    CaseError
        With what would be right.
    """
    places = {"first": 0, "middle": last // 2, "last": last}
    if word.isdecimal():
        number = int(word) if len(word) < _LONG else last + 1
    elif word in places:
        number = places[word]
    else:
        msg = f"frame '{word}': write best, first, middle, last or a number from 0 to {last}"
        raise CaseError(msg)
    if number > last:
        msg = f"frame {word}: the run wrote frames 0 to {last}"
        raise CaseError(msg)
    return number
