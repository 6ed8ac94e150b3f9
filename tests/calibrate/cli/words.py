"""Words of command lines that several tests use."""

from __future__ import annotations

PARAMETERS = (
    "mu_pp=0.69", "mu_roll_pp=0.09", "mu_pw=0.31", "mu_roll_pw=0.27", "e_pp=0.74", "e_pw=0.44",
)  # fmt: skip
PAIRS = [word for pair in PARAMETERS for word in ("-p", pair)]
SMALL = [
    word
    for pair in ("pour_grains=60", "pour_tau=12", "settle_tau=6", "pour_stages=2")
    for word in ("-a", pair)
]
"""A heap that runs in about a second."""
