"""Figures of a suite on cases whose scores are counted by hand."""

from __future__ import annotations

import math
from statistics import NormalDist

import pytest

from calibrate.challenge.cases import Case
from calibrate.challenge.opening import power
from calibrate.challenge.scores import (
    FIGURES,
    cause_table,
    reliability_table,
    score_table,
    upper_bound,
)


def case(
    kind, hidden=(), verdict="none", names=(), sizes=(), gained=None, away=0.0, beyond=0.0,
    unlike=math.nan, tested=math.nan, **more,
):  # fmt: skip
    """Return a case; `hidden` are names, `sizes` their non-centralities."""
    sizes = sizes or [6.0] * len(hidden)
    truth = {
        "kind": kind,
        "hidden": [
            {"name": name, "strength": 1.0, "noncentrality": size}
            for name, size in zip(hidden, sizes, strict=True)
        ],
    }
    said = {"verdict": verdict, "names": list(names), "none": 0.0, "unknown": 0.0,
            "inclusion": {}, "pairs": [], "strengths": {}, "gain": None} | more  # fmt: skip
    return Case(truth, said, away, beyond, gained, unlike, tested)


def value(start: str, *cases: Case) -> float:
    """Return the figure whose name starts so."""
    (figure,) = (one for one in FIGURES if one.name.startswith(start))
    return figure.compute(cases)[0]


def test_the_bound_of_a_rate_is_that_of_clopper_and_pearson():
    # 0 of n: 1 - 0.05^(1/n).
    assert upper_bound(0, 150) == pytest.approx(1.0 - 0.05 ** (1 / 150))
    assert upper_bound(3, 3) == 1.0
    assert upper_bound(1, 160) == pytest.approx(0.0293, abs=1e-4)


def test_a_name_without_a_library_cause_is_false():
    blameless = [case("nothing")] * 98 + [case("foreign", ["box_width"], "unknown")]
    wrong = case("nothing", verdict="named", names=["plate_period"])
    assert value("false names, nulls", *blameless, wrong) == pytest.approx(upper_bound(1, 100))
    in_a_set = case("nothing", verdict="set", names=["a", "b"])
    assert value("false names and sets", *blameless, in_a_set) == pytest.approx(0.01)


@pytest.mark.parametrize(
    ("names", "right", "alone"),
    [
        (["tilt"], 1.0, 1.0),
        (["tilt", "flow"], 1.0, 0.0),
        (["tilt", "flow", "clock"], 0.0, 0.0),
        (["flow"], 0.0, 0.0),
        ([], 0.0, 0.0),
    ],
)
def test_right_is_alone_or_in_a_set_of_two(names, right, alone):
    one = case("single", ["tilt"], "set", names, sizes=[11.0])
    assert value("right, alone or in a set of two, at 11", one) == right
    assert value("named alone", one) == alone
    assert math.isnan(value("right, alone or in a set of two, at 5.6", one))


def test_a_forecast_that_is_missing_gets_the_floor():
    lost = Case(case("single", ["tilt"]).truth, None)
    assert value("mean probability", lost) == 0.0
    assert value("mean log score", lost) == pytest.approx(math.log(1e-4))
    assert value("right, alone or in a set of two, at 5.6", lost) == 0.0


def test_stated_probabilities_are_compared_with_how_often_they_held():
    sure = [case("nothing", none=0.95)] * 18 + [case("single", ["tilt"], none=0.95)] * 2
    table = reliability_table(sure)
    assert list(table["answers"]) == [20]
    assert table["held"][0] == pytest.approx(0.9)
    assert value("error of stated", *sure) == pytest.approx(0.05)


def test_a_foreign_cause_counts_where_it_could_be_seen():
    seen = [
        case("foreign", ["x"], verdict, away=5.0, tested=power)
        for verdict, power in (("unknown", 0.2), ("none", 0.4))
    ]
    faint = case("foreign", ["x"], "none", away=2.0, tested=0.9)
    assert value("foreign at 4 sigma", *seen, faint) == 0.5
    assert value("the same, by a 5 % test", *seen, faint) == pytest.approx(0.3)
    apart = case("foreign", ["x"], "unknown", away=5.0, beyond=4.5)
    assert value("foreign 4 sigma from every cause", *seen, faint, apart) == 1.0


