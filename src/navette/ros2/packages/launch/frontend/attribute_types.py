"""Types of attributes, by the rules of ROS 2's ``launch.frontend.Entity.get_attr``."""

from typing import Any, get_args, get_origin

import yaml

from navette.files.untrusted.yaml_input import load_yaml

_SCALARS = (int, float, bool, str)


def converted(value: Any, data_type: Any, *, can_be_str: bool) -> Any:
    """Return the value of an attribute as a type.

    Args:
        value: text, as XML gives it, or what YAML read.
        data_type: one of the scalar types, a list of one (``list[int]``), or None for
            any value that YAML can mean.
        can_be_str: text that has no such value, such as ``$(var x)``, is kept.

    Raises:
        TypeError: it cannot be converted.
        ValueError: no such type.
    """
    if data_type is None:
        return _as_yaml(value)
    is_list = get_origin(data_type) is list
    kind = get_args(data_type)[0] if is_list else data_type
    if kind not in _SCALARS:
        raise ValueError(f"Unrecognized data type: {data_type}")
    found = _as_yaml(value) if is_list else value
    items = found if is_list else [found]
    if not isinstance(items, list) or isinstance(found, list) is not is_list:
        raise _mismatch(value, data_type)
    done = [_scalar(item, kind, can_be_str=can_be_str) for item in items]
    if _NONE in done:
        raise _mismatch(value, data_type)
    return done if is_list else done[0]


_NONE = object()


def _scalar(value: Any, kind: type, *, can_be_str: bool) -> Any:
    """Return a value of the type, or ``_NONE``."""
    if type(value) is kind:
        return value
    if not isinstance(value, str):
        return float(value) if kind is float and type(value) is int else _NONE
    words = {"true": True, "1": True, "false": False, "0": False}
    try:
        found = words[value.strip().lower()] if kind is bool else kind(value)
    except (KeyError, ValueError):
        return value if can_be_str else _NONE
    return found


def _as_yaml(value: Any) -> Any:
    if not isinstance(value, str) or not value:
        return value
    try:
        return load_yaml(value)
    except yaml.YAMLError:
        return value


def _mismatch(value: Any, data_type: Any) -> TypeError:
    return TypeError(f"{value!r} cannot be converted to {data_type}")
