"""Further experiments: their files, where they are made, the case of each answer."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest

from calibrate.causes.judging.probabilities import UNKNOWN
from calibrate.causes.studies.further.options import case_of, options_of
from calibrate.causes.studies.further.registry import FOLDER, Entry, entries_of, read_entry
from calibrate.errors import CalibrationError
from calibrate.study.data import StudyData, load_data
from calibrate.study.resources import bundled_study
from liggghts_io.case.spec import script_of
from tests.calibrate.causes import studies
from tests.calibrate.causes.further.looked import (
    ADHESION,
    ALUMINA,
    BEADS,
    DRUM,
    FASTER,
    FLOW,
    PERIOD,
    diagnosis,
)
from tests.calibrate.questions.planted import TRUTH
from tests.paths import ROOT

NOTHING = diagnosis({(): 1.0})


@pytest.fixture(scope="module")
def data(tmp_path_factory) -> StudyData:
    return studies.study(tmp_path_factory.mktemp("study"), {}, 5)


def _case(data: StudyData, entry: Entry, names: tuple[str, ...], where: str = ""):
    found = diagnosis({names: 1.0})
    options = options_of(data.study, {"x": entry}, found, {})
    option = next(one for one in options if where in one.place.surface)
    values, strengths = found.samples(names)
    prior = np.full(len(data.study.parameters), 0.25)
    return case_of(option, found, names, (values[0], strengths[0]), prior, 5), values[0]


def test_what_the_study_does_not_know_elsewhere_comes_from_its_prior(data) -> None:
    spec, values = _case(data, ALUMINA, (PERIOD,))
    at = dict(zip(studies.FREE, values, strict=True))
    assert spec.surface == "flat"
    assert spec.parameters["mu_pp"] == pytest.approx(at["mu_pp"])  # the same grains
    assert spec.parameters["mu_pw"] == pytest.approx(0.1 + 0.25 * 0.7)  # a quarter of its range
    spec, values = _case(data, BEADS, (PERIOD,), "steel")
    assert spec.particle.name == "beads"
    assert spec.parameters["mu_pp"] == pytest.approx(0.275)
    assert spec.parameters["e_pp"] == TRUTH["e_pp"]  # given in the study
    spec, values = _case(data, FASTER, (PERIOD,), "steel")
    assert spec.apparatus["period_s"] == pytest.approx(0.064)
    assert spec.parameters["mu_pw"] == pytest.approx(values[studies.FREE.index("mu_pw")])


def test_a_cause_acts_where_it_acts_in_the_study(data) -> None:
    for names, entry, where, on in (
        ((PERIOD,), FASTER, "steel", True),
        ((PERIOD,), DRUM, "steel", False),
        ((f"{FLOW}:conveyor_flat",), FASTER, "steel", True),
        ((f"{FLOW}:conveyor_flat",), FASTER, "glued", False),
        ((f"{FLOW}:conveyor_flat",), ALUMINA, "", True),  # the same funnel
        ((ADHESION,), ALUMINA, "", True),
        ((f"{ADHESION}:steel",), ALUMINA, "", False),
        ((f"{ADHESION}:steel",), DRUM, "steel", True),
    ):
        spec, _ = _case(data, entry, names, where)
        (effect,) = (name.partition(":")[0] for name in names)
        assert (effect in spec.effects) is on, (names, entry.words, where)


def test_an_experiment_is_offered_where_it_is_new(data) -> None:
    def places(entry: Entry) -> list[tuple[str, str]]:
        return [one.place[:2] for one in options_of(data.study, {"x": entry}, NOTHING, {})]

    assert places(FASTER) == [("A", "steel"), ("A", "glued")]
    assert places(DRUM) == [("A", "steel"), ("A", "glued")]
    assert places(ALUMINA) == [("A", "alumina")]
    heap = DRUM.model_copy(update={"experiment": "heap"})
    assert places(heap) == []  # made already, and nothing differs
    glued = DRUM.model_copy(update={"experiment": "tilting_plate"})
    assert places(glued) == [("A", "steel")]  # nothing slides on glued grains
    lone = data.study.model_copy(
        update={"targets": [t for t in data.study.targets if t.experiment == "heap"]}
    )
    assert options_of(lone, {"x": FASTER}, NOTHING, {}) == []  # no conveyor there
    # Each at one place first, then the shortest.
    brief = DRUM.model_copy(update={"hours": 0.1})
    listed = options_of(data.study, {"slow": DRUM, "brief": brief}, NOTHING, {})
    assert [o.name for o in listed] == [
        f"{n}:A/{s}" for s in ("steel", "glued") for n in ("brief", "slow")
    ]


def test_of_several_places_that_comes_first_where_what_is_suspected_acts(data) -> None:
    """With the flow of one funnel suspected, the other conveyor was tried and told nothing."""
    steel, glued = f"{ADHESION}:steel", f"{FLOW}:conveyor_glued"
    for shares, first in (
        ({(steel,): 0.6, (PERIOD,): 0.4}, "steel"),
        ({(glued,): 0.6, (PERIOD,): 0.4}, "glued"),
        ({(glued,): 0.1, (steel,): 0.2, (UNKNOWN,): 0.7}, "steel"),
    ):
        options = options_of(data.study, {"x": FASTER}, diagnosis(shares), shares)
        assert options[0].place.surface == first, shares
        assert len(options) == 2


def test_every_bundled_experiment_can_be_tried_on_the_bundled_study() -> None:
    data = load_data(bundled_study())
    entries = entries_of(data)
    assert set(entries) == {path.stem for path in FOLDER.glob("*.toml")}
    options = options_of(data.study, entries, NOTHING, {})
    assert {one.name.partition(":")[0] for one in options} == set(entries)
    found = diagnosis({(): 1.0})
    prior = np.full(len(data.study.parameters), 0.5)
    values = np.full(len(data.study.free), 0.4)
    for one in options:
        script_of(case_of(one, found, (), (values, np.empty(0)), prior, 5))


def _own(tmp_path: Path, text: str) -> StudyData:
    home = tmp_path / "plain"
    shutil.copytree(ROOT / "cases" / "plain_script", home)
    folder = home / "hopper" / "further"
    folder.mkdir()
    (folder / "own.toml").write_text(text, encoding="utf-8")
    return load_data(home / "study.toml")


def test_an_own_experiment_brings_its_own(tmp_path: Path) -> None:
    data = load_data(ROOT / "cases" / "plain_script" / "study.toml")
    (experiment,) = (data.study.experiments[rig.name] for rig in data.study.rigs if rig.folder)
    number, observable = experiment.parameters[0], experiment.observables[0]
    text = (
        f'words = "mine"\nhours = 1.0\nexperiment = "{experiment.name}"\n'
        f"apparatus = {{ {number.name} = {number.quick} }}\n[se]\n{observable.name} = 0.1\n"
    )
    own = _own(tmp_path, text)
    assert entries_of(own)["own"].words == "mine"
    outside = own.path.parent / "hopper" / "further" / "link.toml"
    outside.symlink_to(FOLDER / "drum.toml")
    assert "link" not in entries_of(own)
    (own.path.parent / "hopper" / "further" / "drum.toml").write_text(text, encoding="utf-8")
    with pytest.raises(CalibrationError, match="'drum' is the name of another further experiment"):
        entries_of(own)


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (
            '"conveyor"',
            '"conveyer"',
            "experiment: unknown name 'conveyer'; did you mean 'conveyor'",
        ),
        ("period_s", "perod_s", "times: unknown name 'perod_s'; did you mean 'period_s'"),
        ("t100_s", "t10_s", "se: unknown name 't10_s'; did you mean 't100_s'"),
        ("hours = 1.0", "hours = 0.0", "hours: must be above 0"),
        ("hours = 1.0", "hour = 1.0", "hours: Field required"),
        ("[se]", "[[se]]", "see docs/how-to/add-a-further-experiment.md"),
        ("hours = 1.0", "hours = ", "see docs/how-to/add-a-further-experiment.md"),
    ],
)
def test_a_mistake_in_a_file_is_told_with_its_place(data, tmp_path, old, new, expected) -> None:
    path = tmp_path / "x.toml"
    text = (FOLDER / "conveyor_frequency.toml").read_text(encoding="utf-8")
    path.write_text(text.replace(old, new), encoding="utf-8")
    with pytest.raises(CalibrationError) as told:
        read_entry(path, data.study)
    assert str(told.value).startswith(f"{path}: ")
    assert expected in str(told.value)
