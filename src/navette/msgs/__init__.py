"""ROS 2 message, service and action types: classes, CDR, definitions."""

from typing import TYPE_CHECKING, Any

from navette.msgs.definition_text import definition_text, interface_text
from navette.msgs.registry import (
    add_interface_path,
    interface_names,
    load_interfaces,
    packages,
)
from navette.msgs.ros1 import ros1_definition
from navette.msgs.type_hash import type_description, type_hash

if TYPE_CHECKING:
    from navette.msgs.api import (
        Message,
        copy_message,
        deserialize,
        fields,
        from_dict,
        get_interface,
        register_definition,
        serialize,
        to_dict,
        type_name,
        validate,
    )

__all__ = [
    "Message",
    "get_interface",
    "type_name",
    "serialize",
    "deserialize",
    "copy_message",
    "to_dict",
    "from_dict",
    "fields",
    "validate",
    "definition_text",
    "interface_text",
    "type_hash",
    "type_description",
    "load_interfaces",
    "register_definition",
    "ros1_definition",
    "add_interface_path",
    "packages",
    "interface_names",
]


def __getattr__(name: str) -> Any:
    """Import the functions of ``api`` on first use."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from navette.msgs import api

    value = globals()[name] = getattr(api, name)
    return value