def test_causes_are_counted_by_how_far_they_are_from_any_parameters():
    right = {"verdict": "named", "names": ["tilt"]}
    cases = [
        case("single", ["tilt"], unlike=1.0),
        case("single", ["tilt"], unlike=3.9, **right),
        case("single", ["tilt"], unlike=4.0, **right),
        case("single", ["tilt"], unlike=8.0, **right),
        case("single", ["tilt"], unlike=15.0, **right),
        case("single", ["tilt"], unlike=9.0),
        case("single", ["tilt"], unlike=16.0),
        case("single", ["tilt"], **right),  # nobody asked
        case("pair", ["tilt", "slip"], unlike=9.0),
    ]
    found = [
        value(f"the same, {name}", *cases)
        for name in ("less than 4", "4 to 8 from", "8 to 16 from", "more than 16")
    ]
    assert found == pytest.approx([1 / 2, 1.0, 2 / 3, 0.0])


def test_pairs_need_both_and_no_third():
    names = (["a", "b"], ["a"], ["a", "b", "c"], ["b", "a"])
    cases = [case("pair", ["a", "b"], "named", n, sizes=[9.0, 12.0]) for n in names]
    assert value("pairs at 11", *cases) == 0.5
    assert value("pairs: at least one", *cases) == 1.0


def test_strengths_and_gains_are_counted_inside_their_intervals():
    inside = case("single", ["a"], strengths={"a": [0.5, 1.0, 1.5]})
    outside = case("single", ["a"], strengths={"a": [1.5, 2.0, 2.5]})
    assert value("strengths in", inside, outside) == 0.5
    claim = {"low": 2.0, "high": 9.0}
    kept, missed = (case("single", ["a"], gained=g, gain=claim) for g in (5.0, 1.0))
    assert value("true gain", kept, missed, inside) == 0.5


def test_the_table_has_a_row_for_every_figure():
    table = score_table({"ours": [case("nothing", none=1.0)], "prior": []})
    assert len(table) == len(FIGURES)
    assert table.loc["mean log score", "ours"] == 0.0
    assert math.isnan(table.loc["mean log score", "prior"])


def test_causes_are_counted_one_by_one_from_what_can_be_seen():
    found = case("single", ["tilt"], "named", ["tilt"], inclusion={"tilt": 0.9})
    in_a_set = case("single", ["tilt"], "set", ["tilt", "flow"], inclusion={"tilt": 0.5})
    weak = case("single", ["tilt"], sizes=[2.8])
    lost = case("single", ["flow"], "set", ["a", "b", "flow"], inclusion={"flow": 0.2})
    table = cause_table([found, in_a_set, weak, lost, case("nothing")])
    assert list(table.index) == ["tilt", "flow"]
    assert list(table.loc["tilt"]) == pytest.approx([2, 0.5, 1.0, 1.0, 0.7])
    assert list(table.loc["flow"]) == pytest.approx([1, 0.0, 0.0, 1.0, 0.2])


@pytest.mark.parametrize("away", [0.0, 1.0, 2.5, 4.0])
def test_power_in_one_direction_is_that_of_a_two_sided_test(away):
    """Of one number a chi-square test is the two-sided one, whose power has a closed form."""
    normal, level = NormalDist(), 0.05
    edge = normal.inv_cdf(1.0 - level / 2.0)
    expected = normal.cdf(away - edge) + normal.cdf(-away - edge)
    assert power(away**2, 1.0) == pytest.approx(expected, rel=1e-9)  # both are of library functions


def test_more_numbers_to_watch_make_a_test_blinder():
    assert power(9.0, 1.0) > power(9.0, 5.0) > power(9.0, 21.0) > 0.05
