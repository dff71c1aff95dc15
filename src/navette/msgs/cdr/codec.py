"""CDR serialisation and deserialisation: header, byte order, errors."""

import struct
from collections.abc import Callable
from typing import Any, TypeVar

from navette.errors import DecodeError, MessageError
from navette.msgs.base import Message, validate
from navette.msgs.cdr.reader import HEADER_SIZE, Reader, make_reader
from navette.msgs.cdr.writer import make_writer

_BIG, _LITTLE = b"\x00\x00", b"\x00\x01"
M = TypeVar("M", bound=Message)

_MAX_PADDING = 3  # bytes; writers may pad the end to a multiple of four

_writers: dict[type, Callable[[Any], bytes]] = {}
_readers: dict[type, Reader] = {}
_big_endian_readers: dict[type, Reader] = {}


def serialize(msg: Message) -> bytes:
    """Serialise a message to CDR, little-endian, with the 4-byte header.

    Raises:
        MessageError: a list that was changed in place contains an invalid element, or
            a string contains half a surrogate pair.
    """
    writer = _writers.get(msg.__class__) or _writer_of(msg.__class__)
    try:
        return writer(msg)
    except UnicodeEncodeError as error:
        name = type(msg).__name__
        raise MessageError(f"{name}: a string is not valid Unicode: {error}") from error
    except (AttributeError, TypeError, struct.error):
        validate(msg)
        raise


def deserialize(data: bytes | bytearray | memoryview, cls: type[M]) -> M:
    """Deserialise a message from CDR with its header, in either byte order.

    Arrays are writable copies, independent of ``data``.

    Raises:
        DecodeError: the bytes are not a message of this class.
    """
    if data[:2] == _LITTLE and len(data) >= HEADER_SIZE:
        reader = _readers.get(cls) or _reader_of(cls)
    else:
        reader = _big_endian_reader(data, cls)
    if isinstance(data, bytearray):
        data = memoryview(data)
    length = len(data)
    try:
        message, end = reader(data, HEADER_SIZE, length)
    except DecodeError:
        raise
    except (struct.error, ValueError) as error:
        raise DecodeError(
            f"{length} bytes are not a {cls._type_name_}: {error}"
        ) from error
    if length - end > _MAX_PADDING:
        raise DecodeError(
            f"{cls._type_name_}: {length - end} of {length} bytes are unread"
        )
    decoded: M = message
    return decoded


def _message_class(cls: type) -> type[Message]:
    if not (isinstance(cls, type) and issubclass(cls, Message)) or cls is Message:
        raise MessageError(f"{cls!r} is not a message class")
    return cls


def _writer_of(cls: type) -> Callable[[Any], bytes]:
    _writers[cls] = make_writer(_message_class(cls)._spec_)
    return _writers[cls]


def _reader_of(cls: type) -> Reader:
    _readers[cls] = make_reader(_message_class(cls), "<")
    return _readers[cls]


def _big_endian_reader(
    data: bytes | bytearray | memoryview, cls: type[Message]
) -> Reader:
    if data[:2] != _BIG or len(data) < HEADER_SIZE:
        raise DecodeError(
            f"{cls.__name__}: header {bytes(data[:4]).hex(' ') or 'missing'}, "
            "expected plain CDR: 00 00 or 00 01 and two more bytes"
        )
    found = _big_endian_readers.get(cls)
    if found is None:
        found = _big_endian_readers[cls] = make_reader(_message_class(cls), ">")
    return found
