"""The report: parsed as a browser would, it must hold everything and fetch nothing."""

from __future__ import annotations

import base64
import json
import shutil
from html.parser import HTMLParser
from pathlib import Path

import pytest

from calibrate.errors import CalibrationError
from calibrate.inference import Interval
from calibrate.report.gallery import Drawings
from calibrate.report.numbers import band, plus_minus, signed
from calibrate.report.page import write_report
from calibrate.report.record import write_calibration
from calibrate.report.sections import Section, add_section
from calibrate.runs.campaign import run_table
from calibrate.staged.calibration import Calibration, calibrate
from calibrate.study.data import load_data
from calibrate.study.load import load_study
from calibrate.study.resources import bundled_study
from calibrate.study.write import study_text
from liggghts_io import CaseResult
from liggghts_io.errors import CaseError
from liggghts_io.pictures.page import scene_of
from tests.browser import DESKTOP, PHONE, opened
from tests.calibrate import stand_in
from tests.liggghts_io.pictures.shots import pile, shot_of

VOID = {"meta", "img", "br", "hr", "link", "input"}
PNG = b"\x89PNG\r\n\x1a\n"


class Page(HTMLParser):
    """Collects what the tests ask for and complains about broken nesting."""

    def __init__(self) -> None:
        super().__init__()
        self.stack: list[str] = []
        self.images: list[dict[str, str]] = []
        self.addresses: list[str] = []
        self.ids: list[str] = []
        self.rows: dict[str, str] = {}
        self.text = ""
        self._row: str | None = None

    def handle_starttag(self, tag, attrs):
        """Note an element that opens."""
        found = {k: v or "" for k, v in attrs}
        if tag not in VOID:
            self.stack.append(tag)
        if tag == "img":
            self.images.append(found)
        self.addresses += [found[k] for k in ("src", "href") if k in found]
        if "id" in found:
            self.ids.append(found["id"])
        self._row = found.get("data-parameter") or found.get("data-target") or self._row

    def handle_endtag(self, tag):
        """Check that the innermost open element closes."""
        assert self.stack, f"</{tag}> closes nothing"
        assert self.stack.pop() == tag, f"</{tag}> closes the wrong element"
        if tag == "tr":
            self._row = None

    def handle_data(self, data):
        """Gather the text."""
        self.text += data
        if self._row:
            self.rows[self._row] = self.rows.get(self._row, "") + data


def parse(path: Path) -> Page:
    page = Page()
    page.feed(path.read_text(encoding="utf-8"))
    page.close()
    assert page.stack == []
    return page


@pytest.fixture(scope="module")
def result(tmp_path_factory) -> Calibration:
    """Calibrate the bundled study on the stand-in; one run fails with markup in its reason."""
    root = tmp_path_factory.mktemp("runs")

    def run(specs, label):
        results = [stand_in.execute(spec, root) for spec in specs]
        if "Stage 1" in label and "near" not in label:
            reason = "step 9: <script>alert(1)</script> lost"
            results[4] = CaseResult("x", root, "failed", reason, {}, 1.0)
        return run_table(specs, results)

    path = small_study(tmp_path_factory.mktemp("study"))
    return calibrate(load_data(path), run)


