# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from typing import ClassVar

from navette.msgs.base import Message
import navette.msgs.action_msgs.msg
import navette.msgs.service_msgs.msg

class CancelGoal_Request(Message):
    goal_info: navette.msgs.action_msgs.msg.GoalInfo
    def __init__(
        self,
        *,
        goal_info: navette.msgs.action_msgs.msg.GoalInfo = ...,
    ) -> None: ...

class CancelGoal_Response(Message):
    ERROR_NONE: ClassVar[int]
    ERROR_REJECTED: ClassVar[int]
    ERROR_UNKNOWN_GOAL_ID: ClassVar[int]
    ERROR_GOAL_TERMINATED: ClassVar[int]
    return_code: int
    goals_canceling: list[navette.msgs.action_msgs.msg.GoalInfo]
    def __init__(
        self,
        *,
        return_code: int = ...,
        goals_canceling: list[navette.msgs.action_msgs.msg.GoalInfo] = ...,
    ) -> None: ...

class CancelGoal_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[CancelGoal_Request]
    response: list[CancelGoal_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[CancelGoal_Request] = ...,
        response: list[CancelGoal_Response] = ...,
    ) -> None: ...

class CancelGoal:
    Request = CancelGoal_Request
    Response = CancelGoal_Response
    Event = CancelGoal_Event
