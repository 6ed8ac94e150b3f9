"""The comparison with other programs, on a formula in place of the engine and without them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from benchmarks.peers.apparatus import KEPT_BACK, PLACES, RANGES, TARGETS, UNSEEN
from benchmarks.peers.campaign import ANSWERS, Task, run_campaign
from benchmarks.peers.lines import append_line, read_lines
from benchmarks.peers.methods.acces import place_errors
from benchmarks.peers.methods.decalioc import STAGES, Decalioc
from benchmarks.peers.methods.joint import Joint
from benchmarks.peers.methods.middle import Middle
from benchmarks.peers.methods.staged import Staged
from benchmarks.peers.problem import Answer, Method, Problem, answer
from benchmarks.peers.report import STORED, print_report
from benchmarks.peers.scores import common_truths, paired, score_table, summary
from benchmarks.peers.simulator import Engine, particle_steps
from benchmarks.peers.truths import SEEDS, parameters_of, plant
from calibrate.study.resources import bundled_particles
from liggghts_io import CaseSpec, particle_named
from tests.benchmarks.formula import NOISE, Formula

LOW, HIGH = np.array(list(RANGES.values())).T


class Knowing:
    """A method that knows the truth, and spends one parameter vector per budget."""

    name = "knowing"
    sequential = True

    def __init__(self, truths: Sequence[np.ndarray]) -> None:
        self._truths = iter(truths)

    def solve(
        self, problem: Problem, budgets: Sequence[int], rng: np.random.Generator
    ) -> Iterator[Answer]:
        """Yield the next truth."""
        theta = next(self._truths)
        for budget in budgets:
            problem.simulate(theta)
            inside = np.column_stack([theta - 1e-6, theta + 1e-6])
            yield answer(problem, budget, theta, inside)


def problem_of(simulator: Formula, number: int = 0) -> tuple[Problem, np.ndarray]:
    """Return a problem and its truth."""
    truth = plant(simulator, number, parameters_of(number, 20))
    seeds = np.random.default_rng(number)
    return Problem(truth.measured, truth.error, simulator, seeds), truth.theta


def test_truths_lie_inside_the_ranges_one_in_each_twentieth() -> None:
    unit = (np.array([parameters_of(k, 20) for k in range(20)]) - LOW) / (HIGH - LOW)
    assert np.all((unit > 0.05) & (unit < 0.95))
    cells = np.floor((unit - 0.05) / 0.9 * 20).astype(int)
    assert all(sorted(column) == list(range(20)) for column in cells.T)


def test_planted_errors_are_those_of_the_tables_or_of_the_mean() -> None:
    truth = plant(Formula(), 0, parameters_of(0, 20))
    for name, target in TARGETS.items():
        own = NOISE * abs(truth.measured[name]) / np.sqrt(SEEDS)
        # The standard error of 40 runs is itself uncertain by a ninth; three of these.
        assert truth.error[name] == pytest.approx(max(own, target.error), rel=0.35)
    assert plant(Formula(), 0, parameters_of(0, 20)).measured == truth.measured


def test_a_truth_scores_no_error_and_the_middle_that_of_a_uniform_draw(tmp_path: Path) -> None:
    numbers = range(20)
    knowing = Knowing([parameters_of(k, 20) for k in numbers])
    tasks = [Task(Middle(), (1,)), Task(knowing, (1, 2))]
    run_campaign(tmp_path, Formula(), tasks, numbers, tell=lambda _: None)
    rows = summary(score_table(read_lines(tmp_path / ANSWERS))).set_index(["method", "budget"])
    best, middle = rows.loc[("knowing", 2)], rows.loc[("middle", 1)]
    assert best["error"] == 0.0
    assert best["covered"] == 1.0
    # The truth's own numbers have one standard error; 60 squares tell their mean to 0.18.
    assert best["prediction"] < 1.5
    # A Latin hypercube over nine tenths of the range: 0.9 / sqrt(12).
    assert middle["error"] == pytest.approx(0.9 / np.sqrt(12.0), rel=0.05)
    assert middle["prediction"] > 5.0 * best["prediction"]
    assert best["particle_steps"] == 2 * len(PLACES) * 1e6
    assert rows.loc[("knowing", 1), "particle_steps"] == len(PLACES) * 1e6


def test_the_recipe_of_decalioc_finds_a_planted_truth_and_costs_what_it_says() -> None:
    simulator = Formula()
    problem, truth = problem_of(simulator)
    first, second = Decalioc().solve(problem, (8, 16), np.random.default_rng(0))
    assert first.runs == 8 * len(PLACES)
    assert second.runs == 16 * len(PLACES)
    assert second.particle_steps == second.runs * 1e6
    assert second.interval is None
    # The formula scatters by one per cent, where the ranges move it by some twenty.
    assert np.all(np.abs(second.theta - truth) < 0.15 * (HIGH - LOW))


def test_stages_use_each_target_once_and_each_parameter_once() -> None:
    assert sorted(n for s in STAGES for n in s.targets) == sorted(TARGETS)
    assert sorted(n for s in STAGES for n in s.free) == sorted(RANGES)


def test_a_failed_run_is_counted_and_is_no_number() -> None:
    problem, truth = problem_of(Formula())
    broken = replace(problem, simulator=Formula(failing=1.0))
    assert np.isnan(broken.simulate(truth)).all()
    assert (broken.cost.runs, broken.cost.failed) == (5, 5)
    assert broken.cost.particle_steps == 5e6


def test_decalioc_leaves_failed_runs_out() -> None:
    problem, truth = problem_of(Formula())
    broken = replace(problem, simulator=Formula(failing=0.1))
    (found,) = Decalioc().solve(broken, (30,), np.random.default_rng(0))
    assert found.failed > 0
    assert np.all(np.abs(found.theta - truth) < 0.25 * (HIGH - LOW))


def test_only_the_places_of_the_wanted_targets_run_and_ranges_are_kept() -> None:
    simulator = Formula()
    problem, truth = problem_of(simulator)
    before = simulator.calls
    assert problem.simulate(truth, ("t100_glued", "angle_glued")).shape == (2,)
    assert simulator.calls == before + 2
    with pytest.raises(ValueError, match="outside the ranges"):
        problem.simulate(2.0 * HIGH)


def test_every_place_of_a_target_is_known_and_unseen_ones_are_not_fitted() -> None:
    assert {t.place for t in TARGETS.values()} == set(PLACES)
    assert {t.place for t in UNSEEN.values()} == set(KEPT_BACK)
    fitted = {(t.place, t.observable) for t in TARGETS.values()}
    assert not fitted & {(t.place, t.observable) for t in UNSEEN.values()}


def test_errors_of_places_are_mean_squares_in_standard_errors() -> None:
    problem, _ = problem_of(Formula())
    off = np.array(list(problem.measured.values())) + 2.0 * np.array(list(problem.error.values()))
    assert place_errors(problem, off) == pytest.approx(np.full(len(PLACES), 4.0))


def test_an_interrupted_campaign_goes_on_and_writes_nothing_twice(tmp_path: Path) -> None:
    whole, cut = tmp_path / "whole", tmp_path / "cut"
    for folder in (whole, cut):
        folder.mkdir()
    tasks = [Task(Middle(), (6,)), Task(Decalioc(), (6, 8))]
    run_campaign(whole, Formula(), tasks, [0], tell=lambda _: None)
    text = (whole / ANSWERS).read_text()
    (cut / ANSWERS).write_text(text[: int(0.9 * len(text))])  # a line is cut in the middle
    run_campaign(cut, Formula(), tasks, [0], tell=lambda _: None)
    assert read_lines(cut / ANSWERS) == read_lines(whole / ANSWERS)
    simulator = Formula()
    run_campaign(cut, simulator, tasks, [0], tell=lambda _: None)
    assert simulator.calls == 0


def test_an_answer_does_not_depend_on_which_budgets_come_first(tmp_path: Path) -> None:
    whole, parts = tmp_path / "whole", tmp_path / "parts"
    for folder in (whole, parts):
        folder.mkdir()
    run_campaign(whole, Formula(), [Task(Decalioc(), (6, 8))], [0], tell=lambda _: None)
    for budgets in ((8,), (6, 8)):
        run_campaign(parts, Formula(), [Task(Decalioc(), budgets)], [0], tell=lambda _: None)
    one, other = read_lines(whole / ANSWERS), read_lines(parts / ANSWERS)
    assert sorted(other, key=lambda line: line["budget"]) == one


@pytest.mark.long
@pytest.mark.parametrize("method", [Joint(), Staged()])
def test_our_methods_find_a_planted_truth_within_their_budget(method: Method) -> None:
    problem, truth = problem_of(Formula())
    (found,) = method.solve(problem, (20,), np.random.default_rng(0))
    assert found.runs <= 20 * len(PLACES)
    assert found.particle_steps == found.runs * 1e6
    assert found.interval is not None
    low, high = found.interval.T
    assert np.all((low <= found.theta) & (found.theta <= high))
    # The formula scatters by one per cent, where the ranges move it by some twenty.
    assert np.all(np.abs(found.theta - truth) < 0.2 * (HIGH - LOW))


def test_a_cut_line_is_left_out_and_the_next_is_whole(tmp_path: Path) -> None:
    file = tmp_path / "x.jsonl"
    append_line(file, {"a": 1})
    file.write_text(file.read_text() + '{"a": 2')
    append_line(file, {"a": 3})
    assert read_lines(file) == [{"a": 1}, {"a": 3}]


def test_the_engine_runs_a_place_once_and_keeps_the_line(tmp_path: Path) -> None:
    middle = dict(zip(RANGES, 0.5 * (LOW + HIGH), strict=True))
    place = PLACES["plate_impact/steel"]
    first = Engine(tmp_path).run(place, middle, 7)
    again = Engine(tmp_path)
    written = (tmp_path / "runs.jsonl").read_text()
    assert again.run(place, middle, 7) == first
    assert (tmp_path / "runs.jsonl").read_text() == written
    assert not list((tmp_path / "cases").iterdir())
    # Some four per cent of the poured 68.73 g are in the air when the short flight ends.
    total = first.observables["beside_g"] + sum(first.observables[f"m{k}_g"] for k in range(1, 5))
    assert 0.9 * 68.73 < total <= 68.73


def test_particle_steps_are_steps_times_grains() -> None:
    grain = particle_named("Carbo HSP13", bundled_particles())
    middle = dict(zip(RANGES, map(float, 0.5 * (LOW + HIGH)), strict=True))
    place = PLACES["heap/steel"]
    spec = CaseSpec("heap", grain, "steel", "quick", middle, apparatus=place.apparatus)
    longer = replace(spec, apparatus={**place.apparatus, "pour_grains": 440.0})
    assert particle_steps(longer) == pytest.approx(2.0 * particle_steps(spec))
    finer = replace(spec, apparatus={**place.apparatus, "timestep_fraction": 0.15})
    # The time step is rounded to two digits.
    assert particle_steps(finer) == pytest.approx(2.0 * particle_steps(spec), rel=0.05)


def test_methods_are_compared_over_truths_that_all_have_done() -> None:
    rows = pd.DataFrame(
        {"method": ["a", "a", "b", "a"], "truth": [0, 1, 1, 2], "budget": [20, 20, 20, 40]}
    )
    assert common_truths(rows)["truth"].tolist() == [1, 1, 2]
    assert common_truths(rows, ["a"])["truth"].tolist() == [0, 1, 2]
    begun = pd.DataFrame({"method": list("aaab"), "truth": [0, 1, 2, 1], "budget": 4 * [20]})
    assert set(common_truths(begun)["method"]) == {"a"}


def test_two_methods_at_different_budgets_are_compared_over_the_same_truths(
    tmp_path: Path,
) -> None:
    knowing = Knowing([parameters_of(k, 20) for k in range(3)])
    run_campaign(tmp_path, Formula(), [Task(Middle(), (1,))], range(1, 3), lambda _: None)
    run_campaign(tmp_path, Formula(), [Task(knowing, (2,))], range(2), lambda _: None)
    scores = score_table(read_lines(tmp_path / ANSWERS))
    rows = paired(scores, [("knowing", 2), ("middle", 1)]).set_index("method")
    assert rows["truths"].tolist() == [1, 1]
    only = scores[(scores["method"] == "middle") & (scores["truth"] == 1)]
    assert rows.loc["middle", "error"] == pytest.approx(only["error"].item())
    assert paired(scores, [("knowing", 2), ("middle", 5)]).empty


def test_the_report_prints_a_row_per_method_and_budget_and_draws(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    truths = [parameters_of(k, 20) for k in range(2)]
    tasks = [Task(Middle(), (1,)), Task(Knowing(truths), (1, 2))]
    run_campaign(tmp_path, Formula(), tasks, range(2), print)
    figure = tmp_path / "peers.png"
    print_report(score_table(read_lines(tmp_path / ANSWERS)), (), figure)
    shown = capsys.readouterr().out
    assert shown.count("| knowing |") == 3  # two budgets, and the errors of each parameter
    assert figure.stat().st_size > 10_000


def test_the_stored_scores_hold_together() -> None:
    if not STORED.exists():
        pytest.skip("the comparison has not been stored yet")
    scores = pd.read_csv(STORED)
    errors = scores[[f"error_{name}" for name in RANGES]].to_numpy()
    assert scores["error"].to_numpy() == pytest.approx(
        np.sqrt(np.mean(errors**2, axis=1)), rel=1e-4
    )
    assert not scores.duplicated(["truth", "method", "budget"]).any()
