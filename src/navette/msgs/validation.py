"""Checks a whole message: what setters cannot see, such as lists changed in place."""

from typing import Any

from navette.errors import MessageError
from navette.msgs.base import Message


def validate(msg: Message) -> None:
    """Check every field, nested ones too.

    Raises:
        MessageError: names the first field that holds something wrong.
    """
    if not isinstance(msg, Message):
        raise MessageError(f"{msg!r} is {type(msg).__name__}, wanted a message")
    for name in msg._field_types_:
        value: Any = getattr(msg, name)
        setattr(msg, name, value)
        for item in value if isinstance(value, list) else (value,):
            if isinstance(item, Message):
                validate(item)
