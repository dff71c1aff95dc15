"""Generated deserialisation: CDR → message, either byte order.

Lengths in the data are compared with the remaining bytes before any allocation.
"""

import sys
from array import array
from collections.abc import Callable
from typing import Any, Literal

import numpy as np

from navette.errors import DecodeError
from navette.msgs.base import Message
from navette.msgs.cdr.elements import UNPACK, WIDE_UNIT, decode_wide
from navette.msgs.cdr.layout import (
    CODES,
    PHASES,
    Leaf,
    Run,
    item_size,
    leaf_run,
    uniform_leaves,
)
from navette.msgs.classes import get_message_class
from navette.msgs.interface import PLACEHOLDER, Field, FieldType, MessageSpec
from navette.msgs.registry import get_message_spec
from navette.msgs.values import DTYPES, TYPECODES

HEADER_SIZE = 4
NATIVE_ORDER = "<" if sys.byteorder == "little" else ">"

Order = Literal["<", ">"]
Reader = Callable[[bytes | memoryview, int, int], tuple[Any, int]]

_element_readers: dict[tuple[str, Order], Reader] = {}


def make_reader(cls: type[Message], order: Order) -> Reader:
    """Return a function (data, HEADER_SIZE, length) → (message, offset of its end).

    The function raises DecodeError, struct.error or ValueError.
    """
    return _make(cls, order, phase=HEADER_SIZE % PHASES)


def _element_reader(cls: type[Message], order: Order) -> Reader:
    key = (cls._type_name_, order)
    if key not in _element_readers:
        _element_readers[key] = _make(cls, order, phase=None)
    return _element_readers[key]


def _make(cls: type[Message], order: Order, phase: int | None) -> Reader:
    emitter = _Emitter(order, phase)
    result = emitter.message(cls._spec_, cls)
    emitter.finish_run()
    lines = ["def read(b, p, end):", *emitter.lines, *emitter.builders]
    lines.append(f" return {result}, p")
    source = "\n".join(lines)
    exec(compile(source, f"<deserialize {cls._type_name_}>", "exec"), emitter.scope)
    reader: Reader = emitter.scope["read"]
    return reader


def _refuse_bool(field: str, value: int) -> None:
    raise DecodeError(f"{field}: {value} is not a bool (0 or 1)")


def _refuse_length(field: str, length: int) -> None:
    raise DecodeError(f"{field}: length {length} exceeds the field's bound or the data")


def _read_string(field: str, b: bytes | memoryview, p: int, end: int) -> str:
    """Decode the string in ``b[p:end]``, empty or with its terminating zero."""
    if p == end:
        return ""
    if b[end - 1]:
        raise DecodeError(f"{field}: string without terminating zero")
    return str(b[p : end - 1], "utf-8")


