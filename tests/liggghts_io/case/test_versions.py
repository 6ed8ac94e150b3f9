"""Code changes: what a case id covers, and two versions side by side in one directory."""

import json
import os
import shutil
import subprocess
import sys
from dataclasses import replace

import pytest

from liggghts_io import case_id, execute, other_code, post_case, run_case
from liggghts_io.case import sources
from liggghts_io.errors import CaseError
from liggghts_io.experiments import EXPERIMENTS
from tests.liggghts_io.conftest import PARAMETERS, TIMED
from tests.paths import CASES, ROOT

_CODE = f"""
import json, sys
from pathlib import Path
from liggghts_io import CaseSpec, case_id, execute, other_code, read_particles
grain = read_particles(Path({str(CASES / "particles.csv")!r}))["Carbo HSP13"]
def spec(experiment, **changes):
    return CaseSpec(experiment, grain, "steel", "quick", {PARAMETERS!r}, **changes)
if len(sys.argv) > 1:
    root = Path(sys.argv[1])
    result = execute(spec("conveyor", apparatus={TIMED!r}), root)
    others = [[one.path.name, one.parts] for one in other_code(root)]
    print(json.dumps([result.case_id, dict(result.observables), result.output, others]))
else:
    tilted = spec("conveyor", effects={{"plate_tilt_deg": 1.0}})
    specs = {{"heap": spec("heap"), "conveyor": spec("conveyor"), "tilted": tilted}}
    print(json.dumps({{name: case_id(one) for name, one in specs.items()}}))
"""


@pytest.fixture
def tree(tmp_path):
    """Copy the packages of this project, so that a test can edit them."""
    for name in ("liggghts_io", "minidem", "templates"):
        skip = shutil.ignore_patterns("__pycache__")
        shutil.copytree(ROOT / name, tmp_path / "tree" / name, ignore=skip)
    return tmp_path / "tree"


def ask(tree, *words):
    """Run a few lines of Python with the packages of a tree."""
    environment = os.environ | {"PYTHONPATH": str(tree), "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(
        [sys.executable, "-c", _CODE, *words], cwd=tree, env=environment, capture_output=True,
        text=True, timeout=120, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_the_id_covers_the_code_that_matters_and_no_comment(tree):
    """What changes which ids: of a heap, of a conveyor, of a conveyor on a tilted plate."""
    everything = {"heap", "conveyor", "tilted"}
    edits = [
        ("templates/common.j2", "# Written by bulkcal;", "# Made by bulkcal;", set()),
        ("templates/common.j2", "{# Shared parts", "{# The shared parts", set()),
        ("templates/heap.in.j2", "# The spout is raised", "\n# The spout goes up", set()),
        ("templates/common.j2", "gravity 9.81", "gravity 9.80", everything),
        ("liggghts_io/case/lock.py", "_PATIENCE_S: Final = 1.0", "_PATIENCE_S: Final = 2.0", set()),
        ("liggghts_io/measure/flanks.py", "_LEAST_COLUMNS: Final = 5",
         "_LEAST_COLUMNS: Final = 6", everything),
        ("liggghts_io/experiments/heap/observing.py", "resting = frame.speeds <",
         "resting = frame.speeds <=", {"heap"}),
        ("liggghts_io/experiments/conveyor.py", "length + stroke + 12.0", "length + stroke + 12.5",
         {"conveyor", "tilted"}),
        ("liggghts_io/effects/apparatus/plate_tilt.py", "math.radians(", "1.01 * math.radians(",
         {"tilted"}),
        ("liggghts_io/stl.py", "(x[1], y[1], z), (x[0], y[1], z))",
         "(x[1], y[1], z), (x[0], 1.001 * y[1], z))", everything),
        ("minidem/kernels/step/step.py", "\n", "\n# a remark\n", everything),
        ("minidem/fixes/wall.py", "\n", "\n\n", everything),
    ]  # fmt: skip
    before = ask(tree)
    for name, old, new, changed in edits:
        path = tree / name
        text = path.read_text(encoding="utf-8")
        assert old in text, name
        path.write_text(text.replace(old, new, 1), encoding="utf-8")
        now = ask(tree)
        path.write_text(text, encoding="utf-8")
        assert {case for case in now if now[case] != before[case]} == changed, (name, new)


def test_the_particle_is_covered(make_spec, particles):
    heavier = replace(particles["Carbo HSP13"], density=particles["Carbo HSP13"].density + 1.0)
    assert case_id(make_spec(particle=heavier)) != case_id(make_spec())


def test_two_versions_in_one_directory_keep_to_their_own_runs(tree, tmp_path):
    root = str(tmp_path / "runs")
    own = ask(ROOT, root)
    path = tree / "liggghts_io" / "measure" / "mass_time.py"
    path.write_text(path.read_text().replace("_POINTS: Final = 201", "_POINTS: Final = 11"))
    theirs = ask(tree, root)
    assert own[0] != theirs[0]
    assert own[1] != theirs[1]
    assert (own[3], theirs[3]) == ([], [[own[0], ["observables"]]])
    # Each takes its own run, the one that is there.
    assert ask(ROOT, root) == [*own[:3], [[theirs[0], ["observables"]]]]
    assert ask(tree, root) == theirs


def test_a_case_of_another_version_is_refused_and_says_what_differs(
    small_spec, tmp_path, monkeypatch
):
    result = execute(small_spec(), tmp_path)
    monkeypatch.setattr(sources, "_minidem_digest", lambda: "0" * 64)
    for verb in (run_case, post_case):
        with pytest.raises(CaseError, match=r"made by another version.*\(engine: minidem [0-9a-f]"):
            verb(result.path)
    assert [(one.path, one.parts) for one in other_code(tmp_path)] == [(result.path, ("engine",))]
    monkeypatch.setattr(sources, "observables_code", lambda experiment: "0" * 64)
    assert other_code(tmp_path)[0].parts == ("engine", "observables")


def test_a_changed_template_is_told(small_spec, tmp_path, monkeypatch):
    result = execute(small_spec(), tmp_path)
    heap = replace(EXPERIMENTS["heap"], write=lambda _variables: "run 5\n")
    monkeypatch.setitem(EXPERIMENTS, "heap", heap)
    assert [(one.path, one.parts) for one in other_code(tmp_path)] == [(result.path, ("script",))]


def test_a_case_directory_of_an_earlier_form_is_told(small_spec, tmp_path):
    result = execute(small_spec(), tmp_path)
    (result.path / "case.json").write_text('{"case_id": "x", "inputs": {"spec": {}}}')
    assert [one.parts for one in other_code(tmp_path)] == [("record",)]
    (result.path / "case.json").write_text("garbage")
    assert other_code(tmp_path) == []
    assert other_code(tmp_path / "nowhere") == []
