"""The dataclass of a method's parameters."""

import dataclasses
import inspect
from typing import Any


def params_of(target: Any) -> type[Any] | None:
    """Return the dataclass of a method's parameters: its ``Params``, or itself."""
    own = getattr(target, "Params", None)
    for kind in (own, target):
        if inspect.isclass(kind) and dataclasses.is_dataclass(kind):
            return kind
    return None


def values_of(kind: type[Any], params: Any) -> dict[str, Any]:
    """Return the values of a dataclass's fields, from an object that has them."""
    return {
        each.name: getattr(params, each.name)
        for each in dataclasses.fields(kind)
        if each.init
    }
