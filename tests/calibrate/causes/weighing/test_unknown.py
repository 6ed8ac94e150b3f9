"""What is in no library: where it can be."""

from __future__ import annotations

from types import SimpleNamespace

from calibrate.causes.weighing.unknown import EVERYWHERE, slabs_of


def _problem(*places: tuple[str, str, tuple[str, ...]]) -> SimpleNamespace:
    return SimpleNamespace(
        places=[
            SimpleNamespace(
                name=name, experiment=experiment, readings=[SimpleNamespace(name=r) for r in names]
            )
            for name, experiment, names in places
        ]
    )


def test_an_experiment_on_several_walls_can_be_wrong_as_a_whole():
    problem = _problem(
        ("heap of A on steel", "heap", ("angle_steel",)),
        ("heap of A on glued", "heap", ("angle_glued",)),
        ("impact of A on steel", "impact", ("m1", "m2")),
    )
    assert {one.name: one.readings for one in slabs_of(problem)} == {
        "unknown at angle_steel": (0,),
        "unknown at angle_glued": (1,),
        "unknown at m1": (2,),
        "unknown at m2": (3,),
        "unknown in heap": (0, 1),
        "unknown in impact of A on steel": (2, 3),
        EVERYWHERE: (0, 1, 2, 3),
    }


def test_the_same_readings_are_told_once():
    one = _problem(("heap of A on steel", "heap", ("angle",)))
    assert [slab.name for slab in slabs_of(one)] == ["unknown at angle"]
    two = _problem(("heap of A on steel", "heap", ("a",)), ("heap of A on glued", "heap", ("b",)))
    assert [slab.readings for slab in slabs_of(two)] == [(0,), (1,), (0, 1)]
