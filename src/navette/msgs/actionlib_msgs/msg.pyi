# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from typing import ClassVar

from navette.msgs.base import Message
import navette.msgs.builtin_interfaces.msg
import navette.msgs.std_msgs.msg

class GoalID(Message):
    stamp: navette.msgs.builtin_interfaces.msg.Time
    id: str
    def __init__(
        self,
        *,
        stamp: navette.msgs.builtin_interfaces.msg.Time = ...,
        id: str = ...,
    ) -> None: ...

class GoalStatus(Message):
    PENDING: ClassVar[int]
    ACTIVE: ClassVar[int]
    PREEMPTED: ClassVar[int]
    SUCCEEDED: ClassVar[int]
    ABORTED: ClassVar[int]
    REJECTED: ClassVar[int]
    PREEMPTING: ClassVar[int]
    RECALLING: ClassVar[int]
    RECALLED: ClassVar[int]
    LOST: ClassVar[int]
    goal_id: GoalID
    status: int
    text: str
    def __init__(
        self,
        *,
        goal_id: GoalID = ...,
        status: int = ...,
        text: str = ...,
    ) -> None: ...

class GoalStatusArray(Message):
    header: navette.msgs.std_msgs.msg.Header
    status_list: list[GoalStatus]
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        status_list: list[GoalStatus] = ...,
    ) -> None: ...