def small_study(directory: Path) -> Path:
    """Write the bundled study with fewer points beside its data: the report is the same."""
    bundled = bundled_study()
    for csv in bundled.parent.glob("*.csv"):
        shutil.copy(csv, directory)
    study = load_study(bundled)
    stages = [s.model_copy(update={"points": 12, "repeats": 2, "infill": 0}) for s in study.stages]
    path = directory / "small.toml"
    path.write_text(study_text(study.model_copy(update={"stages": stages})), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def report(result: Calibration, tmp_path_factory) -> Path:
    out = tmp_path_factory.mktemp("report")

    def render(directory: Path) -> Path:
        if directory == failing:
            msg = "no dump in this case"
            raise OSError(msg)
        picture = out / "picture.png"
        picture.write_bytes(PNG)
        return picture

    drawings = Drawings(render, lambda _directory: scene_of(shot_of(pile())))
    impacts = result.check_runs["experiment"] == "plate_impact"
    failing = Path(result.check_runs[impacts]["path"].iloc[0])
    written = write_report(result, out / "report.html", command="bulkcal test", drawings=drawings)
    return add_section(written, Section("What the model misses", "<p>Nothing so far.</p>"))


def test_report_is_one_file_that_fetches_nothing(report: Path):
    page = parse(report)
    for address in page.addresses:
        assert address.startswith(("data:image/png;base64,", "#")), address[:60]
    assert "@import" not in report.read_text()
    assert set(a[1:] for a in page.addresses if a.startswith("#")) <= set(page.ids)


def test_report_holds_parameters_with_intervals_and_published_values(report, result):
    rows = parse(report).rows
    for stage in result.stages:
        for (name, instance), value in zip(stage.freed.keys, stage.found.values(), strict=True):
            text = rows[name]
            assert f"{value:.3f}" in text
            assert band(stage.intervals[name][0.90]) in text
            assert f"{result.study.published_of(name, instance):.3f}" in text


def test_report_holds_measured_and_simulated_of_every_target(report, result):
    rows = parse(report).rows
    for row in result.check:
        assert plus_minus(row.measured, row.measured_se) in rows[row.name]
        assert plus_minus(row.simulated, row.simulated_se) in rows[row.name]
        assert signed(row.deviation_percent, " %") in rows[row.name]
    assert "not used" in rows["m4_steel"]


def test_report_has_a_picture_of_every_stage_and_experiment(report, result):
    page = parse(report)
    titles = " ".join(image["alt"] for image in page.images)
    for stage in result.stages:
        assert stage.stage.title in titles
    for words in ("Heap", "Oscillating conveyor"):
        assert words in titles
    for image in page.images:
        assert image["alt"]
        assert base64.b64decode(image["src"].partition(",")[2]).startswith(PNG)


def test_failed_runs_are_listed_and_their_reason_is_escaped(report, result):
    page = parse(report)
    assert (result.runs["status"] == "failed").sum() == 1
    assert "1 run failed" in page.text
    assert "step 9: <script>alert(1)</script> lost" in page.text  # as text, not as an element
    assert "<script>alert" not in report.read_text()


def test_report_says_where_it_comes_from(report):
    text = parse(report).text
    for words in ("bulkcal test", "smt", "Table B.4", "2019", "minidem"):
        assert words in text


def test_missing_picture_is_said_not_fatal(report: Path):
    assert "No picture: no dump in this case" in parse(report).text


@pytest.mark.parametrize("size", [PHONE, DESKTOP], ids=["phone", "desktop"])
def test_one_scene_is_turned_in_a_browser_and_nothing_is_fetched(report: Path, size):
    text = report.read_text(encoding="utf-8")
    assert text.count('id="scene"') == 1
    with opened(report, size) as shown:
        canvas = shown.page.locator("#scene canvas")
        canvas.scroll_into_view_if_needed()
        shown.page.wait_for_timeout(1000)
        assert shown.errors == []
        assert shown.requests == []
        assert canvas.bounding_box()["width"] > 0.8 * min(size[0], 900)
        # The wheel moves the text, also over the scene.
        before = shown.page.evaluate("window.scrollY")
        canvas.hover()
        shown.page.mouse.wheel(0, -200)
        shown.page.wait_for_function(f"window.scrollY < {before}")


def test_a_report_without_webgl_keeps_its_pictures(report: Path):
    with opened(report, webgl=False) as shown:
        assert shown.page.locator("#scene").is_hidden()
        assert shown.page.locator(".gallery img").first.is_visible()
        assert shown.errors == []


def test_a_scene_that_cannot_be_made_is_said(result: Calibration, tmp_path: Path):
    def render(directory: Path) -> Path:
        path = tmp_path / "picture.png"
        path.write_bytes(PNG)
        return path

    def scene(directory: Path) -> str:
        msg = "300000 grains make a page of 9 MB"
        raise CaseError(msg)

    page = parse(
        write_report(
            result, tmp_path / "r.html", command="bulkcal test", drawings=Drawings(render, scene)
        )
    )
    assert "No scene: 300000 grains make a page of 9 MB" in page.text


def test_section_is_added_once_and_replaced(report: Path):
    add_section(report, Section("Extra & more", "<p>old words</p>"))
    add_section(report, Section("Extra & more", "<p>new words</p>"))
    page = parse(report)
    assert page.ids.count("extra-more") == 1
    assert page.addresses.count("#extra-more") == 1
    assert "new words" in page.text
    assert "old words" not in page.text
    assert "Nothing so far." in page.text


def test_section_needs_a_report(tmp_path: Path):
    with pytest.raises(CalibrationError, match="no report there"):
        add_section(tmp_path / "none.html", Section("a", "b"))
    (tmp_path / "other.html").write_text("<p>other</p>")
    with pytest.raises(CalibrationError, match="not a calibration report"):
        add_section(tmp_path / "other.html", Section("a", "b"))


def test_record_holds_the_result_as_json(result, tmp_path: Path):
    path = write_calibration(result, tmp_path / "calibration.json", "bulkcal test")
    data = json.loads(path.read_text())
    assert data["parameters"] == dict(result.parameters)
    assert data["failed_runs"] == 1
    names = data["covariance"]["names"]
    assert names == ["mu_pp", "mu_roll_pp", "mu_pw", "mu_roll_pw", "e_pp", "e_pw"]
    assert len(data["covariance"]["matrix"]) == 6
    first = data["stages"][0]
    interval = first["intervals"]["mu_pp"]["0.9"]
    assert interval["low"] < data["parameters"]["mu_pp"] < interval["high"]


def test_stage_figures_are_large_enough_to_read(report: Path):
    stages = [image for image in parse(report).images if "Contour lines" in image["alt"]]
    assert len(stages) == 3
    for image in stages:
        data = base64.b64decode(image["src"].partition(",")[2])
        assert int.from_bytes(data[16:20], "big") > 800  # width in the PNG header


@pytest.mark.parametrize(
    ("interval", "text"),
    [
        (Interval(0.1, 0.25, False, False), "0.100 to 0.250"),
        (Interval(0.05, 0.25, True, False), "≤ 0.050 to 0.250"),
        (Interval(0.3, 0.6, False, True), "0.300 to ≥ 0.600"),
    ],
)
def test_open_interval_is_marked(interval, text):
    assert band(interval) == text


def test_digits_follow_the_error():
    assert plus_minus(38.2812, 0.61) == "38.28 ± 0.61"
    assert plus_minus(1234.5, 56.0) == "1234 ± 56"
    assert plus_minus(float("nan"), 0.1) == "n/a"
    assert plus_minus(2.0, float("nan")) == "2.00 ± ?"
    assert signed(float("nan"), " %") == "n/a"
