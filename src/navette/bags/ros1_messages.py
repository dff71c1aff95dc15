"""Convert messages between ROS 1 and ROS 2 serialization.

``rosbags`` converts the bytes, with definitions parsed and bounded by
:mod:`navette.msgs`, so that untrusted text never reaches a code generator.
"""

import struct
from functools import cached_property, lru_cache
from typing import Any

from navette.errors import DecodeError
from navette.msgs import definition_text, ros1_definition
from navette.msgs.registration import load_private_definition


class Ros1Type:
    """A type of a ROS 1 file.

    Args:
        name: ``pkg/Type``.
        text: its definition with nested definitions, as recorded.

    Raises:
        FileFormatError: the definition cannot be read.
    """

    def __init__(self, name: str, text: str) -> None:
        self.type_name, mapped = ros1_definition(name, text)
        known = load_private_definition(self.type_name, mapped)
        #: ``ros2msg`` definition with nested definitions, with ROS 2's names.
        self.definition = mapped if known != self.type_name else definition_text(known)

    @cached_property
    def _store(self) -> Any:
        from rosbags.typesys import Stores, get_types_from_msg, get_typestore

        store = get_typestore(Stores.EMPTY)
        store.register(get_types_from_msg(self.definition, self.type_name))
        return store

    def to_cdr(self, data: bytes) -> bytes:
        """Convert a recorded message to CDR with its header.

        Raises:
            DecodeError: the bytes are not a message of this type.
        """
        from rosbags.serde import SerdeError
        from rosbags.typesys import TypesysError

        try:
            return bytes(self._store.ros1_to_cdr(data, self.type_name))
        except (
            *(SerdeError, TypesysError, struct.error),
            *(ValueError, LookupError, TypeError, OverflowError),
        ) as error:
            raise DecodeError(
                f"{len(data)} bytes are not a ROS 1 {self.type_name}: {error}"
            ) from error


# Cached, since reading a definition takes milliseconds.
ros1_type = lru_cache(maxsize=256)(Ros1Type)
