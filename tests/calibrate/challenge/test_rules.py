"""Rules of a suite, its seeds and its seals."""

from __future__ import annotations

import pytest

from calibrate.challenge.rules import Rules, load_rules, rng_of
from calibrate.challenge.sealing import opened, sealed
from calibrate.errors import CalibrationError

TEXT = 'name = "small"\nstudy = "s.toml"\nruns = "r.csv"\nnothing = 4\nsingle = 6\nforeign = 2\n'


def test_kinds_come_as_often_as_asked_and_mixed(tmp_path):
    path = tmp_path / "rules.toml"
    path.write_text(TEXT, encoding="utf-8")
    rules = load_rules(path)
    kinds = rules.kinds()
    assert {kind: kinds.count(kind) for kind in kinds} == {"nothing": 4, "single": 6, "foreign": 2}
    assert len(kinds) == rules.count == 12
    assert set(kinds[:6]) == {"nothing", "single", "foreign"}


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("nothing = 4", "name"),
        (TEXT + "repeats = 0", "repeats"),
        (TEXT + "sinlge = 3", "sinlge"),
        (TEXT + "from_prior = 1.5", "from_prior"),
        ("name =", r"rules\.toml"),
    ],
)
def test_a_mistake_in_the_rules_is_told_with_file_and_key(tmp_path, text, said):
    path = tmp_path / "rules.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(CalibrationError, match=said) as told:
        load_rules(path)
    assert str(path) in str(told.value)


def test_a_missing_file_is_told(tmp_path):
    with pytest.raises(CalibrationError, match="nowhere"):
        load_rules(tmp_path / "nowhere.toml")


def test_draws_follow_from_the_seed_and_differ_between_studies():
    first = rng_of("a commit", 1).random(4)
    assert (rng_of("a commit", 1).random(4) == first).all()
    assert (rng_of("a commit", 2).random(4) != first).all()
    assert (rng_of("another", 1).random(4) != first).all()


def test_a_truth_is_opened_as_it_was_sealed_and_says_nothing_before():
    truth = {"kind": "single", "hidden": [{"name": "plate_period", "strength": 0.05}]}
    kept, digest = sealed(truth)
    assert opened(kept, digest)
    assert not opened({**kept, "kind": "nothing"}, digest)
    # The salt keeps anybody from trying all truths.
    assert sealed(truth)[1] != digest
    assert len(digest) == 64


def test_rules_name_their_defaults():
    assert Rules(name="a", study="b", runs="c").noncentrality == [1.4, 2.8, 5.6, 11.0]
