"""The commands `challenge ...` on wrong input: one message with a remedy, nothing written."""

from __future__ import annotations

import pytest

from tests.paths import ROOT

RULES = ROOT / "cases" / "challenge" / "dev.toml"


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("make nowhere.toml", "nowhere.toml"),
        ("make broken.toml", "single"),
        ("make rules.toml", "give --seed TEXT"),
        ("make lonely.toml --seed a", "study.toml"),
        ("forecast empty --rules nowhere.toml", "nowhere.toml: No such file"),
        ("forecast sealed --rules rules.toml", "r.csv: no table of runs"),
        ("forecast empty --rules rules.toml", "'bulkcal challenge make' writes one"),
        ("forecast empty --rules rules.toml --method orcale", "did you mean 'oracle'"),
        ("score empty --rules rules.toml --forecasts rules.zip", "no archive of forecasts"),
        ("score empty --rules rules.toml", "bulkcal challenge forecast empty"),
        ("score sealed --rules rules.toml", "truths.json: No such file"),
        ("score opened --rules rules.toml", "sealed.json: holds no digests"),
    ],
)
def test_a_mistake_is_told_with_its_remedy(bulkcal, tmp_path, monkeypatch, words, said):
    monkeypatch.chdir(tmp_path)
    good = f'name = "a"\nstudy = "{RULES.parent}/one_material.toml"\nruns = "r.csv"\n'
    (tmp_path / "rules.toml").write_text(good, encoding="utf-8")
    (tmp_path / "broken.toml").write_text(good + "single = -1\n", encoding="utf-8")
    lonely = 'name = "a"\nstudy = "study.toml"\nruns = "r.csv"\n'
    (tmp_path / "lonely.toml").write_text(lonely, encoding="utf-8")
    (tmp_path / "empty").mkdir()
    study = tmp_path / "sealed" / "studies" / "study_0001"
    study.mkdir(parents=True)
    (study / "study.toml").touch()
    (tmp_path / "sealed" / "sealed.json").write_text('{"digests": {}}', encoding="utf-8")
    for suite in ("sealed", "opened"):
        (tmp_path / suite / "forecasts" / "ours").mkdir(parents=True)
    for record in ("sealed.json", "truths.json"):
        (tmp_path / "opened" / record).write_text("{}", encoding="utf-8")
    before = sorted(tmp_path.rglob("*"))
    code, _, err = bulkcal("challenge", *words.split())
    assert code == 2, err
    assert said in err
    assert "Traceback" not in err
    assert sorted(tmp_path.rglob("*")) == before


def test_help_names_the_verbs(bulkcal):
    code, out, _ = bulkcal("challenge", "--help")
    assert code == 0
    assert all(verb in out for verb in ("make", "forecast", "score"))
