"""A change of the public interface is a decision; this test makes it one."""

from __future__ import annotations

from tests.house.public_api import FROZEN, MODULES, lines


def test_public_interface_is_the_frozen_one():
    frozen = FROZEN.read_text(encoding="utf-8").splitlines()
    assert lines() == frozen, "on purpose? then: python -m tests.house.public_api --write"


def test_every_public_module_is_in_the_list():
    listed = {line.split("(")[0].split(":")[0] for line in lines()}
    assert all(any(name.startswith(module + ".") for name in listed) for module in MODULES)
