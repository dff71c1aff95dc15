"""Checks and conversions of field values.

A checker takes an assigned value and returns the value to store, or raises
:class:`MessageError`. Generated setters call it only if their quick inline test fails.
"""

import math
from array import array
from collections.abc import Callable, Iterable, Mapping, Sequence
from operator import is_
from typing import Any

import numpy as np
from numpy.typing import NDArray

from navette.errors import MessageError
from navette.msgs.interface import INTEGER_RANGES, Field, FieldType

Checker = Callable[[Any], Any]

DTYPES: dict[str, np.dtype[Any]] = {
    "char": np.dtype("u1"),
    "int8": np.dtype("i1"),
    "uint8": np.dtype("u1"),
    "int16": np.dtype("<i2"),
    "uint16": np.dtype("<u2"),
    "int32": np.dtype("<i4"),
    "uint32": np.dtype("<u4"),
    "int64": np.dtype("<i8"),
    "uint64": np.dtype("<u8"),
    "float32": np.dtype("<f4"),
    "float64": np.dtype("<f8"),
}
# Type codes of ``array.array``, as in rclpy.
TYPECODES: dict[str, str] = {
    "char": "B",
    "int8": "b",
    "uint8": "B",
    "int16": "h",
    "uint16": "H",
    "int32": "i",
    "uint32": "I",
    "int64": "q",
    "uint64": "Q",
    "float32": "f",
    "float64": "d",
}
FLOAT32_MAX = float(np.finfo(np.float32).max)


def make_checker(owner: str, field: Field, message_class: type | None) -> Checker:
    """Return the checker of a field; ``message_class`` is the class of its base."""
    type_ = field.type
    where = f"{owner}.{field.name}"
    if not type_.is_scalar:
        if type_.is_numeric:
            return _array_checker(where, type_)
        item = make_checker(owner, Field(field.name, _item_of(type_)), message_class)
        if type_.base == "byte":
            return _bytes_checker(where, type_, item)
        return _list_checker(where, type_, item)
    if message_class is not None:
        return _message_checker(where, message_class)
    if type_.is_string:
        return _string_checker(where, type_)
    if type_.base in INTEGER_RANGES:
        return _integer_checker(where, type_.base)
    return {
        "bool": _bool_checker,
        "byte": _byte_checker,
        "float32": _float32_checker,
        "float64": _float64_checker,
    }[type_.base](where)


def shortened(value: object, limit: int = 60) -> str:
    """Return ``repr(value)``, cut for error messages."""
    text = repr(value)
    return text if len(text) <= limit else text[:limit] + "…"


def _refuse(where: str, value: object, allowed: str) -> MessageError:
    kind = type(value).__name__
    return MessageError(f"{where}: {shortened(value)} is {kind}, expected {allowed}")


def _item_of(type_: FieldType) -> FieldType:
    return FieldType(type_.base, string_bound=type_.string_bound)


def _message_checker(where: str, message_class: type) -> Checker:
    allowed = f"a {getattr(message_class, '_type_name_', message_class.__name__)}"

    def check(value: Any) -> Any:
        if not isinstance(value, message_class):
            # Often a time or duration of the clock instead of its message.
            use = " (use its to_msg())" if hasattr(value, "to_msg") else ""
            raise _refuse(where, value, allowed + use)
        return value

    return check


def _string_checker(where: str, type_: FieldType) -> Checker:
    bound = type_.string_bound

    def check(value: Any) -> str:
        if not isinstance(value, str):
            raise _refuse(where, value, "a str")
        if bound is not None and len(value) > bound:
            raise MessageError(
                f"{where}: {shortened(value)} has {len(value)} characters, "
                f"expected at most {bound}"
            )
        return str(value)

    return check


def _integer_checker(where: str, base: str) -> Checker:
    low, high = INTEGER_RANGES[base]
    allowed = f"an integer from {low} to {high} ({base})"

    def check(value: Any) -> int:
        # A bool is an int in Python and rclpy: `image.is_bigendian = False`.
        if not isinstance(value, (int, np.integer)):
            raise _refuse(where, value, allowed)
        number = int(value)
        if not low <= number <= high:
            raise MessageError(f"{where}: {number} is out of range, expected {allowed}")
        return number

    return check


def _bool_checker(where: str) -> Checker:
    def check(value: Any) -> bool:
        if not isinstance(value, (bool, np.bool_)):
            raise _refuse(where, value, "a bool")
        return bool(value)

    return check


def _byte_checker(where: str) -> Checker:
    allowed = "one byte as bytes, such as b'\\x01', or an integer from 0 to 255"

    def check(value: Any) -> bytes:
        if isinstance(value, bytes) and len(value) == 1:
            return value
        is_integer = isinstance(value, (int, np.integer))
        if not is_integer or isinstance(value, bool) or not 0 <= value <= 255:
            raise _refuse(where, value, allowed)
        return bytes([int(value)])

    return check


def _float64_checker(where: str) -> Checker:
    def check(value: Any) -> float:
        is_number = isinstance(value, (float, int, np.floating, np.integer))
        if not is_number or isinstance(value, bool):
            raise _refuse(where, value, "a float (float64)")
        try:
            return float(value)
        except OverflowError:
            raise MessageError(
                f"{where}: {shortened(value)} is out of range, expected a float64"
            ) from None

    return check


def _float32_checker(where: str) -> Checker:
    as_float = _float64_checker(where)

    def check(value: Any) -> float:
        number: float = as_float(value)
        if abs(number) > FLOAT32_MAX and not math.isinf(number):
            raise MessageError(
                f"{where}: {number!r} is out of range, expected a float32, "
                f"at most {FLOAT32_MAX:.9g} in magnitude, or inf or nan"
            )
        return number

    return check


