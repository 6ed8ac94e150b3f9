"""The page of the paper shows what its command makes, and stored runs are what the engine gives."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.paper import fits, near, sources
from benchmarks.paper.held_out import published
from benchmarks.paper.page import filled
from calibrate.inference import determined
from tests.again import comes_out_again, short

ROWS = [*sources.rows(), *sources.rows(near.TABLE)]
MOST_STEPS = 6e7
"""Particle-steps of a run that a test may repeat, about three seconds."""
REPEATED = 2
SAME = 0.7
"""Parts of a 90 % interval by which another processor may shift a median. Other seeds shift it by
up to 0.34: the weights of two regions, of much friction and of little, are known to a tenth."""
CLEAR, NOTHING = 0.6, 0.97
"""Posterior over prior standard deviation below which the data surely determine an unknown, above
which surely not; between, another processor may say otherwise."""


def test_the_page_shows_what_the_command_makes() -> None:
    text = sources.PAGE.read_text(encoding="utf-8")
    assert filled(text) == text


def test_every_target_of_the_studies_is_on_the_page() -> None:
    assert "hsp13" in fits.shown()
    for name in fits.shown():
        data, found = sources.study(name), sources.result(f"targets_{name}")
        assert list(found["name"]) == [target.name for target in data.study.targets]
        for row in found.to_dict("records"):
            assert row["measured"] == pytest.approx(data.scalars[row["name"]].value, rel=1e-3)


def test_published_values_are_those_of_the_paper_with_its_flags() -> None:
    values, flag = published("SG10H", "alumina")
    assert (values["mu_pp"], values["mu_pw"], flag) == (0.530, 0.407, "unreachable")
    assert (values["e_pp"], values["e_pw"]) == (0.459, 0.300)  # of steel, and of HSP13 on alumina
    assert published("HSP13", "alumina")[0]["e_pp"] == 0.776
    assert published("HSP13", "glued")[0]["mu_pp"] == 0.694


@pytest.mark.slow
def test_a_random_few_of_the_stored_runs_come_out_again(tmp_path) -> None:
    cheap = [row for row in ROWS if short(row, MOST_STEPS)]
    for k in np.random.default_rng().choice(len(cheap), REPEATED, replace=False):
        comes_out_again(cheap[k], tmp_path)


@pytest.mark.long
def test_fitting_to_the_stored_runs_gives_what_the_page_shows() -> None:
    shown = sources.result("parameters_hsp13").set_index("name")
    fit = fits.fitted("hsp13")
    found = fits.parameters(fit).set_index("name")
    assert list(found.index) == list(shown.index)
    width = shown["high_90"] - shown["low_90"]
    assert ((found["median"] - shown["median"]).abs() < SAME * width).all()
    ratio = determined(fit.posterior, np.random.default_rng(1)).table["ratio"]
    assert shown["determined"][ratio < CLEAR].all()
    assert not shown["determined"][ratio > NOTHING].any()
