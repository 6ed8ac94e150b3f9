"""Whatever the words: exit code 0 or 2, one message, never a traceback, nothing written elsewhere.

Options are mixed from right, nearly right and absurd values; apparatus parameters and effects take
values at and beyond their limits. Files of a case are damaged in every way that a disk, an editor
or another program knows.
"""

from __future__ import annotations

import contextlib
import io
import os
import shutil
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from calibrate.cli.main import main
from calibrate.study.resources import bundled_study
from liggghts_io.case.directory import OUTPUT
from liggghts_io.effects import EFFECTS
from liggghts_io.experiments import EXPERIMENTS, SCALES
from liggghts_io.materials import CONTACT_PARAMETERS, SURFACES
from liggghts_io.measure.dumps import frame_paths
from tests.calibrate.cli.words import PAIRS, SMALL

WITHIN_S = 2.0
"""CPU time until a command that runs nothing ends or says something."""

ANY = settings(
    deadline=None, max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
# What no argument of a process can hold: NUL and lone surrogates other than of undecodable bytes.
odd_text = st.text(st.characters(exclude_characters="\0", exclude_categories=["Cs"]), max_size=12)
numbers = st.sampled_from(
    ["0", "-1", "1", "2", "0.5", "1e-300", "1e300", "-1e-30", "nan", "inf", "1e5", "", "1,5", "0x1"]
)
texts = st.one_of(odd_text, st.sampled_from(["", " ", "-", "--", "=", "a=", "\x1b[31m", "\udcff"]))


@contextlib.contextmanager
def sandbox() -> Iterator[tuple[Path, Path]]:
    """Give an empty directory to work in and the folder around it."""
    with tempfile.TemporaryDirectory() as around:
        work = Path(around) / "work"
        work.mkdir()
        before = Path.cwd()
        os.chdir(work)
        try:
            yield work, Path(around)
        finally:
            os.chdir(before)


def call(*words: str) -> tuple[int, str, str]:
    """Run the command in this process; return exit code, stdout and stderr."""
    out, err = io.StringIO(), io.StringIO()
    with (
        contextlib.redirect_stdout(out),
        contextlib.redirect_stderr(err),
        pytest.raises(SystemExit) as ended,
    ):
        main(words)
    return int(ended.value.code or 0), out.getvalue(), err.getvalue()


def check(*words: str, within_s: float | None = WITHIN_S) -> int:
    """Run the command and check how it ends."""
    started = time.process_time()
    code, out, err = call(*words)
    took = time.process_time() - started
    assert code in (0, 2), (words, err)
    assert "Traceback" not in out + err
    if code == 2:
        assert "bulkcal: " in err, words
        assert "nan is not" not in err
    assert within_s is None or took < within_s or err, (words, took)
    return code


def pairs(names: list[str]) -> st.SearchStrategy[str]:
    """Return words for -p, -a and -e: right names and others, with any value."""
    return st.one_of(
        st.builds(lambda n, v: f"{n}={v}", st.one_of(st.sampled_from(names), texts), numbers),
        texts,
    )


EVERY_APPARATUS = sorted({p.name for e in EXPERIMENTS.values() for p in e.parameters})
GENERATE = {
    "--surface": st.one_of(st.sampled_from(SURFACES), texts),
    "--scale": st.one_of(st.sampled_from(SCALES), texts),
    "--engine": st.one_of(st.sampled_from(["minidem", "liggghts"]), texts),
    "--seed": st.one_of(numbers, st.integers().map(str)),
    "--particle": st.one_of(st.sampled_from(["Carbo HSP13", "Carbo HSP30/60"]), texts),
    "--particles": texts,
    "-p": pairs(list(CONTACT_PARAMETERS)),
    "-a": pairs(EVERY_APPARATUS),
    "-e": pairs(list(EFFECTS)),
    "--out": texts,
    "--json": st.none(),
    "--dry-run": st.none(),
    "-q": st.none(),
    "-v": st.none(),
}


def options(known: dict[str, st.SearchStrategy[str | None]]) -> st.SearchStrategy[list[str]]:
    """Return lists of options with values."""
    one = st.sampled_from(sorted(known)).flatmap(
        lambda name: known[name].map(lambda value: [name] if value is None else [name, value])
    )
    return st.lists(one, max_size=3).map(lambda found: [word for pair in found for word in pair])


@ANY
@given(experiment=st.one_of(st.sampled_from(sorted(EXPERIMENTS)), texts), words=options(GENERATE))
def test_generate(experiment: str, words: list[str]):
    with sandbox() as (work, around):
        code = check("generate", *PAIRS, "--out", "case", *words, "--", experiment)
        assert list(around.iterdir()) == [work]
        wrote = list(work.rglob("in.script"))
        assert len(wrote) == (code == 0 and "--dry-run" not in words)


@pytest.mark.parametrize("experiment", sorted(EXPERIMENTS))
def test_every_apparatus_parameter_at_and_beyond_its_limits(experiment: str):
    with sandbox() as (work, _):
        for one in EXPERIMENTS[experiment].parameters:
            low, high = one.limits
            for value in (low, high, low - 1.0, high + 1.0, 0.0, -1.0, 0.5, 1e-300, 1e300):
                if value in (float("inf"), float("-inf")):
                    continue
                word = f"{one.name}={value!r}"
                check("generate", experiment, *PAIRS, "-a", word, "--out", "case", "--dry-run")
        assert list(work.iterdir()) == []


@pytest.mark.parametrize("name", sorted(EFFECTS))
def test_every_effect_at_and_beyond_its_limits(name: str):
    effect = EFFECTS[name]
    with sandbox():
        for value in (effect.low, effect.high, effect.low - 1, 2 * effect.high, 0.0, 1e300, 1e-300):
            for experiment in EXPERIMENTS:
                words = ["generate", experiment, *PAIRS, "-e", f"{name}={value!r}"]
                check(*words, "--out", "case", "--dry-run")


CASE_VERBS = {
    "run": {"--engine": texts, "--dry-run": st.none(), "--json": st.none(), "-v": st.none()},
    "post": {
        "--json": st.none(),
        "-q": st.none(),
        "-v": st.none(),
        "--angle": st.none(),
        "--thermo": st.none(),
        "--column": texts,
        "--box": texts,
        "--frames": texts,
        "--units": texts,
        "--dump": texts,
        "--experiment": texts,
        "--out": texts,
        "--density": numbers,
        "--diameter": numbers,
    },
    "render": {
        "--frame": st.one_of(texts, numbers),
        "--json": st.none(),
        "--view": texts,
        "--colour": texts,
        "--out": texts,
        "--movie": texts,
        "--html": texts,
        "--mesh": texts,
        "--diameter": numbers,
    },
    "apparatus": {"--json": st.none()},
    "retry": {"--class": texts, "--json": st.none()},
}


@pytest.mark.parametrize("verb", sorted(CASE_VERBS))
@ANY
@given(data=st.data())
def test_verbs_of_cases_where_there_is_none(verb: str, data: st.DataObject):
    words = data.draw(options(CASE_VERBS[verb]))
    place = data.draw(st.one_of(texts, st.sampled_from(["FILE", "EMPTY", "..", "/proc/self"])))
    with sandbox() as (work, around):
        (work / "FILE").write_bytes(b"\0\xff")
        (work / "EMPTY").mkdir()
        check(verb, *words, "--", place)
        assert list(around.iterdir()) == [work]
        assert sorted(path.name for path in work.iterdir()) == ["EMPTY", "FILE"]


@pytest.mark.parametrize("verb", ["calibrate", "diagnose", "check"])
@ANY
@given(
    study=st.one_of(texts, st.sampled_from(["FILE", ".", "BROKEN.toml"])),
    content=st.one_of(st.binary(max_size=40), st.just(b"[" * 100_000), st.just(b"a = 1\0")),
)
def test_studies_that_are_none(verb: str, study: str, content: bytes):
    with sandbox() as (work, around):
        (work / "FILE").write_bytes(content)
        (work / "BROKEN.toml").write_bytes(content)
        assert check(verb, "--", study) == 2
        assert list(around.iterdir()) == [work]
        assert sorted(path.name for path in work.iterdir()) == ["BROKEN.toml", "FILE"]


STUDY_OPTIONS = {
    "--workers": st.one_of(numbers, st.integers().map(str)),
    "--out": texts,
    "--json": st.none(),
    "-q": st.none(),
}


@pytest.mark.parametrize("verb", ["calibrate", "demo"])
@settings(ANY, max_examples=15)
@given(words=options(STUDY_OPTIONS))
def test_options_of_studies(verb: str, words: list[str]):
    """A dry run, so that right options cost nothing."""
    study = [str(bundled_study())] if verb == "calibrate" else []
    with sandbox() as (work, around):
        check(verb, *study, "--dry-run", *words, within_s=None)
        assert list(around.iterdir()) == [work]
        assert list(work.iterdir()) == []


@pytest.fixture(scope="module")
def finished(tmp_path_factory) -> Path:
    """Return a finished heap."""
    case = tmp_path_factory.mktemp("finished") / "case"
    assert call("generate", "heap", *PAIRS, *SMALL, "--out", str(case))[0] == 0
    assert call("run", str(case), "-q")[0] == 0
    return case


FRAME = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\n"
DAMAGES = {
    "empty": b"",
    "binary": bytes(range(256)) * 8,
    "no radius": f"{FRAME}ITEM: ATOMS id type x y z vx vy vz\n1 1 0 0 0 0 0 0\n".encode(),
    "far away": f"{FRAME}ITEM: ATOMS id x y z vx vy vz radius\n1 1e30 0 0 0 0 0 1\n".encode(),
    "garbage": b"solid x\nfacet\nvertex a b c\nvertex 1 2 3\nvertex 1e999 0 0\nendsolid",
    "cut": None,
}


@pytest.mark.parametrize("by_hand", [False, True], ids=["output", "by hand"])
@pytest.mark.parametrize("damage", sorted(DAMAGES))
@pytest.mark.parametrize("verb", ["post", "render"])
def test_a_damaged_run_is_refused_by_name(
    verb: str, damage: str, by_hand: bool, finished: Path, tmp_path: Path
):
    """Frames, meshes, script, log and records, one at a time, of a run of ours or by hand."""
    case = tmp_path / "case"
    _copy(finished, case, by_hand=by_hand)
    run = case if by_hand else case / OUTPUT
    words = ["--frame", "last"] if verb == "render" else []
    places = [frame_paths(run)[-1], run / "meshes" / "plate.stl", case / "case.json"]
    if not by_hand:
        places += [run / "in.script", run / "end.json", run / "log.liggghts"]
    elif verb == "post":
        places += [run / "in.script", run / "log.liggghts"]
    for path in places:
        whole = path.read_bytes()
        content = DAMAGES[damage]
        path.write_bytes(whole[: len(whole) // 2] if content is None else content)
        assert check(verb, str(case), *words, within_s=None) == 2, path
        path.write_bytes(whole)


def _copy(source: Path, target: Path, *, by_hand: bool) -> None:
    shutil.copytree(source, target)
    if by_hand:
        for path in (target / OUTPUT).iterdir():
            if path.name in ("log.liggghts", "post"):
                path.rename(target / path.name)
        shutil.rmtree(target / OUTPUT)
        (target / "result.json").unlink()
