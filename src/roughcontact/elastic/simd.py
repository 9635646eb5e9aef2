"""SIMD vectors for numba: sixteen numbers as one value in compiled functions.

The compiler does not vectorise a Fourier transform by itself, as it would have to prove that many
rows of numbers do not overlap. Supported are ``load``, ``store``, +, - and scaling.
"""

import operator
from typing import Any

from llvmlite import ir
from numba import types
from numba.extending import intrinsic, models, overload, register_model

#: Lanes of a vector; in single precision a vector fills a line of the processor's cache.
WIDTH = 16
#: Flags of floating-point operations: a product may be added without rounding (fused).
FUSED = ("contract",)


class Vector(types.Type):
    """numba type of :data:`WIDTH` numbers of a ``dtype``."""

    def __init__(self, dtype: types.Type):
        super().__init__(name=f"Vector({dtype})")
        self.dtype = dtype


@register_model(Vector)
class _VectorModel(models.PrimitiveModel):
    def __init__(self, dmm, fe_type):
        number = dmm.lookup(fe_type.dtype).get_value_type()
        super().__init__(dmm, fe_type, ir.VectorType(number, WIDTH))


def _pointer(context, builder, array_type, array, start, vector):
    data = context.make_array(array_type)(context, builder, array).data
    kind = context.get_value_type(vector)
    return builder.bitcast(builder.gep(data, [start]), kind.as_pointer())


@intrinsic
def load(typing_context: Any, array: Any, start: Any) -> Any:
    """SIMD vector of a flat contiguous array from ``start`` on; the array's end is not checked."""
    vector = Vector(array.dtype)

    def generate(context, builder, signature, args):
        pointer = _pointer(context, builder, array, *args, vector)
        return builder.load(pointer, align=array.dtype.bitwidth // 8)

    return vector(array, types.intp), generate


@intrinsic
def store(typing_context: Any, array: Any, start: Any, values: Any) -> Any:
    """Store a SIMD vector at ``start``; the array's end is not checked."""
    if not isinstance(values, Vector):
        return None

    def generate(context, builder, signature, args):
        pointer = _pointer(context, builder, array, *args[:2], values)
        builder.store(args[2], pointer, align=array.dtype.bitwidth // 8)
        return context.get_dummy_value()

    return types.void(array, types.intp, values), generate


def _elementwise(method):
    @intrinsic
    def operation(typing_context, first, second):
        def generate(context, builder, signature, args):
            return getattr(builder, method)(*args, flags=FUSED)

        return first(first, second), generate

    return operation


_add, _subtract, _multiply = map(_elementwise, ("fadd", "fsub", "fmul"))


@intrinsic
def _broadcast(typing_context, number, like):
    """SIMD vector with one number in every lane."""

    def generate(context, builder, signature, args):
        vector = context.get_value_type(like)
        alone = builder.insert_element(
            ir.Constant(vector, ir.Undefined), args[0], ir.Constant(ir.IntType(32), 0)
        )
        everywhere = ir.Constant(ir.VectorType(ir.IntType(32), WIDTH), [0] * WIDTH)
        return builder.shuffle_vector(alone, ir.Constant(vector, ir.Undefined), everywhere)

    return like(like.dtype, like), generate


@overload(operator.add)
def _vector_add(first, second):
    if isinstance(first, Vector) and first == second:
        return lambda first, second: _add(first, second)


@overload(operator.sub)
def _vector_subtract(first, second):
    if isinstance(first, Vector) and first == second:
        return lambda first, second: _subtract(first, second)


@overload(operator.mul)
def _vector_multiply(first, second):
    if isinstance(first, Vector) and first == second:
        return lambda first, second: _multiply(first, second)
    if isinstance(second, Vector) and isinstance(first, types.Float):
        return lambda first, second: _multiply(_broadcast(first, second), second)


@intrinsic
def transpose(
    typing_context: Any,
    source: Any,
    first: Any,
    source_step: Any,
    target: Any,
    start: Any,
    target_step: Any,
) -> Any:
    """Transpose a square of :data:`WIDTH` x WIDTH numbers; ``step`` is the distance of rows."""
    vector = Vector(source.dtype)

    def generate(context, builder, signature, args):
        from_array, first, from_step, to_array, start, to_step = args
        align = source.dtype.bitwidth // 8

        def row(start, step, k):
            return builder.add(start, builder.mul(step, ir.Constant(step.type, k)))

        rows = []
        for k in range(WIDTH):
            position = row(first, from_step, k)
            pointer = _pointer(context, builder, source, from_array, position, vector)
            rows.append(builder.load(pointer, align=align))
        # Each round interleaves rows half a square apart; log2(WIDTH) rounds transpose it.
        picked = [place for k in range(WIDTH) for place in (k, k + WIDTH)]
        halves = [
            ir.Constant(ir.VectorType(ir.IntType(32), WIDTH), half)
            for half in (picked[:WIDTH], picked[WIDTH:])
        ]
        for _ in range(WIDTH.bit_length() - 1):
            pairs = zip(rows[: WIDTH // 2], rows[WIDTH // 2 :], strict=True)
            rows = [builder.shuffle_vector(a, b, half) for a, b in pairs for half in halves]
        for k in range(WIDTH):
            position = row(start, to_step, k)
            pointer = _pointer(context, builder, target, to_array, position, vector)
            builder.store(rows[k], pointer, align=align)
        return context.get_dummy_value()

    arguments = source, types.intp, types.intp, target, types.intp, types.intp
    return types.void(*arguments), generate
