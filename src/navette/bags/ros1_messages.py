"""Messages of ROS 1 in ROS 2's form, and back.

The bytes are turned by ``rosbags``, from a definition that was read and bounded by
:mod:`navette.msgs`: what a file claims never reaches a code generator as it is.
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
        text: its definition with what it contains, as in the file.

    Raises:
        FileFormatError: the definition cannot be read.
    """

    def __init__(self, name: str, text: str) -> None:
        self.type_name, mapped = ros1_definition(name, text)
        known = load_private_definition(self.type_name, mapped)
        #: ``ros2msg`` text with everything that it contains, under ROS 2's names.
        self.definition = mapped if known != self.type_name else definition_text(known)

    @cached_property
    def _store(self) -> Any:
        from rosbags.typesys import Stores, get_types_from_msg, get_typestore

        store = get_typestore(Stores.EMPTY)
        store.register(get_types_from_msg(self.definition, self.type_name))
        return store

    def to_cdr(self, data: bytes) -> bytes:
        """A message of the file as CDR with its header.

        Raises:
            DecodeError: the bytes are no message of this type.
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
                f"{len(data)} bytes are no ROS 1 {self.type_name}: {error}"
            ) from error


@lru_cache(maxsize=256)
def ros1_type(name: str, text: str) -> Ros1Type:
    """The type of a name and a definition; made once, which takes milliseconds.

    Raises:
        FileFormatError: the definition cannot be read.
    """
    return Ros1Type(name, text)
