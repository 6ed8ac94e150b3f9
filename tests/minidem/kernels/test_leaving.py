"""Particles that leave the box in the compiled loop go as those that Python lets go."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from minidem import run_script
from minidem.kernels.columns import BOX_LOWER, BOX_PERIODIC, BOX_UPPER, GONE, POSITION, three
from minidem.kernels.lists.leaving import leave, wrap
from minidem.run import boundaries, rebuild, runner
from minidem.run.loop import empty_control
from minidem.world.state import NewRows, State
from tests.minidem.engine.test_lost import flowing, scattering, written

PERIODIC = "boundary p f f"


def scattered(rng: np.random.Generator, n: int = 40) -> State:
    """Return particles in and around a box of edges 0 and 1, in any order of output."""
    state = State()
    zero = np.zeros((n, 3))
    state.add(
        NewRows(
            rng.uniform(-0.2, 1.2, (n, 3)), np.full(n, 0.01), np.full(n, 2500.0),
            np.full(n, 0.01), np.ones(n, np.int64), zero, zero,
        )
    )  # fmt: skip
    state.rank[:n] = rng.permutation(n)
    state.more.box[three(BOX_UPPER)] = 1.0
    return state


@pytest.mark.parametrize("seed", range(8))
def test_those_left_close_ranks_as_in_python(seed):
    one, other = (scattered(np.random.default_rng(seed)) for _ in range(2))
    n, control = one.n, empty_control()
    assert wrap(n, one.row, one.more.image, one.more.box)
    assert leave(n, one.row, one.more, control)
    out = (other.row[:n, POSITION] < 0.0) | (other.row[:n, POSITION] >= 1.0)
    other.drop_in_passes(list(out.T))
    assert (one.more.alive[:n] == 0).tolist() == out.any(axis=1).tolist()
    assert one.rank[:n].tolist() == other.rank[:n].tolist()
    assert (one.rank[:n] == GONE).sum() == out.any(axis=1).sum() > 10


def test_nothing_is_changed_where_the_ranks_are_not_those_of_a_full_list():
    state = scattered(np.random.default_rng(1))
    state.rank[3] = GONE
    before = state.rank.copy()
    assert not leave(state.n, state.row, state.more, empty_control())
    assert state.rank.tolist() == before.tolist()
    assert state.more.alive.all()


def test_periodic_faces_let_nobody_go_and_what_is_no_number_stays():
    state = scattered(np.random.default_rng(2))
    state.more.box[three(BOX_PERIODIC)] = 1.0
    assert not wrap(state.n, state.row, state.more.image, state.more.box)
    inside = state.row[: state.n, POSITION]
    assert (inside >= state.more.box[BOX_LOWER]).all()
    assert (inside < 1.0).all()
    state.more.box[three(BOX_PERIODIC)] = 0.0
    state.row[5, 0] = np.nan
    state.row[: state.n, POSITION] = np.minimum(state.row[: state.n, POSITION], 0.99)
    assert not wrap(state.n, state.row, state.more.image, state.more.box)


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize(
    "script", [scattering(), flowing(), flowing().replace("boundary f f f", PERIODIC)]
)
def test_the_loop_does_what_python_does(tmp_path, monkeypatch, script, threads):
    summaries, asked = [], []
    make_lists = runner.make_lists

    def counted(*args):
        asked[-1] += 1
        make_lists(*args)

    monkeypatch.setattr(runner, "make_lists", counted)
    for name in ("loop", "python"):
        asked.append(0)
        folder = tmp_path / name
        if name == "python":
            monkeypatch.setattr(rebuild, "place_box", _never_alone)
        summaries.append(run_script(written(folder, script), root=folder, threads=threads))
    assert asked[0] < asked[1]
    assert summaries[0].lost == summaries[1].lost > 10
    frames = sorted(path.name for path in (tmp_path / "loop").glob("d_*.dump"))
    assert len(frames) > 3
    for name in frames:
        assert _text(tmp_path, "loop", name) == _text(tmp_path, "python", name), name


def _never_alone(world, real, *, alone=True):
    del alone
    boundaries.place_box(world, real, alone=False)


def _text(base: Path, folder: str, name: str) -> str:
    return (base / folder / name).read_text()
