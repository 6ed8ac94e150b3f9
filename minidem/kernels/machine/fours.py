"""Four numbers at once: between rows of tables and the fields of a block, as vectors of LLVM."""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba.core import types
from numba.extending import intrinsic

__all__ = ["add_four", "add_two", "collect", "put_four", "spread", "word"]

FOUR = 4  # numbers that are moved at once


def word(context: Any, builder: Any, kind: Any, words: Any, at: Any) -> Any:
    """Return the address of a word of an array."""
    return builder.gep(context.make_array(kind)(context, builder, words).data, [at])


def _field(context: Any, builder: Any, kind: Any, numbers: Any, at: Any) -> Any:
    """Return the address of four numbers of an array as that of a vector."""
    start = builder.gep(context.make_array(kind)(context, builder, numbers).data, [at])
    return builder.bitcast(start, ir.VectorType(ir.DoubleType(), FOUR).as_pointer())


def _cells(context: Any, builder: Any, kind: Any, table: Any, place: Any, count: int) -> Any:
    """Return the address of neighbouring numbers of a table as that of a vector."""
    found = context.make_array(kind)(context, builder, table)
    wide = builder.extract_value(found.shape, 1)
    at = builder.add(builder.mul(place[0], wide), place[1])
    start = builder.gep(found.data, [at])
    return builder.bitcast(start, ir.VectorType(ir.DoubleType(), count).as_pointer())


def _load(builder: Any, place: Any) -> Any:
    return builder.load(place, align=8)


def _mix(builder: Any, one: Any, other: Any, *lanes: int) -> Any:
    """Return some numbers of two vectors."""
    mask = ir.Constant(ir.VectorType(ir.IntType(32), len(lanes)), list(lanes))
    return builder.shuffle_vector(one, other, mask)


def _turned(builder: Any, halves: Any) -> Any:
    """Return the columns of four rows, of which two vectors of two are given each."""
    found: list[Any] = []
    for half in range(2):
        even = _mix(builder, halves[0][half], halves[2][half], 0, 1, 2, 3)
        odd = _mix(builder, halves[1][half], halves[3][half], 0, 1, 2, 3)
        found.append(_mix(builder, even, odd, 0, 4, 2, 6))
        found.append(_mix(builder, even, odd, 1, 5, 3, 7))
    return found


@intrinsic
def spread(
    context: Any, table: Any, column: Any, rows: Any, c: Any, block: Any, first: Any, size: Any
) -> Any:
    """Write four columns of four rows into four fields of a block."""
    del context

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        kinds = signature.args
        halves = []
        for k in range(FOUR):
            at = builder.add(args[3], ir.Constant(args[3].type, k))
            row = builder.load(word(context, builder, kinds[2], args[2], at))
            halves.append([
                _load(builder, _cells(
                    context, builder, kinds[0], args[0],
                    (row, builder.add(args[1], ir.Constant(args[1].type, 2 * half))), 2,
                ))
                for half in range(2)
            ])  # fmt: skip
        at = builder.add(args[5], args[3])
        for field in _turned(builder, halves):
            builder.store(field, _field(context, builder, kinds[4], args[4], at), align=8)
            at = builder.add(at, args[6])
        return context.get_dummy_value()

    whole = types.int64
    return types.none(table, whole, rows, whole, block, whole, whole), generate


@intrinsic
def collect(context: Any, block: Any, first: Any, size: Any, c: Any, lines: Any, place: Any) -> Any:
    """Write four numbers of four fields of a block behind each other, contact after contact."""
    del context

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        kinds = signature.args
        halves = []
        at = builder.add(args[1], args[3])
        for _ in range(FOUR):
            start = _field(context, builder, kinds[0], args[0], at)
            two = builder.bitcast(start, ir.VectorType(ir.DoubleType(), 2).as_pointer())
            one = ir.Constant(ir.IntType(64), 1)
            halves.append([_load(builder, two), _load(builder, builder.gep(two, [one]))])
            at = builder.add(at, args[2])
        at = args[5]
        for line in _turned(builder, halves):
            builder.store(line, _field(context, builder, kinds[4], args[4], at), align=8)
            at = builder.add(at, ir.Constant(at.type, FOUR))
        return context.get_dummy_value()

    whole = types.int64
    return types.none(block, whole, whole, whole, lines, whole), generate


def _onto(name: str, count: int, *, adds: bool) -> Any:
    """Return a function that puts or adds neighbouring numbers of a line to a row of a table."""

    def onto(context: Any, table: Any, row: Any, column: Any, line: Any, at: Any) -> Any:
        del context

        def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
            kinds = signature.args
            place = _cells(context, builder, kinds[0], args[0], (args[1], args[2]), count)
            start = builder.gep(
                context.make_array(kinds[3])(context, builder, args[3]).data, [args[4]]
            )
            numbers = _load(builder, builder.bitcast(start, place.type))
            if adds:
                numbers = builder.fadd(_load(builder, place), numbers)
            builder.store(numbers, place, align=8)
            return context.get_dummy_value()

        return types.none(table, types.int64, types.int64, line, types.int64), generate

    onto.__name__ = name
    return intrinsic(onto)


add_four = _onto("add_four", 4, adds=True)
add_two = _onto("add_two", 2, adds=True)
put_four = _onto("put_four", 4, adds=False)
