# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from typing import ClassVar

from navette.msgs.base import Message
import navette.msgs.builtin_interfaces.msg
import navette.msgs.unique_identifier_msgs.msg

class GoalInfo(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    stamp: navette.msgs.builtin_interfaces.msg.Time
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        stamp: navette.msgs.builtin_interfaces.msg.Time = ...,
    ) -> None: ...

class GoalStatus(Message):
    STATUS_UNKNOWN: ClassVar[int]
    STATUS_ACCEPTED: ClassVar[int]
    STATUS_EXECUTING: ClassVar[int]
    STATUS_CANCELING: ClassVar[int]
    STATUS_SUCCEEDED: ClassVar[int]
    STATUS_CANCELED: ClassVar[int]
    STATUS_ABORTED: ClassVar[int]
    goal_info: GoalInfo
    status: int
    def __init__(
        self,
        *,
        goal_info: GoalInfo = ...,
        status: int = ...,
    ) -> None: ...

class GoalStatusArray(Message):
    status_list: list[GoalStatus]
    def __init__(
        self,
        *,
        status_list: list[GoalStatus] = ...,
    ) -> None: ...
