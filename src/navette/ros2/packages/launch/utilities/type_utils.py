"""Typed values from text and from substitutions.

A type is ``int``, ``float``, ``bool``, ``str``, a list of one of these (``list[int]``),
or None for any of them by the rules of YAML. With ``can_be_str``, text is accepted in
place of any type.
"""

from collections.abc import Sequence
from typing import Any, List, get_args, get_origin  # noqa: UP035 - programs pass List

import yaml

from navette.files.untrusted.yaml_input import load_yaml
from navette.ros2.packages.launch.substitution import Parts, Substitution

SCALARS = (int, float, bool, str)
_NUMERIC_TRUTHS = {"1": True, "0": False}


def is_typing_list(data_type: Any) -> bool:
    """Whether a type is a list of a type (``List``, ``List[int]``, ``list[int]``)."""
    return data_type is List or get_origin(data_type) is list  # noqa: UP006 - see above


def is_valid_scalar_type(data_type: Any) -> bool:
    """Whether a type is int, float, bool or str."""
    return data_type in SCALARS


def extract_type(data_type: Any) -> tuple[Any, bool]:
    """Return the scalar type of a type, and whether the type is a list of it.

    Raises:
        ValueError: not one of the types.
    """
    if is_valid_scalar_type(data_type):
        return data_type, False
    items = get_args(data_type)
    if is_typing_list(data_type) and len(items) == 1 and items[0] in SCALARS:
        return items[0], True
    raise ValueError(
        f"type {data_type!r}; expected int, float, bool, str or a list of one of these"
    )


def is_instance_of_valid_type(value: Any, *, can_be_str: bool = False) -> bool:
    """Whether a value is a scalar, or a list of scalars of one type."""
    if not isinstance(value, list):
        return type(value) in SCALARS
    kinds = {type(item) for item in value}
    if can_be_str and len(kinds) > 1:
        kinds.discard(str)
    return len(kinds) <= 1 and kinds <= set(SCALARS)


def is_instance_of(value: Any, data_type: Any, *, can_be_str: bool = False) -> bool:
    """Whether a value has a type.

    Raises:
        ValueError: not one of the types.
    """
    if data_type is None:
        return is_instance_of_valid_type(value, can_be_str=can_be_str)
    kind, is_list = extract_type(data_type)
    allowed = (kind, str) if can_be_str else (kind,)
    if is_list:
        return isinstance(value, list) and all(type(item) in allowed for item in value)
    return type(value) in allowed


def coerce_to_type(
    value: str, data_type: Any = None, *, can_be_str: bool = False
) -> Any:
    """Return the value that a text has as a type.

    Raises:
        TypeError: the value is not a text.
        ValueError: the text has no value of the type.
    """
    if not isinstance(value, str):
        raise TypeError(f"{value!r}: expected text")
    if data_type in (int, float, bool):
        try:
            return _scalar(value, data_type)
        except ValueError:
            if can_be_str:
                return value
            raise
    if data_type is str:
        return value
    found = _yaml(value)
    if not is_instance_of(found, data_type, can_be_str=can_be_str):
        expected = "" if data_type is None else f"; expected {data_type}"
        raise ValueError(f"{value!r} is not a value of one type{expected}")
    return found


def _yaml(value: str) -> Any:
    if not value:
        return value
    try:
        return load_yaml(value)
    except yaml.YAMLError as error:
        raise ValueError(f"{value!r}: {error}") from None


def _scalar(value: str, kind: type) -> Any:
    if kind is not bool:
        try:
            return kind(value)
        except ValueError:
            raise ValueError(f"{value!r}: expected {kind.__name__}") from None
    found = _NUMERIC_TRUTHS.get(value, _yaml(value))
    if not isinstance(found, bool):
        raise ValueError(f"{value!r} is not a truth value; expected true or false")
    return found


def coerce_list(
    value: Sequence[str], data_type: Any = None, *, can_be_str: bool = False
) -> list[Any]:
    """Return the values that several texts have as one scalar type.

    Raises:
        TypeError: not a list of texts.
        ValueError: a text has no value of the type, or the types differ.
    """
    is_list = isinstance(value, (list, tuple))
    if not is_list or not all(isinstance(item, str) for item in value):
        raise TypeError(f"{value!r}: expected a list of texts")
    found = [coerce_to_type(item, data_type, can_be_str=can_be_str) for item in value]
    if not is_instance_of_valid_type(found, can_be_str=can_be_str):
        raise ValueError(f"{value!r} are not values of one type")
    return found


def get_typed_value(
    value: str | list[str], data_type: Any = None, *, can_be_str: bool = False
) -> Any:
    """Return the value of a text, or of a list of texts.

    Raises:
        TypeError: neither of these, or a list for a scalar type.
        ValueError: a text cannot be read as the type.
    """
    if not isinstance(value, list):
        return coerce_to_type(value, data_type, can_be_str=can_be_str)
    if data_type is None:
        return coerce_list(value, can_be_str=can_be_str)
    kind, is_list = extract_type(data_type)
    if not is_list:
        raise TypeError(f"{value!r}: expected one {kind.__name__}")
    return coerce_list(value, kind, can_be_str=can_be_str)


def is_substitution(value: Any) -> bool:
    """Whether a value is a substitution, or a list of substitutions and text."""
    if isinstance(value, Substitution):
        return True
    return (
        isinstance(value, (list, tuple))
        and any(isinstance(item, Substitution) for item in value)
        and all(isinstance(item, (str, Substitution)) for item in value)
    )


def is_normalized_substitution(value: Any) -> bool:
    """Whether a value is a list of substitutions."""
    return (
        isinstance(value, list)
        and bool(value)
        and all(isinstance(item, Substitution) for item in value)
    )


def normalize_typed_substitution(value: Any, data_type: Any = None) -> Any:
    """Return a value of a type with its substitutions as lists of substitutions.

    Raises:
        TypeError: neither a value of the type nor substitutions.
        ValueError: not one of the types.
    """
    kind, is_list = (None, True) if data_type is None else extract_type(data_type)
    if is_substitution(value):
        return Parts.of(value)
    if is_instance_of(value, data_type):
        return value
    if not is_list or not isinstance(value, list):
        raise TypeError(f"{value!r}: expected {data_type} or substitutions")
    plain = [item for item in value if not is_substitution(item)]
    if not is_instance_of_valid_type(plain) or not all(
        kind is None or type(item) is kind for item in plain
    ):
        raise TypeError(f"{value!r}: expected {data_type} or substitutions")
    return [Parts.of(item) if is_substitution(item) else item for item in value]


def perform_typed_substitution(context: Any, value: Any, data_type: Any = None) -> Any:
    """Return the value of the result of :func:`normalize_typed_substitution`.

    Raises:
        TypeError: the value has another type.
        ValueError: a text has no value of the type, or not one of the types.
    """
    kind = None if data_type is None else extract_type(data_type)[0]

    def text_of(parts: list[Substitution]) -> str:
        return "".join(context.perform_substitution(part) for part in parts)

    if is_normalized_substitution(value):
        return get_typed_value(text_of(value), data_type)
    if isinstance(value, list) and any(map(is_normalized_substitution, value)):
        found = [
            coerce_to_type(text_of(each), kind)
            if is_normalized_substitution(each)
            else each
            for each in value
        ]
        if not is_instance_of(found, data_type):
            raise ValueError(f"{found!r} are not values of one type")
        return found
    if not is_instance_of(value, data_type):
        raise TypeError(f"{value!r}: expected {data_type}")
    return value
