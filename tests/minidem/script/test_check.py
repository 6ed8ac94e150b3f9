"""``minidem --check``: all that will be refused is named at once, and nothing that will not."""

from __future__ import annotations

import pytest

from minidem import ScriptError, check_script, cli, run_script
from minidem.checking import findings_text, is_refused
from tests.minidem.script.test_acceptance import POUR, SCRIPT, after

GAPS = after(
    """fix h all heat/gran initial_temperature 300
compute r all cna/atom 0.01
fix w2 all wall/grann
shell python post.py
thermo_style custom step cpu atomz"""
)
NOTHING = "variable n equal 0\n"


def find(folder, text, **options):
    """Return the lines and messages of what is found in a script."""
    script = folder / "in.s"
    script.write_text(text)
    return check_script(script, root=folder, **options)


def messages(folder, text, **options):
    return [f"{one.error.line}: {one.error.message}" for one in find(folder, text, **options)]


def test_all_words_are_named_at_once_with_line_and_what_they_do(tmp_path):
    found = find(tmp_path, GAPS)
    assert [one.error.line for one in found] == [25, 26, 27, 28, 29]
    assert [one.moves for one in found] == [False, False, True, False, False]
    assert [one.refused for one in found] == [True, True, True, False, True]
    text = findings_text("in.s", found)
    assert "5 lines that minidem does not carry out, 4 of them without influence" in text
    assert "heat is not computed; without it the motion is the same" in text
    assert "    refused; does not change the motion\n    | compute r all cna/atom 0.01\n" in text
    assert "did you mean 'wall/gran'?" in text
    assert "'shell python post.py' is skipped" in text
    assert is_refused(found)


def test_run_names_them_all_before_its_first_command(tmp_path):
    (tmp_path / "in.s").write_text('print "first" file begun\n' + GAPS)
    with pytest.raises(ScriptError, match=r"in\.s:26: fix 'heat/gran'") as error:
        run_script(tmp_path / "in.s", root=tmp_path)
    for line in (27, 28, 30):
        assert f"in.s:{line}: " in str(error.value)
    assert not (tmp_path / "begun").exists()


def test_word_after_hours_is_named_before_the_first_step(tmp_path):
    script = SCRIPT + "run 1000000\ngroup fast sorted 3\nbond_style none\n"
    assert [one.split(":")[0] for one in messages(tmp_path, script)] == ["27", "28"]


@pytest.mark.parametrize(
    "lines",
    [
        'if "0 == 1" then "fix h all heat/gran 1"',
        'if "1 == 1" then "print yes" else "fix h all heat/gran 1"',
        'variable k index no\nif "0" then "unheard of"',
        "jump SELF over\nunheard of\nlabel over",
        "quit\nunheard of",
        "variable k loop 3\nlabel a\nprint $k\nnext k\njump SELF a\nprint done",
        "variable k loop 40\nlabel a\nprint $k\nnext k\njump SELF a\nprint done",
        "variable e equal ke\nrun 1\nprint ${e}\nvariable f equal 1/v_e\nprint ${f}",
        'variable e equal ke\nif "${e} > 3" then "timestep 1e-5" else "timestep 1e-6"',
        "variable n equal count(all)\nvariable k loop ${n}\nprint $k\nnext k",
        "write_restart r.1\nclear\nread_restart r.1",
        "restart 2 r\nrun 3\nclear\nread_restart r.6\nrun 10000 upto",
        'print "timestep 1e-6" file part.s\ninclude part.s',
        "shell mkdir post\nshell cd post\nshell cd ..",
        'variable e equal ke\nif "${e} > 1" then "run 100"\nrun 50 upto',
        'variable e equal ke\nif "${e} > 1" then "unfix i"\nunfix i',
    ],
    ids=lambda lines: lines[:40],
)
def test_what_may_well_run_is_no_finding(tmp_path, lines):
    assert not [one for one in find(tmp_path, after(lines)) if not one.missing_file]
    assert not is_refused(find(tmp_path, after(lines)))
    assert {path.name for path in tmp_path.iterdir()} == {"in.s"}, "something was written"


@pytest.mark.parametrize(
    ("lines", "certain"),
    [
        ('variable e equal ke\nif "${e} > 3" then "fix h all heat/gran 1"', False),
        ('variable e equal ke\nif "${e} > 3" then "jump SELF over"\nbond_style none\nlabel over',
         False),
        ('variable e equal ke\nif "${e} > 3" then "jump SELF o"\nlabel o\nbond_style none', True),
        ('variable e equal ke\nlabel b\nrun 1\nif "${e} > 3" then "jump SELF b"\nbond_style none',
         True),
    ],
)  # fmt: skip
def test_what_only_the_simulation_decides_is_no_refusal(tmp_path, lines, certain):
    found = find(tmp_path, after(lines))
    assert [one.certain for one in found] == [certain]
    assert is_refused(found) is certain
    assert ("if the script gets to it" in findings_text("in.s", found)) is not certain


def test_doubtful_word_is_a_warning_of_the_run(tmp_path, capsys):
    (tmp_path / "in.s").write_text(
        'variable n equal random(0,1,10007)\nif "${n} > 2" then "bond_style none"\n'
        "print end file e\n"
    )
    run_script(tmp_path / "in.s", root=tmp_path)
    assert (tmp_path / "e").read_text() == "end\n"


