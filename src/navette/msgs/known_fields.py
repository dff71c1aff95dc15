"""Messages whose fields differ between distributions of ROS 2."""

from collections.abc import Iterable
from typing import Any

from navette.msgs.base import Message
from navette.msgs.classes import get_message_class


def made(message_class: type[Any], **values: Any) -> Any:
    """Return a message; values of fields that its definition lacks are left out."""
    known = message_class.get_fields_and_field_types()
    return message_class(**{k: v for k, v in values.items() if k in known})


def fill(message: Message, **values: Any) -> None:
    """Set fields of a message; fields that its definition lacks are left out."""
    known = message.get_fields_and_field_types()
    for name, value in values.items():
        if name in known:
            setattr(message, name, value)


def several_poses(message_class: type[Any], field: str, poses: Iterable[Any]) -> Any:
    """Return poses as a field takes them: a list; ``nav_msgs/Goals`` since Kilted."""
    if message_class.get_fields_and_field_types()[field] != "nav_msgs/Goals":
        return list(poses)
    goals: Any = get_message_class("nav_msgs/msg/Goals")
    return goals(goals=list(poses))
