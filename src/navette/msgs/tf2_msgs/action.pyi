# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from navette.msgs.base import Message
import navette.msgs.action_msgs.msg
import navette.msgs.action_msgs.srv
import navette.msgs.builtin_interfaces.msg
import navette.msgs.geometry_msgs.msg
import navette.msgs.service_msgs.msg
import navette.msgs.tf2_msgs.msg
import navette.msgs.unique_identifier_msgs.msg

class LookupTransform_Goal(Message):
    target_frame: str
    source_frame: str
    source_time: navette.msgs.builtin_interfaces.msg.Time
    timeout: navette.msgs.builtin_interfaces.msg.Duration
    target_time: navette.msgs.builtin_interfaces.msg.Time
    fixed_frame: str
    advanced: bool
    def __init__(
        self,
        *,
        target_frame: str = ...,
        source_frame: str = ...,
        source_time: navette.msgs.builtin_interfaces.msg.Time = ...,
        timeout: navette.msgs.builtin_interfaces.msg.Duration = ...,
        target_time: navette.msgs.builtin_interfaces.msg.Time = ...,
        fixed_frame: str = ...,
        advanced: bool = ...,
    ) -> None: ...

class LookupTransform_Result(Message):
    transform: navette.msgs.geometry_msgs.msg.TransformStamped
    error: navette.msgs.tf2_msgs.msg.TF2Error
    def __init__(
        self,
        *,
        transform: navette.msgs.geometry_msgs.msg.TransformStamped = ...,
        error: navette.msgs.tf2_msgs.msg.TF2Error = ...,
    ) -> None: ...

class LookupTransform_Feedback(Message):
    def __init__(self) -> None: ...

class LookupTransform_FeedbackMessage(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    feedback: LookupTransform_Feedback
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        feedback: LookupTransform_Feedback = ...,
    ) -> None: ...

class LookupTransform_SendGoal_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    goal: LookupTransform_Goal
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        goal: LookupTransform_Goal = ...,
    ) -> None: ...

class LookupTransform_SendGoal_Response(Message):
    accepted: bool
    stamp: navette.msgs.builtin_interfaces.msg.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: navette.msgs.builtin_interfaces.msg.Time = ...,
    ) -> None: ...

class LookupTransform_SendGoal_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[LookupTransform_SendGoal_Request]
    response: list[LookupTransform_SendGoal_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[LookupTransform_SendGoal_Request] = ...,
        response: list[LookupTransform_SendGoal_Response] = ...,
    ) -> None: ...

class LookupTransform_SendGoal:
    Request = LookupTransform_SendGoal_Request
    Response = LookupTransform_SendGoal_Response
    Event = LookupTransform_SendGoal_Event

class LookupTransform_GetResult_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
    ) -> None: ...

class LookupTransform_GetResult_Response(Message):
    status: int
    result: LookupTransform_Result
    def __init__(
        self,
        *,
        status: int = ...,
        result: LookupTransform_Result = ...,
    ) -> None: ...

class LookupTransform_GetResult_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[LookupTransform_GetResult_Request]
    response: list[LookupTransform_GetResult_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[LookupTransform_GetResult_Request] = ...,
        response: list[LookupTransform_GetResult_Response] = ...,
    ) -> None: ...

class LookupTransform_GetResult:
    Request = LookupTransform_GetResult_Request
    Response = LookupTransform_GetResult_Response
    Event = LookupTransform_GetResult_Event

class LookupTransform:
    Goal = LookupTransform_Goal
    Result = LookupTransform_Result
    Feedback = LookupTransform_Feedback
    class Impl:
        SendGoalService = LookupTransform_SendGoal
        GetResultService = LookupTransform_GetResult
        FeedbackMessage = LookupTransform_FeedbackMessage
        CancelGoalService = navette.msgs.action_msgs.srv.CancelGoal
        GoalStatusMessage = navette.msgs.action_msgs.msg.GoalStatusArray
