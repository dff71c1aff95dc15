"""Source of constructors and setters of message classes, written out per field.

Generated names start with an underscore, which field names cannot, so none clash.
"""

import keyword
from array import array
from typing import Any

import numpy as np

from navette.msgs.base import DEFAULT, Message, refuse_keywords
from navette.msgs.interface import (
    INTEGER_RANGES,
    Default,
    Field,
    FieldType,
    MessageSpec,
)
from navette.msgs.values import DTYPES, FLOAT32_MAX, TYPECODES, make_checker


def generate(spec: MessageSpec, nested: list[type[Message] | None]) -> dict[str, Any]:
    """Compile ``__init__``, ``_set_<i>`` and ``_make_default`` of a message.

    Returns their scope; the caller stores the finished class in it as ``_cls``.
    """
    scope: dict[str, Any] = {
        "_DEFAULT": DEFAULT,
        "_new": object.__new__,
        "_ndarray": np.ndarray,
        "_array": array,
        "_len": len,  # a field may be named len
        "_refuse_keywords": refuse_keywords,
    }
    for index, field in enumerate(spec.fields):
        cls = nested[index]
        scope[f"_check_{index}"] = make_checker(spec.name, field, cls)
        scope[f"_default_{index}"] = _default_value(field, cls)
        scope[f"_class_{index}"] = cls
        if field.type.is_numeric:
            scope[f"_dtype_{index}"] = DTYPES[field.type.base]
    source = "\n".join([*_constructor(spec), *_setters(spec), *_maker(spec)])
    exec(compile(source, f"<{spec.name}>", "exec"), scope)
    return scope


def _constructor(spec: MessageSpec) -> list[str]:
    arguments = [
        f"{field.name}=_DEFAULT"
        for field in spec.fields
        if not keyword.iskeyword(field.name)
    ]
    star = ["*"] if arguments else []
    signature = ", ".join(["_self", *star, *arguments, "**_unknown"])
    lines = [f"def __init__({signature}):"]
    for field in spec.fields:
        if keyword.iskeyword(field.name):
            lines.append(f" _{field.name} = _unknown.pop({field.name!r}, _DEFAULT)")
    lines.append(" if _unknown: _refuse_keywords(_cls, _unknown)")
    for index, field in enumerate(spec.fields):
        name = f"_{field.name}" if keyword.iskeyword(field.name) else field.name
        lines.append(f" if {name} is _DEFAULT:")
        lines.append(f"  _self._{field.name} = {_default_expression(index, field)}")
        if field.type.is_scalar:  # most fields: without a call
            lines.append(f" elif {_quick_test(index, field, name)}:")
            lines.append(f"  _self._{field.name} = {name}")
        lines.append(" else:")
        lines.append(f"  _set_{index}(_self, {name})")
    return lines


def _setters(spec: MessageSpec) -> list[str]:
    lines = []
    for index, field in enumerate(spec.fields):
        lines.append(f"def _set_{index}(_self, _value):")
        lines.append(f" if not ({_quick_test(index, field, '_value')}):")
        lines.append(f"  _value = _check_{index}(_value)")
        if field.type.is_numeric and not field.type.is_scalar:
            # As in rclpy, a message does not share an array with the caller.
            copied = ".copy()" if field.type.container == "array" else "[:]"
            lines += [" else:", f"  _value = _value{copied}"]
        lines.append(f" _self._{field.name} = _value")
    return lines


def _maker(spec: MessageSpec) -> list[str]:
    lines = ["def _make_default():", " _m = _new(_cls)"]
    lines += [
        f" _m._{field.name} = {_default_expression(index, field)}"
        for index, field in enumerate(spec.fields)
    ]
    return [*lines, " return _m"]


def _quick_test(index: int, field: Field, name: str) -> str:
    """Expression that is true for common valid values and false for invalid ones.

    Args:
        name: of the variable that holds the value.
    """
    type_ = field.type
    if not type_.is_scalar:
        if not type_.is_numeric:
            return "False"
        return _quick_array_test(index, type_, name)
    if type_.is_message:
        return f"{name}.__class__ is _class_{index}"
    if type_.is_string:
        test = f"{name}.__class__ is str"
        bound = type_.string_bound
        return test if bound is None else f"{test} and _len({name}) <= {bound}"
    if type_.base in INTEGER_RANGES:
        low, high = INTEGER_RANGES[type_.base]
        return f"{name}.__class__ is int and {low} <= {name} <= {high}"
    return {
        "bool": f"{name}.__class__ is bool",
        "byte": f"{name}.__class__ is bytes and _len({name}) == 1",
        "float64": f"{name}.__class__ is float",
        "float32": (
            f"{name}.__class__ is float"
            f" and {-FLOAT32_MAX!r} <= {name} <= {FLOAT32_MAX!r}"
        ),
    }[type_.base]


def _quick_array_test(index: int, type_: FieldType, name: str) -> str:
    if type_.container == "array":
        return (
            f"{name}.__class__ is _ndarray and {name}.dtype is _dtype_{index}"
            f" and {name}.ndim == 1 and {name}.flags.c_contiguous"
            f" and _len({name}) == {type_.size}"
        )
    code = TYPECODES[type_.base]
    test = f"{name}.__class__ is _array and {name}.typecode == {code!r}"
    return test if type_.size is None else f"{test} and _len({name}) <= {type_.size}"


def _default_value(field: Field, nested: type[Message] | None) -> Any:
    """Value of ``_default_<i>``: the default, or a function that makes it."""
    type_, default = field.type, field.default
    if nested is not None:
        # Lists need the function as well: a fixed array starts filled.
        return nested._make_default_
    if type_.is_scalar:
        return default if default is not None else _zero(type_.base)
    values = _default_elements(type_, default)
    if not type_.is_numeric:
        return values
    if type_.container == "array":
        return np.array(values, DTYPES[type_.base])
    return array(TYPECODES[type_.base], values)


def _default_elements(type_: FieldType, default: Default | None) -> list[Any]:
    if not isinstance(default, list):
        count = (type_.size or 0) if type_.container == "array" else 0
        return [_zero(type_.base)] * count
    if type_.base == "byte":  # read as integers
        return [bytes((int(number),)) for number in default]
    return default


def _zero(base: str) -> Any:
    if base in INTEGER_RANGES:
        return 0
    return {"bool": False, "byte": b"\0", "string": "", "wstring": ""}.get(base, 0.0)


def _default_expression(index: int, field: Field) -> str:
    type_ = field.type
    name = f"_default_{index}"
    if type_.is_message:
        if type_.is_scalar:
            return f"{name}()"
        if type_.container == "sequence":
            return "[]"
        return f"[{name}() for _ in range({type_.size})]"
    if type_.is_scalar:
        return name
    if type_.is_numeric and type_.container == "array":
        return f"{name}.copy()"
    return f"{name}[:]"
