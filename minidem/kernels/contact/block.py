"""Blocks of contacts that are worked on together, field after field.

A block is one vector: a field takes `BLOCK` numbers of it, one per contact. The law then runs over
neighbouring numbers, several contacts at a time where the machine can.
"""

from __future__ import annotations

from typing import Any

from minidem.kernels.columns import (  # isort: skip
    SX, SY, SZ, MX, MY, MZ,
)  # fmt: skip
from minidem.kernels.models import (  # isort: skip
    YOUNG, SHEAR, DAMPING, FRICTION, ROLLING_FRICTION, COHESION_ENERGY, ROLLING_DAMPING,
    LOG_RESTITUTION, CHARACTERISTIC_SPEED,
)  # fmt: skip
from minidem.kernels.contact.records import Material, Memory
from minidem.kernels.machine.cache import COMPILED
from minidem.kernels.machine.jit import inlined

__all__ = ["BLOCK", "FOUR", "LANES", "material_of", "memory_of", "store_memory"]

BLOCK = 32
"""Contacts worked on together; their data then fit into the nearest cache."""
FOUR = 4
"""Contacts whose rows are turned into fields at once."""
LANES = 8 if COMPILED else 1
"""The law runs over a multiple of so many places, so that no contact is left for a loop that takes
one at a time; places without a contact hold numbers, and what comes out there is not looked at."""


@inlined
def material_of(b: Any, first: int, c: int) -> Any:
    """Return the `Material` of contact c, from fields in the order of coefficients."""
    return Material(
        b[first + YOUNG * BLOCK + c], b[first + SHEAR * BLOCK + c],
        b[first + DAMPING * BLOCK + c], b[first + FRICTION * BLOCK + c],
        b[first + ROLLING_FRICTION * BLOCK + c], b[first + COHESION_ENERGY * BLOCK + c],
        b[first + ROLLING_DAMPING * BLOCK + c], b[first + LOG_RESTITUTION * BLOCK + c],
        b[first + CHARACTERISTIC_SPEED * BLOCK + c],
    )  # fmt: skip


@inlined
def memory_of(b: Any, first: int, c: int) -> Any:
    """Return the `Memory` of contact c, from fields in the order of histories."""
    return Memory(
        b[first + SX * BLOCK + c], b[first + SY * BLOCK + c], b[first + SZ * BLOCK + c],
        b[first + MX * BLOCK + c], b[first + MY * BLOCK + c], b[first + MZ * BLOCK + c],
    )  # fmt: skip


@inlined
def store_memory(b: Any, first: int, c: int, memory: Any) -> None:
    """Write the `Memory` of contact c."""
    b[first + SX * BLOCK + c] = memory.sx
    b[first + SY * BLOCK + c] = memory.sy
    b[first + SZ * BLOCK + c] = memory.sz
    b[first + MX * BLOCK + c] = memory.mx
    b[first + MY * BLOCK + c] = memory.my
    b[first + MZ * BLOCK + c] = memory.mz
