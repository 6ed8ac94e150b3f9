"""Templates and scripts of strangers: they reach nothing, and they come to an end."""

import time
from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st

from liggghts_io.case.spec import build_case
from liggghts_io.errors import CaseError
from liggghts_io.scripts import budget
from liggghts_io.scripts.forbidden import check_script
from liggghts_io.scripts.foreign import render_foreign
from liggghts_io.scripts.templating import render
from tests.paths import ROOT

NAMES = {
    "a": 3.0, "seed": 1, "sizes": [(1e-3, 1.0)], "density": 2500.0, "dt": 1e-5,
}  # fmt: skip
LIMIT_S = 30.0  # six times what a template may take, for a busy machine


LONG = "x" * 1_000_000


def rendered(text):
    return render_foreign(text, {**NAMES, "LONG": LONG}, "own/script.in.j2")


@pytest.mark.parametrize("name", ["heap", "conveyor", "plate_impact"])
def test_a_template_of_ours_is_written_alike(make_spec, name):
    """What we use of Jinja is there, `common.j2` and its macros included."""
    variables = build_case(make_spec(name)).variables
    text = (ROOT / "templates" / f"{name}.in.j2").read_text()
    assert render_foreign(text, variables, name) == render(f"{name}.in.j2", variables)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("{{ a ** 2 }} {{ 2 * a }} {{ a // 2 }}", "9.0 6.0 1.0"),
        ("{% for k in range(3) %}{{ k ~ 'x' }} {% endfor %}", "0x 1x 2x "),
        ("{% set b = (1, a) %}{{ b | map('number') | join(' ') }}", "1 3"),
        ("{{ 0.1 | steps(dt) }} {{ 1 if a > 2 else 0 }}", "10000 1"),
        ("{{ 2.3 | round(0, 'floor') }} {{ [3, 1] | sort(reverse=true) | join(' ') }}", "2.0 3 1"),
        ("{{ sizes | map('first') | map('round', 2) | join }} {{ 3 if a is defined }}", "0.0 3"),
        ("{{ [2, 1] | reverse | map('abs') | sum }} {{ '7' | int }} {{ [1, 4] | max }}", "3 7 4"),
    ],
)
def test_what_a_script_needs_is_there(text, expected):
    assert rendered(text) == expected


REFUSED = [
    "{{ ''.__class__.__mro__ }}", "{{ '{:1000000000}'.format(1) }}", "{{ self }}", "{{ a() }}",
    "{% include '/etc/passwd' %}", "{% import '/etc/passwd' as x %}{{ x }}", "{{ {'b': 1} }}",
    "{% import 'heap.in.j2' as x %}", "{% import '../pyproject.toml' as x %}", "{{ [1] * 9 }}",
    "{% macro f() %}{{ f() }}{% endmacro %}{{ f() }}", "{% set ns = namespace(b=1) %}",
    "{{ lipsum(n=99999) }}", "{{ cycler(1) }}", "{{ 'a' | attr('__class__') }}", "{{ _budget }}",
    "{{ 'x' * 10 ** 9 }}", "{{ '%1000000000d' % 1 }}", "{{ 9.0 ** 9 ** 9 ** 9 }}",
    "{{ range(10 ** 9) }}",
    "{% for b in range(9999) %}{% for c in range(9999) %}{% endfor %}{% endfor %}",
    "{% for b in range(10000) %}{{ range(10000) | sum }}{% endfor %}",
    "{{ seed | prime_seeds(1000000000) }}", "{{ range(10000) | map('center', 10 ** 6) | join }}",
    "{% set b = [1, 1] %}" + "{% set b = [b, b] %}" * 40 + "{{ b == b }}",
    "{{ " + "(" * 3000 + "1" + ")" * 3000 + " }}", "{% block b %}{% endblock %}", "{{ [a] }}",
    "{% import 'common.j2' as c with context %}{{ c.grains(10 ** 7) }}", "{{ none_such }}",
    "{% import 'common.j2' as c with context %}{{ c.model.__globals__ }}", "{{ 1 / 0 }}", "{{ a",
    '{{ 5.0 | round(1000000000, "ceil") }}', '{{ 5.0 | round(method="floor", precision=10**9) }}',
    '{{ [5.0] | map("round", 1000000000, "ceil") | list }}', "{{ 'f' * 3 }}", "{{ LONG | list }}",
    "{{ '11' | int(0, 3) }}", "{{ ['a'] | map(attribute='" + "0." * 9999 + "0') | list }}",
    "{{ ['a'] | sort(attribute='" + "0." * 9999 + "0') }}", "{{ [1] | sum('0', 1) }}",
    "{% set b = [" + "range(10000), " * 500 + "1] %}",
    "{% set b = [" + "LONG + 'x', " * 99 + "1] %}",
]  # fmt: skip


