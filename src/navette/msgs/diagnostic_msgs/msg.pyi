# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from typing import ClassVar

from navette.msgs.base import Message
import navette.msgs.std_msgs.msg

class DiagnosticArray(Message):
    header: navette.msgs.std_msgs.msg.Header
    status: list[DiagnosticStatus]
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        status: list[DiagnosticStatus] = ...,
    ) -> None: ...

class DiagnosticStatus(Message):
    OK: ClassVar[bytes]
    WARN: ClassVar[bytes]
    ERROR: ClassVar[bytes]
    STALE: ClassVar[bytes]
    level: bytes
    name: str
    message: str
    hardware_id: str
    values: list[KeyValue]
    def __init__(
        self,
        *,
        level: bytes = ...,
        name: str = ...,
        message: str = ...,
        hardware_id: str = ...,
        values: list[KeyValue] = ...,
    ) -> None: ...

class KeyValue(Message):
    key: str
    value: str
    def __init__(
        self,
        *,
        key: str = ...,
        value: str = ...,
    ) -> None: ...
