"""What kernels need of the machine and Python has not: arrays on the stack, addresses."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba.core import cgutils as _cgutils
from numba.core import types
from numba.extending import intrinsic
from numba.np import arrayobj as _arrayobj

__all__ = ["REPLACED", "pointer"]

cgutils: Any = _cgutils  # Numba's own annotations know only its public part
arrayobj: Any = _arrayobj


@intrinsic
def pointer(context: Any, address: Any) -> Any:
    """Return an address as a pointer."""
    del context, address

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        del context, signature
        return builder.inttoptr(args[0], cgutils.voidptr_t)

    return types.voidptr(types.int64), generate


def _working_space(item: Any, name: str, dimensions: int) -> Any:
    """Return a function for kernels that gives an array on the stack; its sizes are constants."""

    def typed(context: Any, *sizes: Any) -> Any:
        del context
        if not all(isinstance(size, types.IntegerLiteral) for size in sizes):
            return None
        shape = [size.literal_value for size in sizes]
        kind = types.Array(item, dimensions, "C")
        count = int(np.prod(shape))

        def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
            del signature, args
            number = context.get_data_type(item)
            bits = context.get_abi_sizeof(number)
            found = context.make_array(kind)(context, builder)
            whole = [context.get_constant(types.intp, size) for size in shape]
            steps = [context.get_constant(types.intp, bits * int(np.prod(shape[d + 1 :])))
                     for d in range(dimensions)]  # fmt: skip
            arrayobj.populate_array(
                found, data=cgutils.alloca_once(builder, number, size=count), shape=whole,
                strides=steps, itemsize=context.get_constant(types.intp, bits), meminfo=None,
            )  # fmt: skip
            return found._getvalue()

        return kind(*sizes), generate

    if dimensions == 1:

        def one(context: Any, count: Any) -> Any:
            return typed(context, count)
    else:

        def one(context: Any, rows: Any, columns: Any) -> Any:  # type: ignore[misc]
            return typed(context, rows, columns)

    one.__name__ = name
    return intrinsic(prefer_literal=True)(one)


vector = _working_space(types.float64, "vector", 1)
matrix = _working_space(types.float64, "matrix", 2)
indices = _working_space(types.uint64, "indices", 1)
REPLACED = {"vector": vector, "matrix": matrix, "indices": indices}
"""What kernels use instead of the functions of these names in `minidem.kernels.jit`."""