@pytest.mark.parametrize("text", REFUSED, ids=[text[:40] for text in REFUSED])
def test_what_could_reach_out_or_go_on_is_refused(text):
    started = time.monotonic()
    with pytest.raises(CaseError, match=r"own/script\.in\.j2"):
        rendered(text)
    assert time.monotonic() - started < LIMIT_S


@pytest.mark.parametrize(
    "part", ["{% set b = LONG in LONG ~ '' %}", "{% if LONG == LONG ~ '' %}{% endif %}",
             "{% set b = LONG | max %}", "{% set b = LONG | sort | first %}",
             "{% import 'common.j2' as c with context %}", "{% set b = 1.0 ** 2.0 %}"],
)  # fmt: skip
def test_the_clock_is_looked_at_by_whatever_takes_time(part, monkeypatch):
    """A line that takes a moment may be written ten thousand times."""
    monkeypatch.setattr(budget, "_LIMIT_S", -1.0)
    with pytest.raises(CaseError, match="takes longer than"):
        rendered(part)


def test_a_mistake_is_told_with_its_line():
    with pytest.raises(CaseError, match=r"own/script\.in\.j2:3: 'b' is undefined"):
        rendered("one\ntwo\n{{ b }}\n")
    with pytest.raises(CaseError, match=r"own/script\.in\.j2:2: no room"):
        rendered("one\n{% raise 'no room' %}\n")


PARTS = st.sampled_from(
    ["{{", "}}", "{%", "%}", " for b in ", " a ", "[", "]", "range(", ")", "'x'", "~", "*", "**9",
     "|join", "|map('number')", "endfor", " set b = ", ".", "("]
)  # fmt: skip


@given(st.lists(PARTS, max_size=12).map("".join))
def test_any_template_is_written_or_refused(text):
    with suppress(CaseError):  # any other exception fails
        assert isinstance(rendered(text), str)


LINES = [
    ("shell rm -rf x", "runs a program"),
    ("  shell rm x", "runs a program"),
    ("she&\nll rm x", "not allowed"),
    ("${a}${b} rm x", "not allowed"),
    ("$a rm x", "not allowed"),
    ('if "1 > 0" then "shell rm x"', "runs a program"),
    ("if \"1 > 0\" then 'print x' else 'shell rm x'", "runs a program"),
    ('run 10 every 5 "shell rm x"', "runs a program"),
    ('run 10 every 5 "shell\trm x"', "runs a program"),
    ("run 10 every 5 NULL shell", "runs a program"),
    ("units si & # goes on, one might think\nshell rm x", "runs a program"),
    ("units si &\u00a0\nshell rm x", "runs a program"),
    ('"shell" rm x', "runs a program"),
    ("include /etc/passwd", "one script"),
    ("jump SELF again", "may never end"),
    ("dump d all custom 10 /tmp/x id", "absolute path"),
    ('fix p all print 10 "x" file /tmp/x', "absolute path"),
    ('fix p all print 10 "x" file "/tmp/x"', "absolute path"),
    ("dump d all custom 10 ../x id", "may lead out"),
    ("dump d all custom 10 ~/x id", "absolute path"),
    ("variable a getenv HOME", "style 'getenv'"),
    ("variable a string .", "must begin with a letter or digit"),
    ('variable a string ""', "must begin with a letter or digit"),
    ("variable a string /etc", "absolute path"),
    ("variable a python f", "style 'python'"),
    ("dump d all custom 10 x;reboot;.gz id", "no place here"),
    ("dump d all custom 10 x.gz id", "start other programs"),
    ("dump d all movie 10 x.mp4 type type", "start other programs"),
    ("log other.txt", "proves that the run completed"),
    ("quit", "proves that the run completed"),
    ("read_restart x", "begins at step 0"),
    ("python f input 1", "not allowed"),
    ("no_such_command", "not allowed"),
]


@pytest.mark.parametrize(("line", "message"), LINES, ids=[line for line, _ in LINES])
def test_a_script_that_could_do_more_than_simulate_is_refused(line, message):
    with pytest.raises(CaseError, match=message) as refused:
        check_script(f"units si\n{line}\n", "own.in")
    assert str(refused.value).startswith("own.in:2" if "\nshell" not in line else "own.in:3")


@pytest.mark.parametrize(
    "line",
    [
        "# shell rm -rf /", 'print "half / whole; a | b"', "variable x equal v_a/v_b", "units si",
        'variable x equal "(v_a > 2) / 3"', "fix m all mesh/surface file meshes/a.stl type 1",
        'if "${x} > 1" then "print large" else "print small"', "label here", "run 10 upto",
    ],
)  # fmt: skip
def test_an_ordinary_line_is_taken(line):
    check_script(f"{line}\n", "own.in")
