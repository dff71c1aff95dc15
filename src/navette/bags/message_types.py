"""Deserialization of recorded messages."""

from dataclasses import replace
from typing import Any

from navette.bags.bag import BagTopic
from navette.errors import FileFormatError, UnknownNameError
from navette.msgs import Message, deserialize, get_interface, register_definition


def message_class(topic: BagTopic) -> type[Message]:
    """Return the message class of a topic.

    The class is generated from the recorded definition, so the type need not be
    installed. If the installed type of that name has other fields (a recording of
    another release), the class has its own name.

    Raises:
        FileFormatError: invalid definition, or the messages are not ROS messages.
        UnknownNameError: neither the recording nor the installation has a definition.
    """
    if topic.encoding != "cdr":
        raise FileFormatError(
            topic.name, f"{topic.encoding} messages are not ROS messages"
        )
    if topic.definition or (is_empty_type(topic) and not _is_installed(topic)):
        found = register_definition(topic.type_name, topic.definition, private=True)
    else:
        found = get_interface(topic.type_name)
    if not issubclass(found, Message):
        raise FileFormatError(topic.name, f"{topic.type_name} is not a message type")
    return found


def is_empty_type(topic: BagTopic) -> bool:
    """Whether the recorded definition has no text: a message without fields."""
    recorded = topic.channel
    return (
        recorded is not None
        and recorded.schema_encoding == "ros2msg"
        and recorded.schema == b""
    )


def _is_installed(topic: BagTopic) -> bool:
    try:
        get_interface(topic.type_name)
    except UnknownNameError:
        return False
    return True


_HEADER_SIZE = 4
"""CDR header; messages without fields may consist of it, or of nothing at all."""


class Decoder:
    """Deserializes the messages of one topic."""

    def __init__(self, topic: BagTopic) -> None:
        recorded = topic.channel
        self._to_cdr = None
        if recorded is not None and recorded.encoding == topic.encoding:
            self._to_cdr = recorded.to_cdr
        if self._to_cdr is not None:
            topic = replace(topic, encoding="cdr")
        self.message_class = message_class(topic)
        self._is_fieldless = not self.message_class.get_fields_and_field_types()

    def __call__(self, data: bytes) -> Any:
        """Deserialize a message.

        Raises:
            DecodeError: invalid bytes.
        """
        if self._to_cdr is not None:
            data = self._to_cdr(data)
        if len(data) <= _HEADER_SIZE and self._is_fieldless:
            return self.message_class()
        return deserialize(data, self.message_class)
