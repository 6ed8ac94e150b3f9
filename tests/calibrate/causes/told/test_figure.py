"""The picture of a diagnosis: few answers, in words, the most probable first."""

from __future__ import annotations

from calibrate.causes.told.figure import diagnosis_figure


def _cause(number: int, inclusion: float) -> dict:
    return {
        "name": f"cause_{number}", "title": f"Cause number {number}", "unit": "deg",
        "inclusion": inclusion, "strength": 1.5, "low_95": -2.0, "high_95": 2.5, "limit": 3.0,
        "detectable": 1.0, "visible": number % 2 == 0,
    }  # fmt: skip


def _record(count: int, readings: int) -> dict:
    causes = [_cause(k, 0.8 / 2**k) for k in range(count)][::-1]
    rows = [{"name": f"m{k}", "z_left_out": float(k) - 3.0} for k in range(readings)]
    shares = {one["name"]: one["inclusion"] for one in causes}
    return {
        "verdict": "set", "headline": "The cause is one of two.", "names": ["cause_0"],
        "leading": ["cause_0"], "candidates": causes, "residuals": rows, "residuals_after": [],
        "probabilities": {**shares, "unknown": 0.15, "none": 0.01},
        "where": {"unknown in heap": 0.9, "unknown everywhere": 0.1},
    }  # fmt: skip


def _labels(axes) -> list[str]:
    return [one.get_text().replace("\n", " ") for one in axes.get_yticklabels()]


def test_it_shows_the_probable_answers_in_words_and_counts_the_others():
    _, share, strength = diagnosis_figure(_record(20, 8)).axes
    assert _labels(share) == [
        "Cause number 0", "Cause number 1", "Cause number 2", "something in no library (in heap)",
        "Cause number 3", "Cause number 4", "Cause number 5", "Cause number 6",
        "nothing is missing",
    ]  # fmt: skip
    assert "13 more causes are less probable" in share.get_xlabel()
    assert share.get_ylim() == strength.get_ylim()


def test_of_many_readings_it_shows_those_furthest_off_in_their_order():
    residuals = diagnosis_figure(_record(2, 40)).axes[0]
    names = _labels(residuals)
    assert names == [f"m{k}" for k in range(16, 40)]
    assert "16 nearer ones left out" in residuals.get_xlabel()


def test_a_bar_that_is_cut_says_its_number():
    """Readings 12.4 and 40 standard errors off would look alike."""
    record = _record(2, 3)
    for row, z in zip(record["residuals"], (-40.0, 11.9, 12.4), strict=True):
        row["z_left_out"] = z
    residuals = diagnosis_figure(record).axes[0]
    assert [one.get_text() for one in residuals.texts] == ["-40", "12"]
