# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from navette.msgs.base import Message
import navette.msgs.builtin_interfaces.msg

class Clock(Message):
    clock: navette.msgs.builtin_interfaces.msg.Time
    def __init__(
        self,
        *,
        clock: navette.msgs.builtin_interfaces.msg.Time = ...,
    ) -> None: ...