class _Emitter:
    """Source lines of one function and the objects they refer to.

    Values are read into variables first; ``builders`` then make the messages. ``p`` is
    the offset in the data, header included; ``phase`` is ``p`` modulo 8, or None if
    unknown. Alignment is relative to the end of the header, four bytes further.
    """

    def __init__(self, order: Order, phase: int | None) -> None:
        self.lines: list[str] = []
        self.builders: list[str] = []
        self.scope: dict[str, Any] = {
            "new": object.__new__,
            "array": array,
            "frombuffer": np.frombuffer,
            "refuse_bool": _refuse_bool,
            "refuse_length": _refuse_length,
            "read_string": _read_string,
            "decode_wide": decode_wide,
        }
        self._order = order
        self._phase = phase
        self._run = Run()
        self._after_run: list[str] = []
        self._count = 0

    def message(self, spec: MessageSpec, cls: type[Message]) -> str:
        """Emit all fields; return the variable of the message."""
        name = self._new_name("m")
        self.scope[f"C{name}"] = cls
        stores = []
        for field in spec.wire_fields:
            if field.name == PLACEHOLDER:
                self._run.add(1, "B", 1, "_")
                continue
            path = f"{spec.name}.{field.name}"
            if field.type.is_scalar:
                value = self._scalar(field, path)
            elif field.type.container == "array":
                value = self._array(field, path)
            else:
                value = self._sequence(field, path)
            stores.append(f" {name}._{field.name} = {value}")
        self.builders += [f" {name} = new(C{name})", *stores]
        return name

    def _scalar(self, field: Field, path: str) -> str:
        type_ = field.type
        if type_.is_message:
            nested = get_message_spec(type_.base)
            return self.message(nested, get_message_class(type_.base))
        if type_.is_string:
            return self._string(type_, path)
        value = self._new_name("v")
        code, size = CODES[type_.base]
        self._run.add(size, code, size, value)
        if type_.base == "bool":
            self._after_run.append(f" if {value} > 1: refuse_bool({path!r}, {value})")
            return f"{value} == 1"
        return value

    def _string(self, type_: FieldType, path: str) -> str:
        length, value = self._new_name("n"), self._new_name("s")
        self._run.add(4, "I", 4, length)
        self.finish_run()
        self.lines += self._string_lines(type_, path, length, value, " ")
        self._phase = None
        return value

    def _string_lines(
        self, type_: FieldType, path: str, length: str, value: str, indent: str
    ) -> list[str]:
        if type_.base == "wstring":
            text = f"decode_wide(b[p:p + {length} * {WIDE_UNIT}], {self._order!r})"
            advance = f"{length} * {WIDE_UNIT}"
        else:
            text = f"read_string({path!r}, b, p, p + {length})"
            advance = length
        lines = [
            f"if {advance} > end - p: refuse_length({path!r}, {length})",
            f"{value} = {text}",
            f"p += {advance}",
        ]
        bound = type_.string_bound
        if bound is not None:
            lines.append(
                f"if len({value}) > {bound}: refuse_length({path!r}, len({value}))"
            )
        return [indent + line for line in lines]

    def _array(self, field: Field, path: str) -> str:
        type_ = field.type
        if not type_.is_numeric and type_.base not in UNPACK:
            self.finish_run()
            return self._loop(type_, path, str(type_.size))
        _, size = CODES[type_.base]
        total = size * (type_.size or 0)
        raw = self._new_name("v")
        self._run.add(size, f"{total}s", total, raw)
        if type_.base in UNPACK:
            return self._octets(type_, path, raw)
        # astype makes a writable copy in native byte order.
        dtype, name = DTYPES[type_.base], f"D{type_.base}"
        self.scope[name] = dtype.newbyteorder(self._order)
        self.scope[f"N{name}"] = dtype
        return f"frombuffer({raw}, {name}).astype(N{name})"

    def _octets(self, type_: FieldType, path: str, raw: str) -> str:
        self.scope[f"unpack_{type_.base}"] = UNPACK[type_.base]
        return f"unpack_{type_.base}({path!r}, {raw})"

    def _sequence(self, field: Field, path: str) -> str:
        type_ = field.type
        length = self._new_name("n")
        self._run.add(4, "I", 4, length)
        self.finish_run()
        size = item_size(type_)
        if type_.is_numeric and size == PHASES:
            # p includes the header: multiples of 8 after the header are 4 more.
            self.lines.append(f" if {length} and not p & 4: p += 4")
        limit = f"{length} * {size} > end - p"
        if type_.size is not None:
            limit += f" or {length} > {type_.size}"
        self.lines.append(f" if {limit}: refuse_length({path!r}, {length})")
        if type_.is_numeric:
            return self._numeric_sequence(type_, length, size)
        if type_.base in UNPACK:
            value = self._new_name("a")
            octets = self._octets(type_, path, f"b[p:p + {length}]")
            self.lines += [f" {value} = {octets}", f" p += {length}"]
            self._phase = None
            return value
        return self._loop(type_, path, length)

    def _numeric_sequence(self, type_: FieldType, length: str, size: int) -> str:
        """Emit one copy from the data into an array, through a memoryview."""
        value = self._new_name("a")
        self.lines += [
            f" {value} = array({TYPECODES[type_.base]!r})",
            f" q = p + {length} * {size}",
            f" {value}.frombytes(memoryview(b)[p:q])",
            " p = q",
        ]
        if self._order != NATIVE_ORDER and size > 1:
            self.lines.append(f" {value}.byteswap()")
        self._phase = None
        return value

    def _loop(self, type_: FieldType, path: str, length: str) -> str:
        items = self._new_name("a")
        leaves = (
            uniform_leaves(get_message_spec(type_.base)) if type_.is_message else None
        )
        if leaves is not None:
            self._uniform_loop(type_.base, leaves, items, length)
            return items
        self.lines += [f" {items} = []", f" for _ in range({length}):"]
        if type_.is_message:
            reader = self._new_name("R")
            element = get_message_class(type_.base)
            self.scope[reader] = _element_reader(element, self._order)
            self.lines.append(f"  e, p = {reader}(b, p, end)")
        else:
            run = Run()
            run.add(4, "I", 4, "n")
            unpack = self._new_name("U")
            (packer, _) = run.table(self._order)[0]
            self.scope[unpack] = packer.unpack_from
            self.lines += ["  p += -p & 3", f"  n, = {unpack}(b, p)", "  p += 4"]
            self.lines += self._string_lines(type_, path, "n", "e", "  ")
        self.lines.append(f"  {items}.append(e)")
        self._phase = None
        return items

    def _uniform_loop(
        self, name: str, leaves: list[Leaf], items: str, length: str
    ) -> None:
        """Emit one iter_unpack over all elements, without a Python call for each."""
        run = leaf_run(leaves)
        ((packer, size), *_) = run.table(self._order)
        unpack = self._new_name("U")
        self.scope[unpack] = packer.iter_unpack
        variables = {leaf.path: f"e{index}" for index, leaf in enumerate(leaves)}
        if run.alignment > 1:
            shift = HEADER_SIZE % run.alignment
            self.lines.append(f" if {length}: p += {shift} - p & {run.alignment - 1}")
        self.lines += [
            f" q = p + {length} * {size}",
            f" if q > end: refuse_length({name!r}, {length})",
            f" {items} = []",
            f" for {', '.join(variables.values())}, in {unpack}(b[p:q]):",
        ]
        result = self._build(name, variables, ())
        self.lines += [f"  {items}.append({result})", " p = q"]
        self._phase = None

    def _build(
        self, name: str, variables: dict[tuple[str, ...], str], path: tuple[str, ...]
    ) -> str:
        """Emit the construction of a message from its leaves' variables."""
        target = self._new_name("m")
        self.scope[f"C{target}"] = get_message_class(name)
        self.lines.append(f"  {target} = new(C{target})")
        for field in get_message_spec(name).fields:
            inner = (*path, field.name)
            value = variables.get(inner) or self._build(
                field.type.base, variables, inner
            )
            self.lines.append(f"  {target}._{field.name} = {value}")
        return target

    def finish_run(self) -> None:
        """Emit the unpacking of the collected primitives, then their checks."""
        run, self._run = self._run, Run()
        if run.items:
            name = self._new_name("U")
            targets = ", ".join(run.expressions) + ","
            table = run.table(self._order)
            if self._phase is not None:
                packer, length = table[(self._phase - HEADER_SIZE) % PHASES]
                self.scope[name] = packer.unpack_from
                self.lines.append(f" {targets} = {name}(b, p)")
                self.lines.append(f" p += {length}")
            else:
                shifted = table[-HEADER_SIZE:] + table[:-HEADER_SIZE]
                self.scope[name] = tuple(each.unpack_from for each, _ in shifted)
                self.scope[f"{name}n"] = tuple(length for _, length in shifted)
                self.lines.append(" q = p & 7")
                self.lines.append(f" {targets} = {name}[q](b, p)")
                self.lines.append(f" p += {name}n[q]")
            phase = None if self._phase is None else (self._phase - HEADER_SIZE) % 8
            end = run.end_phase(phase)
            self._phase = None if end is None else (end + HEADER_SIZE) % PHASES
        self.lines += self._after_run
        self._after_run = []

    def _new_name(self, prefix: str) -> str:
        self._count += 1
        return f"{prefix}{self._count}"
