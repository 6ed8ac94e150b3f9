"""What kernels need of the machine and Python has not: arrays on the stack, addresses."""

from __future__ import annotations

from typing import Any

import numpy as np
from llvmlite import ir
from numba.core import cgutils as _cgutils
from numba.core import types
from numba.extending import intrinsic
from numba.np import arrayobj as _arrayobj

from minidem.kernels.machine.fours import add_four, add_two, collect, put_four, spread, word

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


@intrinsic
def claim(context: Any, words: Any, at: Any, old: Any, new: Any) -> Any:
    """Compare and exchange a word."""
    del context

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        place = word(context, builder, signature.args[0], args[0], args[1])
        found = builder.cmpxchg(place, args[2], args[3], "acq_rel", "acquire")
        return builder.extract_value(found, 1)

    return types.boolean(words, types.int64, types.int64, types.int64), generate


@intrinsic
def publish(context: Any, words: Any, at: Any, value: Any) -> Any:
    """Store a word and release what was written before."""
    del context

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        place = word(context, builder, signature.args[0], args[0], args[1])
        builder.store_atomic(args[2], place, "release", 8)
        return context.get_dummy_value()

    return types.none(words, types.int64, types.int64), generate


@intrinsic
def look(context: Any, words: Any, at: Any) -> Any:
    """Load a word and acquire what was released with it."""
    del context

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        place = word(context, builder, signature.args[0], args[0], args[1])
        return builder.load_atomic(place, "acquire", 8)

    return types.int64(words, types.int64), generate


@intrinsic
def give_way(context: Any) -> Any:
    """Call sched_yield of the C library."""
    del context

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        del signature, args
        kind = ir.FunctionType(ir.IntType(32), [])
        builder.call(cgutils.get_or_insert_function(builder.module, kind, "sched_yield"), [])
        return context.get_dummy_value()

    return types.none(), generate


@intrinsic
def fetch(context: Any, table: Any, row: Any) -> Any:
    """Ask the processor for the first cache line of a row of a table."""
    del context

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        found = context.make_array(signature.args[0])(context, builder, args[0])
        wide = builder.extract_value(found.strides, 0)
        byte = ir.IntType(8).as_pointer()
        start = builder.bitcast(found.data, byte)
        place = builder.gep(start, [builder.mul(args[1], wide)])
        word = ir.IntType(32)
        kind = ir.FunctionType(ir.VoidType(), [byte, word, word, word])
        call = cgutils.get_or_insert_function(builder.module, kind, "llvm.prefetch.p0")
        builder.call(call, [place, word(0), word(3), word(1)])
        return context.get_dummy_value()

    return types.none(table, types.int64), generate


@intrinsic(prefer_literal=True)
def columns(context: Any, table: Any, count: Any) -> Any:
    """Return a table with its row length as a constant, so that addresses need no product."""
    del context
    if not isinstance(count, types.IntegerLiteral):
        return None
    wide = count.literal_value

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        kind = signature.args[0]
        given = context.make_array(kind)(context, builder, args[0])
        bits = context.get_abi_sizeof(context.get_data_type(kind.dtype))
        found = context.make_array(kind)(context, builder)
        whole = [context.get_constant(types.intp, size) for size in (wide, wide * bits, bits)]
        arrayobj.populate_array(
            found, data=given.data, meminfo=given.meminfo, itemsize=whole[2],
            shape=[builder.extract_value(given.shape, 0), whole[0]], strides=whole[1:],
        )  # fmt: skip
        return found._getvalue()

    return table(table, count), generate


REPLACED = {
    "add_four": add_four,
    "add_two": add_two,
    "claim": claim,
    "collect": collect,
    "columns": columns,
    "fetch": fetch,
    "give_way": give_way,
    "indices": indices,
    "look": look,
    "matrix": matrix,
    "publish": publish,
    "put_four": put_four,
    "spread": spread,
    "vector": vector,
}
"""What kernels use instead of the functions of these names in `minidem.kernels.machine.space`."""
