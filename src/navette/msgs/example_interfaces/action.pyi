# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from array import array

from numpy.typing import ArrayLike, NDArray

from navette.msgs.base import Message
import navette.msgs.action_msgs.msg
import navette.msgs.action_msgs.srv
import navette.msgs.builtin_interfaces.msg
import navette.msgs.service_msgs.msg
import navette.msgs.unique_identifier_msgs.msg

class Fibonacci_Goal(Message):
    order: int
    def __init__(
        self,
        *,
        order: int = ...,
    ) -> None: ...

class Fibonacci_Result(Message):
    @property
    def sequence(self) -> array[int]: ...
    @sequence.setter
    def sequence(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        sequence: ArrayLike = ...,
    ) -> None: ...

class Fibonacci_Feedback(Message):
    @property
    def sequence(self) -> array[int]: ...
    @sequence.setter
    def sequence(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        sequence: ArrayLike = ...,
    ) -> None: ...

class Fibonacci_FeedbackMessage(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    feedback: Fibonacci_Feedback
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        feedback: Fibonacci_Feedback = ...,
    ) -> None: ...

class Fibonacci_SendGoal_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    goal: Fibonacci_Goal
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        goal: Fibonacci_Goal = ...,
    ) -> None: ...

class Fibonacci_SendGoal_Response(Message):
    accepted: bool
    stamp: navette.msgs.builtin_interfaces.msg.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: navette.msgs.builtin_interfaces.msg.Time = ...,
    ) -> None: ...

class Fibonacci_SendGoal_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[Fibonacci_SendGoal_Request]
    response: list[Fibonacci_SendGoal_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[Fibonacci_SendGoal_Request] = ...,
        response: list[Fibonacci_SendGoal_Response] = ...,
    ) -> None: ...

class Fibonacci_SendGoal:
    Request = Fibonacci_SendGoal_Request
    Response = Fibonacci_SendGoal_Response
    Event = Fibonacci_SendGoal_Event

class Fibonacci_GetResult_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
    ) -> None: ...

class Fibonacci_GetResult_Response(Message):
    status: int
    result: Fibonacci_Result
    def __init__(
        self,
        *,
        status: int = ...,
        result: Fibonacci_Result = ...,
    ) -> None: ...

class Fibonacci_GetResult_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[Fibonacci_GetResult_Request]
    response: list[Fibonacci_GetResult_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[Fibonacci_GetResult_Request] = ...,
        response: list[Fibonacci_GetResult_Response] = ...,
    ) -> None: ...

class Fibonacci_GetResult:
    Request = Fibonacci_GetResult_Request
    Response = Fibonacci_GetResult_Response
    Event = Fibonacci_GetResult_Event

class Fibonacci:
    Goal = Fibonacci_Goal
    Result = Fibonacci_Result
    Feedback = Fibonacci_Feedback
    class Impl:
        SendGoalService = Fibonacci_SendGoal
        GetResultService = Fibonacci_GetResult
        FeedbackMessage = Fibonacci_FeedbackMessage
        CancelGoalService = navette.msgs.action_msgs.srv.CancelGoal
        GoalStatusMessage = navette.msgs.action_msgs.msg.GoalStatusArray
