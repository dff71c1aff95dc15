"""The messages that services and actions are carried by.

Follows rosidl's expansion: a service gets an event message for introspection, an action
becomes two services and a feedback message.
"""

from navette.msgs.interface import (
    ActionSpec,
    Field,
    FieldType,
    MessageSpec,
    ServiceSpec,
)

_TIME = FieldType("builtin_interfaces/msg/Time")
_GOAL_ID = Field("goal_id", FieldType("unique_identifier_msgs/msg/UUID"))
_EVENT_INFO = Field("info", FieldType("service_msgs/msg/ServiceEventInfo"))


def make_service(name: str, request: MessageSpec, response: MessageSpec) -> ServiceSpec:
    """The service with its event message."""
    event = MessageSpec(
        f"{name}_Event",
        (
            _EVENT_INFO,
            Field("request", FieldType(request.name, "sequence", 1)),
            Field("response", FieldType(response.name, "sequence", 1)),
        ),
    )
    return ServiceSpec(name, request, response, event)


def make_action(
    name: str, goal: MessageSpec, result: MessageSpec, feedback: MessageSpec
) -> ActionSpec:
    """The action with its two services and its feedback message."""
    send_goal = make_service(
        f"{name}_SendGoal",
        MessageSpec(
            f"{name}_SendGoal_Request",
            (_GOAL_ID, Field("goal", FieldType(goal.name))),
        ),
        MessageSpec(
            f"{name}_SendGoal_Response",
            (Field("accepted", FieldType("bool")), Field("stamp", _TIME)),
        ),
    )
    get_result = make_service(
        f"{name}_GetResult",
        MessageSpec(f"{name}_GetResult_Request", (_GOAL_ID,)),
        MessageSpec(
            f"{name}_GetResult_Response",
            (
                Field("status", FieldType("int8")),
                Field("result", FieldType(result.name)),
            ),
        ),
    )
    feedback_message = MessageSpec(
        f"{name}_FeedbackMessage",
        (_GOAL_ID, Field("feedback", FieldType(feedback.name))),
    )
    return ActionSpec(
        name, goal, result, feedback, send_goal, get_result, feedback_message
    )
