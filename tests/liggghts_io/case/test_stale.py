"""What lies in a case directory from before, or was changed by hand, never becomes a result."""

import shutil
import subprocess
import time

import pytest

from liggghts_io import (
    CaseError,
    execute,
    load_result,
    post_case,
    render_case,
    run_case,
    write_case,
)
from liggghts_io.case.runner import run_engine
from liggghts_io.measure.schedule import read_schedule
from minidem import run_script

ENGINES = ["minidem", pytest.param("liggghts", marks=pytest.mark.liggghts)]


@pytest.fixture
def ran(small_spec, tmp_path):
    """Return the directory of a heap that was run."""
    case = write_case(small_spec(), tmp_path / "case")
    run_case(case)
    return case


def test_results_of_another_case_are_not_written_over(ran, small_spec, make_spec):
    before = {path: path.read_bytes() for path in ran.rglob("*") if path.is_file()}
    apparatus = small_spec().apparatus
    for other in (
        small_spec(seed=2),
        make_spec(apparatus={**apparatus, "frames": 20.0}),
        small_spec("plate_impact"),
    ):
        with pytest.raises(CaseError, match=r"holds results of another case.*another --out"):
            write_case(other, ran)
    assert {path: path.read_bytes() for path in ran.rglob("*") if path.is_file()} == before
    write_case(small_spec(), ran)  # the same case: nothing is lost
    assert load_result(ran).status == "ok"


def test_a_case_that_was_never_run_is_replaced_with_its_meshes(small_spec, tmp_path):
    write_case(small_spec("plate_impact"), tmp_path)
    write_case(small_spec("heap"), tmp_path)
    assert [path.name for path in (tmp_path / "meshes").iterdir()] == ["plate.stl"]
    assert run_case(tmp_path).status == "ok"


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda text: text.replace("run ", "run 1", 1), "in.script: was changed by hand"),
        (lambda text: text.replace("dump frames all custom ", "dump frames all custom 1"),
         "in.script: was changed by hand"),
        (lambda text: text.rsplit("\nprint", 1)[0], "in.script: was changed by hand"),
        (lambda text: text + "run 1000\n", "in.script: was changed by hand"),
        (lambda text: text + text.splitlines()[-1].replace("complete", "x"), "in.script: was chan"),
        (lambda text: "", "in.script: is empty"),
        (lambda text: " \n", "in.script: is empty"),
    ],
)  # fmt: skip
def test_a_script_changed_by_hand_is_refused_before_and_after_the_run(
    small_spec, tmp_path, change, message
):
    case = write_case(small_spec(), tmp_path)
    script = case / "in.script"
    right = script.read_text()
    script.write_text(change(right))
    with pytest.raises(CaseError, match=message):
        run_case(case)
    script.write_text(right)
    run_case(case)
    script.write_text(change(right))
    for again in (run_case, post_case):
        with pytest.raises(CaseError, match=message):
            again(case)


def test_a_comment_in_a_script_changes_nothing(ran):
    script = ran / "in.script"
    script.write_text("# a note of mine\n\n" + script.read_text())
    assert post_case(ran).observables == load_result(ran).observables


@pytest.mark.parametrize("content", [b"", b"solid plate\nendsolid plate\n"])
def test_a_changed_mesh_is_refused(ran, content):
    (ran / "meshes" / "plate.stl").write_bytes(content)
    for verb in (run_case, post_case):
        with pytest.raises(CaseError, match=r"plate.stl: (was changed|is empty)"):
            verb(ran)
    (ran / "meshes" / "plate.stl").unlink()
    with pytest.raises(CaseError, match=r"plate.stl: cannot be read"):
        run_case(ran)


def test_a_case_of_a_campaign_keeps_its_engine(small_spec, tmp_path):
    stored = execute(small_spec(), tmp_path)
    with pytest.raises(CaseError, match="belongs to a campaign; for liggghts make a case of its"):
        run_case(stored.path, "liggghts")
    assert execute(small_spec(), tmp_path) == stored
    never_run = write_case(small_spec(seed=2), tmp_path / "x")
    moved = never_run.rename(tmp_path / execute(small_spec(seed=2), tmp_path / "y").case_id)
    with pytest.raises(CaseError, match="belongs to a campaign"):
        run_case(moved, "liggghts")


