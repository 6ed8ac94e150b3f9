"""What is read: the paper's tables, stored runs, stored results; and where everything lies."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path
from typing import Final

import pandas as pd
from matplotlib.figure import Figure
from PIL import Image

from calibrate.questions.core.from_study import forms_of
from calibrate.questions.core.runs import Runs
from calibrate.questions.core.stored import tabled_runs
from calibrate.runs.table import TableRow, read_rows
from calibrate.study.data import StudyData, load_data

ROOT: Final = Path(__file__).resolve().parents[2]
CASES: Final = ROOT / "cases" / "proppants"
RUNS: Final = CASES / "runs" / "quick.csv.gz"
SENSITIVITY: Final = CASES / "runs" / "sensitivity.csv.gz"
RESULTS: Final = Path(__file__).parent / "results"
PAGE: Final = ROOT / "docs" / "paper.md"
IMAGES: Final = ROOT / "docs" / "images"
MATERIALS: Final = {
    "Carbo HSP13": "HSP13", "SG10H": "SG10H", "Carbo HSP16/30": "HSP16-30",
    "Carbo HSP20/40": "HSP20-40", "Carbo HSP30/60": "HSP30-60",
}  # fmt: skip
"""Names in the paper's tables, and in the studies."""
COLOURS: Final = 256
CONTACT: Final = ("mu_pp", "mu_roll_pp", "mu_pw", "mu_roll_pw", "e_pp", "e_pw")


def table(name: str) -> pd.DataFrame:
    """Return one of the paper's tables."""
    return pd.read_csv(CASES / f"{name}.csv", comment="#")


def study(name: str) -> StudyData:
    """Return a study of the folder with its data."""
    return load_data(CASES / f"{name}.toml")


def runs_for(data: StudyData) -> Runs:
    """Return the stored runs from which a study learns."""
    return tabled_runs(data, forms_of(data), RUNS)


def rows(path: Path = RUNS) -> list[TableRow]:
    """Return stored runs; none where there is no table yet."""
    return read_rows(path) if path.exists() else []


def result(name: str) -> pd.DataFrame:
    """Return a stored result; empty where there is none yet."""
    path = RESULTS / f"{name}.csv"
    return pd.read_csv(path, keep_default_na=True) if path.exists() else pd.DataFrame()


def keep(found: pd.DataFrame, name: str) -> None:
    """Store a result with four digits, which is more than any of it means."""
    RESULTS.mkdir(exist_ok=True)
    found.to_csv(RESULTS / f"{name}.csv", index=False, float_format="%.4g")


def contours_of(material: str) -> Path:
    """Return the file of a particle's contours."""
    return IMAGES / f"paper_contours_{material.lower().replace('-', '_')}.png"


def save(figure: Figure, path: Path, dpi: int) -> None:
    """Save a figure with few colours, a third of the size."""
    held = BytesIO()
    figure.savefig(held, dpi=dpi)
    Image.open(held).convert("RGB").quantize(COLOURS, Image.Quantize.FASTOCTREE).save(
        path, optimize=True
    )
