"""``property/atom/tracer/stream``: which particles of a stream are marked; and their flights.

The marks are those of LIGGGHTS 3.8.0.
"""

from __future__ import annotations

import pytest

from minidem import ScriptError, run_script
from tests.minidem.engine.case_list import WEIGHT
from tests.minidem.engine.cases import Case

FACE = (((-0.05, -0.05, 0.15), (0.05, -0.05, 0.15), (0.05, 0.05, 0.15)),
        ((-0.05, -0.05, 0.15), (0.05, 0.05, 0.15), (-0.05, 0.05, 0.15)))  # fmt: skip
BODY = (
    "fix face all mesh/surface/planar file f.stl type 2\n"
    "fix pts all particletemplate/sphere 15485863 atom_type 1 density constant 2500 "
    "radius constant 0.004\nfix pd all particledistribution/discrete 32452843 1 pts 1.0\n"
    "fix ins all insert/stream seed 32452867 distributiontemplate pd nparticles 60 "
    "particlerate 800 overlapcheck yes all_in yes vel constant 0 0 -1 insertion_face face "
    "extrude_length 0.02\ngroup none type 2\n"
)
ONCE = [3, 5, 11, 13, 16]
AGAIN = [*ONCE, 18, 20, 21, 24, 25, 26, 27, 28, 30, 31]


@pytest.mark.parametrize(
    ("group", "step", "number", "every", "marked"),
    [
        ("all", 150, 5, "once", ONCE),
        ("all", 150, 5, "100", AGAIN),
        ("none", 150, 5, "100", []),
        ("all", 399, 1, "2", [26]),  # the next one is not sought behind the next packet's step
    ],
)
def test_the_first_that_pass_behind_a_step_are_marked(tmp_path, group, step, number, every, marked):
    """Some from a step on, once or again, of two packets of 16 at steps 1 and 201."""
    line = (
        f"fix tr {group} property/atom/tracer/stream mark_step {step} insert_stream ins "
        f"n_tracer {number} every {every}\ndump d all custom 399 d.* id f_tr\n"
        "dump_modify d sort id\n"
    )
    case = Case(BODY + line + "timestep 1e-4\n", steps=399, meshes={"f.stl": FACE})
    case.write(tmp_path)
    run_script(tmp_path / "in.script", root=tmp_path)
    rows = [row.split() for row in (tmp_path / "d.399").read_text().splitlines()[9:]]
    assert [int(name) for name, mark in rows if float(mark) == 1.0] == marked


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("insert_stream inn", "unknown fix insert/stream 'inn'; did you mean 'ins'"),
        ("insert_stream pd", r"unknown fix insert/stream 'pd' \(known: ins\)"),
        ("mark_step 1", "expected 'insert_stream'"),
        ("insert_stream ins every 0", "the interval 0 is not positive"),
        ("insert_stream ins n_tracer -1", "the interval -1 is negative"),
    ],
)
def test_mistakes_are_named(tmp_path, words, said):
    line = f"fix tr all property/atom/tracer/stream mark_step 1 n_tracer 1 every once {words}\n"
    Case(BODY + line, steps=1, meshes={"f.stl": FACE}).write(tmp_path)
    with pytest.raises(ScriptError, match=said):
        run_script(tmp_path / "in.script", root=tmp_path)


def test_a_stream_that_is_not_there_yet_is_told(tmp_path):
    line = (
        "fix tr all property/atom/tracer/stream mark_step 1 n_tracer 1 every once insert_stream a\n"
    )
    Case(line + BODY, steps=1, meshes={"f.stl": FACE}).write(tmp_path)
    with pytest.raises(ScriptError, match="insert_stream a: no fix insert/stream stands above it"):
        run_script(tmp_path / "in.script", root=tmp_path)


def test_flights_that_are_forgotten_are_told(tmp_path):
    """Asked after the particles have landed and were put in another order."""
    body = BODY.replace("nparticles 60", "nparticles 5") + "timestep 1e-4\n" + WEIGHT
    late = "run 900\nwrite_dump all custom d.end id f_release_fix_insert_stream[5]\n"
    Case(body, meshes={"f.stl": FACE}, runs=late).write(tmp_path)
    with pytest.raises(ScriptError, match="before the script has asked for it; name it in a dump"):
        run_script(tmp_path / "in.script", root=tmp_path)
    early = "dump e all custom 500 d.* f_release_fix_insert_stream[5]\n"
    Case(body + early, meshes={"f.stl": FACE}, runs=late).write(tmp_path)
    run_script(tmp_path / "in.script", root=tmp_path)
    assert all(
        float(row.split()[1]) > 0 for row in (tmp_path / "d.end").read_text().splitlines()[9:]
    )


def test_a_new_stream_knows_nothing_of_the_last_one(tmp_path):
    """As in LIGGGHTS: with the last stream go all flights."""
    body = BODY.replace("nparticles 60", "nparticles 5") + "timestep 1e-4\n"
    again = next(line for line in BODY.splitlines() if line.startswith("fix ins"))
    runs = (
        f"run 250\nunfix ins\n{again.replace('fix ins', 'fix more')}\nrun 250\n"
        "write_dump all custom d.end id f_release_fix_insert_stream[5]\n"
    )
    Case(body, meshes={"f.stl": FACE}, runs=runs).write(tmp_path)
    run_script(tmp_path / "in.script", root=tmp_path)
    rows = [row.split() for row in (tmp_path / "d.end").read_text().splitlines()[9:]]
    flown = {int(name): float(step) for name, step in rows}
    assert [flown[name] for name in range(1, 6)] == [0.0] * 5
    assert all(flown[name] > 250 for name in flown if name > 5)
    assert len(flown) > 5