@pytest.mark.liggghts
def test_a_case_that_was_never_run_is_recorded_for_another_engine(small_spec, tmp_path):
    case = write_case(small_spec("plate_impact"), tmp_path)
    said: list[str] = []
    result = run_case(case, "liggghts", tell=said.append)
    assert said == [f"{case}: was generated for minidem; now recorded for liggghts"]
    truth = execute(small_spec("plate_impact", engine="liggghts"), tmp_path / "truth")
    assert (result.case_id, result.observables) == (truth.case_id, truth.observables)
    with pytest.raises(CaseError, match="has results of liggghts; for minidem make a case"):
        run_case(case, "minidem")


def test_a_stored_result_is_shown_and_run_again_only_on_request(ran):
    before = load_result(ran)
    said: list[str] = []
    assert run_case(ran, tell=said.append) == before
    assert said == ["this case has been run: the stored result is shown; --again runs it again"]
    again = run_case(ran, again=True)
    assert again.observables == before.observables
    assert again.output != before.output  # another duration at least
    assert not list(ran.glob("attempt-*"))


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("experiment", ["heap", "plate_impact"])
def test_a_run_by_hand_counts_when_it_completed(small_spec, tmp_path, experiment, engine):
    spec = small_spec(experiment, engine=engine)
    truth = execute(spec, tmp_path / "truth").observables
    case = write_case(spec, tmp_path / "case")
    run_engine(case, "in.script", engine)
    assert post_case(case).observables == truth
    assert render_case(case).is_file()


@pytest.mark.parametrize("experiment", ["heap", "conveyor", "plate_impact"])
def test_a_run_by_hand_that_was_stopped_says_how_far_it_got(
    timed_spec, small_spec, tmp_path, experiment
):
    """A conveyor and a plate impact that stop early give numbers that look right."""
    spec = timed_spec() if experiment == "conveyor" else small_spec(experiment)
    case = write_case(spec, tmp_path)
    written = case / "post"

    def enough() -> bool:
        return len(list(written.glob("*"))) > 0.9 * spec_frames(case)

    with pytest.raises(KeyboardInterrupt):
        run_script(case / "in.script", root=case, stop=enough)
    with pytest.raises(CaseError, match=r"the run stopped at step [1-9]\d+ of \d+; run it again"):
        post_case(case)


def spec_frames(case):
    """Return how many frames a case asks for."""
    return len(read_schedule(case / "in.script").frames)


@pytest.mark.liggghts
def test_liggghts_stopped_by_hand_says_how_far_it_got(small_spec, tmp_path):
    spec = small_spec("plate_impact", engine="liggghts")
    case = write_case(spec, tmp_path)
    program = ["stdbuf", "-oL", "liggghts", "-in", "in.script"]
    with subprocess.Popen(program, cwd=case, stdout=subprocess.DEVNULL) as child:
        while len(list((case / "post").glob("*"))) < 0.7 * spec_frames(case):
            assert child.poll() is None, "the run ended before"
            time.sleep(0.002)
        child.terminate()
    with pytest.raises(CaseError, match=r"the run stopped at step [1-9]\d+ of \d+; run it again"):
        post_case(case)


def test_a_run_by_hand_with_the_other_engine_is_refused(small_spec, tmp_path):
    case = write_case(small_spec(engine="liggghts"), tmp_path)
    run_engine(case, "in.script", "minidem")
    with pytest.raises(CaseError, match="written by minidem, the case is one for liggghts"):
        post_case(case)


def test_a_run_by_hand_beside_an_output_is_not_guessed(ran):
    shutil.copytree(ran / "output" / "post", ran / "post")
    assert post_case(ran).status == "ok"  # no log: nobody ran it here
    run_engine(ran, "in.script", "minidem")
    with pytest.raises(CaseError, match="holds output/ and a newer run by hand; remove output/"):
        post_case(ran)


def test_a_mark_of_another_case_proves_nothing(small_spec, tmp_path):
    one = write_case(small_spec(), tmp_path / "one")
    other = write_case(small_spec(seed=2), tmp_path / "other")
    run_engine(one, "in.script", "minidem")
    for name in ("post", "log.liggghts"):
        (one / name).rename(other / name)
    with pytest.raises(CaseError, match=r"the run stopped at step"):
        post_case(other)


def test_what_was_never_run_is_said_to_be_so(small_spec, tmp_path):
    case = write_case(small_spec(), tmp_path)
    for verb in (post_case, render_case):
        with pytest.raises(CaseError, match="has not been run; run it with 'bulkcal run"):
            verb(case)
