"""A study of two materials on two walls, in words that several tests change."""

from __future__ import annotations

TWO = """
name = "two"
title = "Two materials, two walls"

[[material]]
name = "coarse"
d32_um = 1500.0
density_kg_m3 = 2500.0
flow_flat_g_s = 20.0

[[material]]
name = "fine"
d32_um = 800.0
density_kg_m3 = 2500.0
flow_flat_g_s = 22.0

[[surface]]
name = "steel"

[[surface]]
name = "brass"
"""


def target(material: str, surface: str, experiment: str, observable: str, unit: str) -> str:
    return f"""
[[target]]
name = "{experiment}_{material}_{surface}"
material = "{material}"
surface = "{surface}"
experiment = "{experiment}"
observable = "{observable}"
unit = "{unit}"
value = 10.0
se = 0.1
"""


TARGETS = "".join(
    target(material, surface, *what)
    for material, surface in (("coarse", "steel"), ("coarse", "brass"), ("fine", "steel"))
    for what in (("heap", "angle_deg", "deg"), ("conveyor", "t100_s", "s"))
)
FREE = "".join(
    f"\n[parameter.{name}]\nrange = [0.1, 0.8]\n"
    for name in ("mu_pp", "mu_roll_pp", "mu_pw", "mu_roll_pw", "e_pp", "e_pw")
)