def _check_length(where: str, type_: FieldType, length: int) -> None:
    if type_.size is None:
        return
    if type_.container == "array" and length != type_.size:
        raise MessageError(f"{where}: {length} elements, expected exactly {type_.size}")
    if length > type_.size:
        raise MessageError(f"{where}: {length} elements, expected at most {type_.size}")


def _list_checker(where: str, type_: FieldType, check_item: Checker) -> Checker:
    """Strings, messages, bools: a list, the given one if no element is converted."""

    def check(value: Any) -> list[Any]:
        is_text = isinstance(value, (str, bytes, Mapping))
        if is_text or not isinstance(value, Iterable):
            raise _refuse(where, value, f"a list ({type_})")
        items = value if isinstance(value, list) else list(value)
        _check_length(where, type_, len(items))
        converted = []
        for index, item in enumerate(items):
            try:
                converted.append(check_item(item))
            except MessageError as error:
                text = str(error).replace(where, f"{where}[{index}]", 1)
                raise MessageError(text) from None
        return items if all(map(is_, items, converted)) else converted

    return check


def _bytes_checker(where: str, type_: FieldType, check_item: Checker) -> Checker:
    """``byte[]``: a list of single bytes, as in rclpy; takes bytes, too."""
    check_list = _list_checker(where, type_, check_item)

    def check(value: Any) -> list[Any]:
        if isinstance(value, (bytes, bytearray)):
            value = [bytes((number,)) for number in value]
        items: list[bytes] = check_list(value)
        return items

    return check


def _array_checker(where: str, type_: FieldType) -> Checker:
    """Numbers: a numpy array if the size is fixed, else an ``array.array``."""
    to_ndarray = _ndarray_checker(where, type_)
    if type_.container == "array":
        return lambda value: np.array(to_ndarray(value))
    typecode = TYPECODES[type_.base]
    is_octet = DTYPES[type_.base].itemsize == 1

    def check(value: Any) -> "array[Any]":
        if isinstance(value, array) and value.typecode == typecode:
            _check_length(where, type_, len(value))
            return value[:]
        numbers = array(typecode)
        if is_octet and isinstance(value, (bytes, bytearray)):
            _check_length(where, type_, len(value))
            numbers.frombytes(value)
        else:
            numbers.frombytes(to_ndarray(value).view(np.uint8).data)
        return numbers

    return check


def _ndarray_checker(where: str, type_: FieldType) -> Checker:
    dtype = DTYPES[type_.base]
    allowed = f"a sequence of {type_.base}"

    def check(value: Any) -> NDArray[Any]:
        if isinstance(value, np.ndarray) and value.dtype == dtype and value.ndim == 1:
            _check_length(where, type_, len(value))
            return np.ascontiguousarray(value)
        found = _as_array(where, value, dtype, allowed)
        if found.ndim != 1:
            raise MessageError(
                f"{where}: an array of shape {found.shape}, expected one dimension "
                "(flatten it row by row with .ravel())"
            )
        _check_length(where, type_, len(found))
        if found.dtype != dtype:
            found = _cast(where, found, dtype, type_.base)
        return np.ascontiguousarray(found)

    return check


def _as_array(
    where: str, value: Any, dtype: np.dtype[Any], allowed: str
) -> NDArray[Any]:
    if isinstance(value, np.ndarray):
        return value
    if isinstance(value, (bytes, bytearray)):
        if dtype.itemsize != 1 or dtype.kind not in "iu":
            raise _refuse(where, value, allowed)
        # A copy: writable, and independent of a bytearray.
        return np.frombuffer(value, dtype).copy()
    if isinstance(value, (array, memoryview)):
        return np.array(value)
    if isinstance(value, (str, Mapping)) or not isinstance(value, Iterable):
        raise _refuse(where, value, allowed)
    if not isinstance(value, Sequence):
        value = list(value)
    if not len(value):
        return np.zeros(0, dtype)
    try:
        found = np.array(value)
        # numpy converts integers from about 2**63 to floats or objects, and keeps
        # bools, which are integers in Python.
        if dtype.kind in "iu" and found.dtype.kind in "fOb" and _all_integers(value):
            found = np.array(value, dtype)
    except (ValueError, OverflowError):
        raise _refuse(where, value, allowed) from None
    return found


def _all_integers(values: Iterable[Any]) -> bool:
    return all(isinstance(value, (int, np.integer)) for value in values)


def _cast(
    where: str, found: NDArray[Any], dtype: np.dtype[Any], base: str
) -> NDArray[Any]:
    """Convert to ``dtype`` if every value fits; floats never fit an integer."""
    kinds = {"i": "iu", "u": "iu", "f": "fiu"}[dtype.kind]
    if found.dtype.kind not in kinds:
        raise MessageError(
            f"{where}: elements of {found.dtype} ({shortened(found[:8].tolist())}), "
            f"expected {base}"
        )
    if not found.size:
        return np.zeros(0, dtype)
    if dtype.kind in "iu":
        low, high = INTEGER_RANGES[base]
    elif dtype.itemsize == 4:
        low, high = -FLOAT32_MAX, FLOAT32_MAX  # type: ignore[assignment]
    else:
        return found.astype(dtype)
    finite = found[np.isfinite(found)] if found.dtype.kind == "f" else found
    # As Python numbers: numpy would round the 64-bit bounds to floats.
    if finite.size and not (low <= finite.min().item() and finite.max().item() <= high):
        raise MessageError(
            f"{where}: values from {finite.min()} to {finite.max()} do not fit {base} "
            f"({low} to {high})"
        )
    return found.astype(dtype)
