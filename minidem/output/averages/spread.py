"""``fix ave/spatial ... std N1 N2 FILE``: how values scatter over the bins of much filling."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from minidem.files import append_text
from minidem.record import record
from minidem.script.paths import inside
from minidem.words import Words
from minidem.world.state import Floats
from minidem.world.world import World

__all__ = ["Spread"]


@record
class Spread:
    """Mean and standard deviation over bins that hold a number of particles within limits.

    Attributes
    ----------
    least, most : int
        The limits; with ``ave running`` and ``window`` of the sum of all averages that count.
    path : Path
        File that gets a line with each average.
    """

    least: int
    most: int
    path: Path

    @classmethod
    def read(cls, world: World, words: Words) -> Spread:
        """Read both limits and the file."""
        words.need(3, "std N1 N2 FILE")
        least, most = words.integer(), words.integer()
        return cls(least, most, inside(world.root, words.take("a file")))

    def begin(self, first: str, names: Sequence[str]) -> None:
        """Begin the file with its titles."""
        titles = [
            first,
            "# Mean and standard deviation for all bins including between "
            f"N1={self.least} and N2={self.most} particles",
            "# Timestep  Natoms  Nbins  MaxAtomsPerBin  NbinsEmpty  Nbins<N1  Nbins>N2  Nsamples  "
            "NatomsPerSample  "
            + "".join(f"{{{name}: trueMean samplesMean Std}}   " for name in names),
        ]
        append_text(self.path, "\n".join([*titles, ""]), anew=True)

    def write(self, step: int, count: Floats, values: Floats, joined: int) -> None:
        """Write a line.

        Parameters
        ----------
        step : int
            Time step.
        count, values : (bins,), (bins, values)
            Particles and values, summed over the averages that count.
        joined : int
            Number of these.
        """
        total = float(count.sum())
        # Not divided by the number of averages, as in LIGGGHTS, unlike the other two.
        mean = (values * count[:, None]).sum(axis=0) / (total or 1.0)
        low, high = (count != 0.0) & (count < self.least), count > self.most
        chosen = (count != 0.0) & ~low & ~high
        number = int(chosen.sum())
        share, among, off = 0.0, np.zeros(len(mean)), np.zeros(len(mean))
        if number:
            share = float(count[chosen].sum()) / number
            among = values[chosen].mean(axis=0) / joined
            off = np.sqrt(((values[chosen] - mean) ** 2).mean(axis=0)) / joined
        head = [
            f"{step} {total:g} {len(count)} {float(count.max(initial=0.0)):g}",
            f"{int((count == 0.0).sum())} {int(low.sum())} {int(high.sum())} {number} {share:g}",
        ]
        shown = [f"{value:g}" for three in zip(mean, among, off, strict=True) for value in three]
        append_text(self.path, " ".join([*head, *shown]) + "\n")
