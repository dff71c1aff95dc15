# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from navette.msgs.base import Message
import navette.msgs.lifecycle_msgs.msg
import navette.msgs.service_msgs.msg

class ChangeState_Request(Message):
    transition: navette.msgs.lifecycle_msgs.msg.Transition
    def __init__(
        self,
        *,
        transition: navette.msgs.lifecycle_msgs.msg.Transition = ...,
    ) -> None: ...

class ChangeState_Response(Message):
    success: bool
    def __init__(
        self,
        *,
        success: bool = ...,
    ) -> None: ...

class ChangeState_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[ChangeState_Request]
    response: list[ChangeState_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[ChangeState_Request] = ...,
        response: list[ChangeState_Response] = ...,
    ) -> None: ...

class ChangeState:
    Request = ChangeState_Request
    Response = ChangeState_Response
    Event = ChangeState_Event

class GetAvailableStates_Request(Message):
    def __init__(self) -> None: ...

class GetAvailableStates_Response(Message):
    available_states: list[navette.msgs.lifecycle_msgs.msg.State]
    def __init__(
        self,
        *,
        available_states: list[navette.msgs.lifecycle_msgs.msg.State] = ...,
    ) -> None: ...

class GetAvailableStates_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[GetAvailableStates_Request]
    response: list[GetAvailableStates_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[GetAvailableStates_Request] = ...,
        response: list[GetAvailableStates_Response] = ...,
    ) -> None: ...

class GetAvailableStates:
    Request = GetAvailableStates_Request
    Response = GetAvailableStates_Response
    Event = GetAvailableStates_Event

class GetAvailableTransitions_Request(Message):
    def __init__(self) -> None: ...

class GetAvailableTransitions_Response(Message):
    available_transitions: list[navette.msgs.lifecycle_msgs.msg.TransitionDescription]
    def __init__(
        self,
        *,
        available_transitions: list[navette.msgs.lifecycle_msgs.msg.TransitionDescription] = ...,
    ) -> None: ...

class GetAvailableTransitions_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[GetAvailableTransitions_Request]
    response: list[GetAvailableTransitions_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[GetAvailableTransitions_Request] = ...,
        response: list[GetAvailableTransitions_Response] = ...,
    ) -> None: ...

class GetAvailableTransitions:
    Request = GetAvailableTransitions_Request
    Response = GetAvailableTransitions_Response
    Event = GetAvailableTransitions_Event

class GetState_Request(Message):
    def __init__(self) -> None: ...

class GetState_Response(Message):
    current_state: navette.msgs.lifecycle_msgs.msg.State
    def __init__(
        self,
        *,
        current_state: navette.msgs.lifecycle_msgs.msg.State = ...,
    ) -> None: ...

class GetState_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[GetState_Request]
    response: list[GetState_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[GetState_Request] = ...,
        response: list[GetState_Response] = ...,
    ) -> None: ...

class GetState:
    Request = GetState_Request
    Response = GetState_Response
    Event = GetState_Event
