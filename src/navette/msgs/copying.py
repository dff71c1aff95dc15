"""Deep copies of messages, by code generated per class.

Each subscriber receives a copy, so this runs once per delivery: nested messages are
copied inline, without a call for each. A copy equals a serialised and deserialised
message: float32 fields are rounded to 32 bits, so that a run in one process and one in
several processes give the same results.
"""

import struct
from collections.abc import Callable
from typing import Any, TypeVar

from navette.errors import MessageError
from navette.msgs.base import Message, validate
from navette.msgs.classes import get_message_class
from navette.msgs.interface import Field, MessageSpec
from navette.msgs.registry import get_message_spec

M = TypeVar("M", bound=Message)
Copier = Callable[[Any], Any]

_copiers: dict[type, Copier] = {}


def copy_message(msg: M) -> M:
    """Return a copy that shares nothing with the original.

    Raises:
        MessageError: a list that was changed in place contains an invalid element.
    """
    copier = _copiers.get(msg.__class__) or _copier_of(msg.__class__)
    try:
        copied: M = copier(msg)
    except (AttributeError, TypeError, struct.error):
        validate(msg)
        raise
    return copied


def _copier_of(cls: type[M]) -> Callable[[M], M]:
    """Return the function that copies messages of a class."""
    found = _copiers.get(cls)
    if found is None:
        if not issubclass(cls, Message):
            raise MessageError(f"{cls!r} is not a message class")
        found = _copiers[cls] = _make(cls)
    return found


def _make(cls: type[Message]) -> Copier:
    emitter = _Emitter()
    result = emitter.message(cls._spec_, "m", cls)
    lines = ["def copy(m):", *emitter.lines, f" return {result}"]
    exec(compile("\n".join(lines), f"<copy {cls._type_name_}>", "exec"), emitter.scope)
    copier: Copier = emitter.scope["copy"]
    return copier


class _Emitter:
    """Source lines of one copy function and the objects they refer to."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.scope: dict[str, Any] = {"new": object.__new__}
        self.scope |= {"pack": struct.pack, "unpack": struct.unpack}
        self._count = 0

    def message(self, spec: MessageSpec, source: str, cls: type) -> str:
        """Emit the copy of the message in variable ``source``; return its variable."""
        self._count += 1
        number = self._count
        target = f"t{number}"
        self.scope[f"C{number}"] = cls
        self.lines.append(f" {target} = new(C{number})")
        rounded = [f"_{f.name}" for f in spec.fields if _is_float32(f)]
        if rounded:
            layout = f'"{len(rounded)}f"'
            values = ", ".join(f"{source}.{slot}" for slot in rounded)
            targets = ", ".join(f"{target}.{slot}" for slot in rounded)
            self.lines.append(
                f" {targets}, = unpack({layout}, pack({layout}, {values}))"
            )
        for field in spec.fields:
            if _is_float32(field):
                continue
            slot = f"_{field.name}"
            value = f"{source}.{slot}"
            if field.type.is_message and field.type.is_scalar:
                inner = f"s{number}"
                self.lines.append(f" {inner} = {value}")
                nested = get_message_spec(field.type.base)
                value = self.message(nested, inner, get_message_class(nested.name))
            elif field.type.is_message:
                element = get_message_class(field.type.base)
                self.scope[f"E{number}_{field.name}"] = _copier_of(element)
                value = f"[E{number}_{field.name}(e) for e in {value}]"
            elif not field.type.is_scalar:
                is_numpy = field.type.is_numeric and field.type.container == "array"
                value += ".copy()" if is_numpy else "[:]"
            self.lines.append(f" {target}.{slot} = {value}")
        return target


def _is_float32(field: Field) -> bool:
    return field.type.is_scalar and field.type.base == "float32"
