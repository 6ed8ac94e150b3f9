"""Write docs/paper.md's tables from stored runs and results.

    python -m benchmarks.paper                 # tables of the page, from benchmarks/paper/results
    python -m benchmarks.paper --fit           # first fit anew to cases/proppants/runs
    python -m benchmarks.paper --fit --figures # and draw the figures

Nothing is run by an engine. The runs come from

    python -m benchmarks.paper.campaign --out proppants
"""

from __future__ import annotations

import argparse

from benchmarks.paper import contours, fits, held_out, sensitivity, sources
from benchmarks.paper.page import write
from calibrate.errors import CalibrationError
from calibrate.questions.joint.result import JointResult


def fit(*, figures: bool) -> None:
    """Fit the studies and the held-out test to the stored runs, and store what is found.

    A study of which too few runs are stored is left out, and said.
    """
    found: dict[str, JointResult] = {}
    for name in fits.STUDIES:
        try:
            found[name] = fits.fitted(name)
        except CalibrationError as err:
            print(f"{name}: {err}")
            continue
        sources.keep(fits.parameters(found[name]), f"parameters_{name}")
        sources.keep(fits.targets(found[name]), f"targets_{name}")
        sources.keep(fits.quality(found[name]), f"quality_{name}")
    rig = held_out.apparatus(found["hsp13"])
    widest = found.get("proppants", found["hsp13"])
    sources.keep(held_out.rig_table(rig), "held_out_apparatus")
    sources.keep(held_out.predicted(widest, rig), "held_out")
    for name in ("quick", "sensitivity"):
        sources.keep(fits.campaign(name), f"campaign_{name}")
    if figures:
        contours.draw(found["hsp13"], [held_out.LEARNT])
        if "proppants" in found:
            others = [m for m in sources.MATERIALS.values() if m != held_out.LEARNT]
            contours.draw(found["proppants"], others)
        sensitivity.draw(found["hsp13"])
        sensitivity.draw_engine()


def main() -> None:
    """Fit, draw and write as asked."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--fit", action="store_true", help="fit to the stored runs first")
    parser.add_argument("--figures", action="store_true", help="draw the figures, after --fit")
    chosen = parser.parse_args()
    if chosen.fit:
        fit(figures=chosen.figures)
    write()


if __name__ == "__main__":
    main()