LATE = """undump contacts
dump d
print "${unknown}"
compute ke all ke
compute ke all ke
write_restart a.restart now
"""


def test_mistake_of_liggghts_too_ends_the_run_where_liggghts_ends_it(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    found = find(tmp_path, SCRIPT + LATE)
    assert [one.error.line for one in found] == [26, 27, 28, 30, 31]
    assert all(one.shared for one in found)
    assert "in LIGGGHTS as well" in findings_text("in.s", found)
    assert cli.main(["-in", "in.s"]) == 2
    screen = capsys.readouterr()
    assert "the run stops if it gets to this line, as LIGGGHTS does" in screen.out + screen.err
    assert "for 3 steps" in screen.out
    assert "26: unknown undump ID 'contacts'" in screen.err


def test_mistake_of_liggghts_too_before_the_first_step_is_refused(tmp_path):
    assert [one.refused for one in find(tmp_path, after(LATE))] == [True] * 5


def test_mistake_that_follows_from_another_is_not_told(tmp_path):
    lines = "fix h all heat/gran 1\nfix_modify h energy yes\nvariable t equal f_h\nprint $t\n"
    lines += "unfix h"
    assert [one[:3] for one in messages(tmp_path, after(lines))] == ["25:"]


def test_words_behind_a_missing_box_are_still_found(tmp_path):
    script = SCRIPT.replace("create_box 1 reg", "read_data data.of.someone")
    found = messages(tmp_path, script.replace("run 3", "region c cube 1\nrun 3"))
    assert len(found) == 2
    assert "8: " in found[0]
    assert "region style 'cube'" in found[1]


def test_missing_mesh_is_refused_before_the_first_step(tmp_path):
    found = find(tmp_path, after("fix c all mesh/surface file no.stl type 1\nunfix c"))
    assert [one.missing_file for one in found] == [True]
    assert is_refused(found)


def test_included_files_are_checked_under_their_own_name(tmp_path):
    (tmp_path / "part.s").write_text("\nbond_style none\n")
    (found,) = find(tmp_path, "include part.s\n")
    assert (found.error.file, found.error.line) == ("part.s", 2)


def test_values_of_the_command_line_decide_branches(tmp_path):
    text = 'variable m index 1\nif "$m == 2" then "bond_style none"\n'
    assert not find(tmp_path, text)
    assert len(find(tmp_path, text, variables={"m": ["2"]})) == 1


def test_pour_has_all_its_words(tmp_path):
    pour = POUR.format(seed=32452843, target="particles_in_region 5")
    assert findings_text("in.s", find(tmp_path, after(pour))) == (
        "in.s: minidem has all words of it\n"
    )


# -- the command -----------------------------------------------------------------------------------


@pytest.mark.parametrize(("text", "code"), [(GAPS, 2), (SCRIPT, 0), (NOTHING, 0)])
def test_exit_code_tells_whether_it_would_run(tmp_path, monkeypatch, capsys, text, code):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "in.s").write_text(text)
    assert cli.main(["--check", "in.s"]) == code
    assert capsys.readouterr().out.startswith("in.s: ")
    assert {path.name for path in tmp_path.iterdir()} == {"in.s"}


def test_report_is_a_file_that_says_which_minidem(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "in.s").write_text(GAPS)
    assert cli.main(["--report", "in.s"]) == 2
    report = (tmp_path / cli.REPORT).read_text()
    assert report.startswith("minidem 0")
    assert "in.s:25: fix 'heat/gran' exists in LIGGGHTS but not in minidem" in report
    assert f"written to {cli.REPORT}" in capsys.readouterr().out


def test_check_and_run_at_once_is_no_call(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit):
        cli.main(["--check", "in.s", "-in", "in.s"])
    assert "not allowed with" in capsys.readouterr().err


def test_check_leaves_every_file_as_it_is(tmp_path):
    kept = {name: f"{name} of the last run" for name in ("log.a", "p.txt", "d.0", "r.10", "r.x")}
    for name, text in kept.items():
        (tmp_path / name).write_text(text)
    lines = """
log log.a
print hello file p.txt
print more append p.txt
fix p all print 10 hello file p.txt
dump d all custom 10 d.* id x y z
restart 10 r
run 20
write_restart r.x
log second.log append
"""
    assert not messages(tmp_path, SCRIPT + lines)
    names = {*kept, "in.s"}
    assert {path.name for path in tmp_path.iterdir()} == names
    assert {name: (tmp_path / name).read_text() for name in kept} == kept


@pytest.mark.parametrize("option", ["-in", "--check", "--report"])
def test_script_that_is_not_there_is_a_mistake_of_the_command_line(
    tmp_path, monkeypatch, capsys, option
):
    monkeypatch.chdir(tmp_path)
    assert cli.main([option, "nowhere.in"]) == 2
    said = capsys.readouterr()
    assert said.err == (
        "minidem: nowhere.in: cannot open input script 'nowhere.in': no such file\n"
    )
    assert not said.out
    assert not [*tmp_path.iterdir()]
