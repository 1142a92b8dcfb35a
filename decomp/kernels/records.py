"""Records: arrays and numbers that kernels get by their address.

Numba passes tuples of arrays by value. A model's tables hold some fifty arrays, so that every call
from kernel to kernel would pass hundreds of values, and most of the compiler's time would go into
packing and unpacking them. A kernel gets a `Record` as one address of a row of words and reads from
there what it names: `sites.kinds` is the same code as with a tuple.

The row holds 8 bytes for an integer or a float, and for an array its address and its shape. Tuples
with names and records inside a record are laid out in it in place, so they too are addresses.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
from llvmlite import ir
from numba import typeof, types
from numba.core import cgutils
from numba.core.typing.templates import AttributeTemplate, infer_getattr
from numba.extending import (
    NativeValue,
    lower_getattr_generic,
    models,
    register_model,
    unbox,
)
from numba.np.arrayobj import populate_array
from numpy.typing import NDArray

from decomp.vectors import Ints

WORD = ir.IntType(64)
BYTES = 8


class Record:
    """Base of frozen dataclasses that kernels get by their address.

    Fields are C-contiguous arrays, integers, floats, named tuples and records. Kernels can read
    fields and fill the arrays; they cannot make records.
    """

    @cached_property
    def _numba_type_(self) -> RecordType:
        return _type_of_fields(self)

    @cached_property
    def _words(self) -> Ints:
        return np.array(_words_of_fields(self), dtype=np.int64)

    @cached_property
    def address(self) -> int:
        """Where the row of words is."""
        return self._words.ctypes.data

    def __getstate__(self) -> dict[str, Any]:
        """The fields alone: a copy's arrays lie elsewhere."""
        return {name: self.__dict__[name] for name in _fields(self)}


class RecordType(types.Type):  # type: ignore[misc]
    """What numba knows of a record.

    Args:
        name: of the record's class.
        fields: the types of its fields, by their names.
    """

    def __init__(self, name: str, fields: dict[str, types.Type]) -> None:
        self.fields = fields
        self.offsets: dict[str, int] = {}
        self.length = 0
        for field, kind in fields.items():
            self.offsets[field] = self.length
            if isinstance(kind, RecordType):
                self.length += kind.length
            else:
                self.length += 1 + kind.ndim if isinstance(kind, types.Array) else 1
        super().__init__(f"{name}({', '.join(f'{k}: {v}' for k, v in fields.items())})")


def _fields(value: Any) -> tuple[str, ...]:
    """Names of the fields of a record or named tuple, none for anything else."""
    if isinstance(value, Record):
        return tuple(value.__dataclass_fields__)  # type: ignore[attr-defined]
    return tuple(getattr(value, "_fields", ()))


def _type_of_fields(value: Any) -> RecordType:
    kinds = {name: _type_of(getattr(value, name)) for name in _fields(value)}
    return RecordType(type(value).__name__, kinds)


def _type_of(value: Any) -> types.Type:
    if isinstance(value, Record):
        return value._numba_type_  # most records are made of some that were seen before
    if _fields(value):
        return _type_of_fields(value)
    kind = _array_type(value) if isinstance(value, np.ndarray) else typeof(value)
    if isinstance(kind, types.Array):
        if kind.layout != "C":
            raise TypeError("the arrays of a record must be C-contiguous")
    elif kind not in (types.int64, types.float64):
        raise TypeError(f"a record cannot hold {kind}")
    return kind


_array_types: dict[tuple[Any, ...], types.Type] = {}


def _array_type(array: NDArray[Any]) -> types.Type:
    """What `typeof` says, which is asked once for all arrays alike."""
    flags = array.flags
    alike = (array.dtype, array.ndim, flags.c_contiguous, flags.writeable, flags.aligned)
    if alike not in _array_types:
        _array_types[alike] = typeof(array)
    return _array_types[alike]


def _words_of_fields(value: Any) -> list[int]:
    return [word for name in _fields(value) for word in _words_of(getattr(value, name))]


def _words_of(value: Any) -> list[int]:
    if isinstance(value, Record):
        return list(value._words.tolist())
    if _fields(value):
        return _words_of_fields(value)
    if isinstance(value, np.ndarray):
        return [value.ctypes.data, *value.shape]
    return [int(np.array(value).view(np.int64))]


@register_model(RecordType)
class _Address(models.PrimitiveModel):  # type: ignore[misc]
    def __init__(self, manager: Any, kind: RecordType) -> None:
        super().__init__(manager, kind, WORD.as_pointer())


@unbox(RecordType)  # type: ignore[untyped-decorator]
def _address_of(kind: RecordType, value: Any, c: Any) -> NativeValue:
    # the address is had by Python code, in which a signal may raise an error: then there is none
    number = c.pyapi.object_getattr_string(value, "address")
    address = cgutils.alloca_once_value(c.builder, ir.Constant(cgutils.voidptr_t, None))
    with cgutils.if_likely(c.builder, cgutils.is_not_null(c.builder, number)):
        c.builder.store(c.pyapi.long_as_voidptr(number), address)
        c.pyapi.decref(number)
    return NativeValue(
        c.builder.bitcast(c.builder.load(address), WORD.as_pointer()),
        is_error=c.pyapi.c_api_error(),
    )


@infer_getattr
class _Fields(AttributeTemplate):  # type: ignore[misc]
    key = RecordType

    def generic_resolve(self, kind: RecordType, name: str) -> types.Type | None:
        return kind.fields.get(name)


@lower_getattr_generic(RecordType)  # type: ignore[untyped-decorator]
def _read(context: Any, builder: Any, kind: RecordType, address: Any, name: str) -> Any:
    field, first = kind.fields[name], kind.offsets[name]

    def word(offset: int, what: ir.Type) -> Any:
        place = builder.gep(address, [ir.Constant(WORD, offset)])
        loaded = builder.load(builder.bitcast(place, what.as_pointer()))
        # nothing changes a row while a kernel runs, so what was read need not be read again
        loaded.set_metadata("invariant.load", builder.module.add_metadata([]))
        return loaded

    if isinstance(field, RecordType):
        return builder.gep(address, [ir.Constant(WORD, first)])
    if not isinstance(field, types.Array):
        return word(first, context.get_value_type(field))
    size = context.get_abi_sizeof(context.get_data_type(field.dtype))
    shape = [word(first + 1 + axis, WORD) for axis in range(field.ndim)]
    strides = [ir.Constant(WORD, size)]
    for extent in reversed(shape[1:]):
        strides.insert(0, builder.mul(strides[0], extent))
    array = context.make_array(field)(context, builder)
    populate_array(
        array,
        data=word(first, context.get_data_type(field.dtype).as_pointer()),
        shape=shape,
        strides=strides,
        itemsize=ir.Constant(WORD, size),
        meminfo=None,
    )
    return array._getvalue()
