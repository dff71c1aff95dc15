"""Recorded bytes as messages."""

from typing import Any

from navette.bags.bag import BagTopic
from navette.errors import FileFormatError
from navette.msgs import Message, deserialize, get_interface, register_definition


def message_class(topic: BagTopic) -> type[Message]:
    """The class by which a topic's messages are read.

    It is made from the recording's own definition, so the type need not be installed.
    Where the installed type of that name has other fields (a recording of another
    release), the class is one of its own name.

    Raises:
        FileFormatError: the definition is broken, or the messages are not ROS's.
        UnknownNameError: the recording has no definition, and nobody else has one.
    """
    if topic.encoding != "cdr":
        raise FileFormatError(topic.name, f"{topic.encoding} messages are not ROS's")
    if topic.definition:
        found = register_definition(topic.type_name, topic.definition, private=True)
    else:
        found = get_interface(topic.type_name)
    if not issubclass(found, Message):
        raise FileFormatError(topic.name, f"{topic.type_name} is no message")
    return found


class Decoder:
    """Reads messages of one topic."""

    def __init__(self, topic: BagTopic) -> None:
        self.message_class = message_class(topic)

    def __call__(self, data: bytes) -> Any:
        """The message.

        Raises:
            DecodeError: the bytes are none.
        """
        return deserialize(data, self.message_class)
