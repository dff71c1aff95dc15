"""Deserialization of recorded messages."""

from typing import Any

from navette.bags.bag import BagTopic
from navette.errors import FileFormatError
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
    if topic.definition:
        found = register_definition(topic.type_name, topic.definition, private=True)
    else:
        found = get_interface(topic.type_name)
    if not issubclass(found, Message):
        raise FileFormatError(topic.name, f"{topic.type_name} is not a message type")
    return found


class Decoder:
    """Deserializes the messages of one topic."""

    def __init__(self, topic: BagTopic) -> None:
        self.message_class = message_class(topic)

    def __call__(self, data: bytes) -> Any:
        """Deserialize a message.

        Raises:
            DecodeError: invalid bytes.
        """
        return deserialize(data, self.message_class)
