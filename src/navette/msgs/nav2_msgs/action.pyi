# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from typing import ClassVar

from navette.msgs.base import Message
import navette.msgs.action_msgs.msg
import navette.msgs.action_msgs.srv
import navette.msgs.builtin_interfaces.msg
import navette.msgs.geographic_msgs.msg
import navette.msgs.geometry_msgs.msg
import navette.msgs.nav2_msgs.msg
import navette.msgs.nav_msgs.msg
import navette.msgs.service_msgs.msg
import navette.msgs.std_msgs.msg
import navette.msgs.unique_identifier_msgs.msg

class AssistedTeleop_Goal(Message):
    time_allowance: navette.msgs.builtin_interfaces.msg.Duration
    def __init__(
        self,
        *,
        time_allowance: navette.msgs.builtin_interfaces.msg.Duration = ...,
    ) -> None: ...

class AssistedTeleop_Result(Message):
    NONE: ClassVar[int]
    UNKNOWN: ClassVar[int]
    TIMEOUT: ClassVar[int]
    TF_ERROR: ClassVar[int]
    total_elapsed_time: navette.msgs.builtin_interfaces.msg.Duration
    error_code: int
    error_msg: str
    def __init__(
        self,
        *,
        total_elapsed_time: navette.msgs.builtin_interfaces.msg.Duration = ...,
        error_code: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class AssistedTeleop_Feedback(Message):
    current_teleop_duration: navette.msgs.builtin_interfaces.msg.Duration
    def __init__(
        self,
        *,
        current_teleop_duration: navette.msgs.builtin_interfaces.msg.Duration = ...,
    ) -> None: ...

class AssistedTeleop_FeedbackMessage(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    feedback: AssistedTeleop_Feedback
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        feedback: AssistedTeleop_Feedback = ...,
    ) -> None: ...

class AssistedTeleop_SendGoal_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    goal: AssistedTeleop_Goal
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        goal: AssistedTeleop_Goal = ...,
    ) -> None: ...

class AssistedTeleop_SendGoal_Response(Message):
    accepted: bool
    stamp: navette.msgs.builtin_interfaces.msg.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: navette.msgs.builtin_interfaces.msg.Time = ...,
    ) -> None: ...

class AssistedTeleop_SendGoal_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[AssistedTeleop_SendGoal_Request]
    response: list[AssistedTeleop_SendGoal_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[AssistedTeleop_SendGoal_Request] = ...,
        response: list[AssistedTeleop_SendGoal_Response] = ...,
    ) -> None: ...

class AssistedTeleop_SendGoal:
    Request = AssistedTeleop_SendGoal_Request
    Response = AssistedTeleop_SendGoal_Response
    Event = AssistedTeleop_SendGoal_Event

class AssistedTeleop_GetResult_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
    ) -> None: ...

class AssistedTeleop_GetResult_Response(Message):
    status: int
    result: AssistedTeleop_Result
    def __init__(
        self,
        *,
        status: int = ...,
        result: AssistedTeleop_Result = ...,
    ) -> None: ...

class AssistedTeleop_GetResult_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[AssistedTeleop_GetResult_Request]
    response: list[AssistedTeleop_GetResult_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[AssistedTeleop_GetResult_Request] = ...,
        response: list[AssistedTeleop_GetResult_Response] = ...,
    ) -> None: ...

class AssistedTeleop_GetResult:
    Request = AssistedTeleop_GetResult_Request
    Response = AssistedTeleop_GetResult_Response
    Event = AssistedTeleop_GetResult_Event

class AssistedTeleop:
    Goal = AssistedTeleop_Goal
    Result = AssistedTeleop_Result
    Feedback = AssistedTeleop_Feedback
    class Impl:
        SendGoalService = AssistedTeleop_SendGoal
        GetResultService = AssistedTeleop_GetResult
        FeedbackMessage = AssistedTeleop_FeedbackMessage
        CancelGoalService = navette.msgs.action_msgs.srv.CancelGoal
        GoalStatusMessage = navette.msgs.action_msgs.msg.GoalStatusArray

class BackUp_Goal(Message):
    target: navette.msgs.geometry_msgs.msg.Point
    speed: float
    time_allowance: navette.msgs.builtin_interfaces.msg.Duration
    def __init__(
        self,
        *,
        target: navette.msgs.geometry_msgs.msg.Point = ...,
        speed: float = ...,
        time_allowance: navette.msgs.builtin_interfaces.msg.Duration = ...,
    ) -> None: ...

class BackUp_Result(Message):
    NONE: ClassVar[int]
    UNKNOWN: ClassVar[int]
    TIMEOUT: ClassVar[int]
    TF_ERROR: ClassVar[int]
    INVALID_INPUT: ClassVar[int]
    COLLISION_AHEAD: ClassVar[int]
    total_elapsed_time: navette.msgs.builtin_interfaces.msg.Duration
    error_code: int
    error_msg: str
    def __init__(
        self,
        *,
        total_elapsed_time: navette.msgs.builtin_interfaces.msg.Duration = ...,
        error_code: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class BackUp_Feedback(Message):
    distance_traveled: float
    def __init__(
        self,
        *,
        distance_traveled: float = ...,
    ) -> None: ...

class BackUp_FeedbackMessage(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    feedback: BackUp_Feedback
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        feedback: BackUp_Feedback = ...,
    ) -> None: ...

class BackUp_SendGoal_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    goal: BackUp_Goal
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        goal: BackUp_Goal = ...,
    ) -> None: ...

class BackUp_SendGoal_Response(Message):
    accepted: bool
    stamp: navette.msgs.builtin_interfaces.msg.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: navette.msgs.builtin_interfaces.msg.Time = ...,
    ) -> None: ...

class BackUp_SendGoal_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[BackUp_SendGoal_Request]
    response: list[BackUp_SendGoal_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[BackUp_SendGoal_Request] = ...,
        response: list[BackUp_SendGoal_Response] = ...,
    ) -> None: ...

class BackUp_SendGoal:
    Request = BackUp_SendGoal_Request
    Response = BackUp_SendGoal_Response
    Event = BackUp_SendGoal_Event

class BackUp_GetResult_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
    ) -> None: ...

class BackUp_GetResult_Response(Message):
    status: int
    result: BackUp_Result
    def __init__(
        self,
        *,
        status: int = ...,
        result: BackUp_Result = ...,
    ) -> None: ...

class BackUp_GetResult_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[BackUp_GetResult_Request]
    response: list[BackUp_GetResult_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[BackUp_GetResult_Request] = ...,
        response: list[BackUp_GetResult_Response] = ...,
    ) -> None: ...

class BackUp_GetResult:
    Request = BackUp_GetResult_Request
    Response = BackUp_GetResult_Response
    Event = BackUp_GetResult_Event

class BackUp:
    Goal = BackUp_Goal
    Result = BackUp_Result
    Feedback = BackUp_Feedback
    class Impl:
        SendGoalService = BackUp_SendGoal
        GetResultService = BackUp_GetResult
        FeedbackMessage = BackUp_FeedbackMessage
        CancelGoalService = navette.msgs.action_msgs.srv.CancelGoal
        GoalStatusMessage = navette.msgs.action_msgs.msg.GoalStatusArray

class ComputeAndTrackRoute_Goal(Message):
    start_id: int
    start: navette.msgs.geometry_msgs.msg.PoseStamped
    goal_id: int
    goal: navette.msgs.geometry_msgs.msg.PoseStamped
    use_start: bool
    use_poses: bool
    def __init__(
        self,
        *,
        start_id: int = ...,
        start: navette.msgs.geometry_msgs.msg.PoseStamped = ...,
        goal_id: int = ...,
        goal: navette.msgs.geometry_msgs.msg.PoseStamped = ...,
        use_start: bool = ...,
        use_poses: bool = ...,
    ) -> None: ...

class ComputeAndTrackRoute_Result(Message):
    NONE: ClassVar[int]
    UNKNOWN: ClassVar[int]
    TF_ERROR: ClassVar[int]
    NO_VALID_GRAPH: ClassVar[int]
    INDETERMINANT_NODES_ON_GRAPH: ClassVar[int]
    TIMEOUT: ClassVar[int]
    NO_VALID_ROUTE: ClassVar[int]
    OPERATION_FAILED: ClassVar[int]
    INVALID_EDGE_SCORER_USE: ClassVar[int]
    execution_duration: navette.msgs.builtin_interfaces.msg.Duration
    error_code: int
    def __init__(
        self,
        *,
        execution_duration: navette.msgs.builtin_interfaces.msg.Duration = ...,
        error_code: int = ...,
    ) -> None: ...

class ComputeAndTrackRoute_Feedback(Message):
    last_node_id: int
    next_node_id: int
    current_edge_id: int
    route: navette.msgs.nav2_msgs.msg.Route
    path: navette.msgs.nav_msgs.msg.Path
    operations_triggered: list[str]
    rerouted: bool
    def __init__(
        self,
        *,
        last_node_id: int = ...,
        next_node_id: int = ...,
        current_edge_id: int = ...,
        route: navette.msgs.nav2_msgs.msg.Route = ...,
        path: navette.msgs.nav_msgs.msg.Path = ...,
        operations_triggered: list[str] = ...,
        rerouted: bool = ...,
    ) -> None: ...

class ComputeAndTrackRoute_FeedbackMessage(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    feedback: ComputeAndTrackRoute_Feedback
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        feedback: ComputeAndTrackRoute_Feedback = ...,
    ) -> None: ...

class ComputeAndTrackRoute_SendGoal_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    goal: ComputeAndTrackRoute_Goal
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        goal: ComputeAndTrackRoute_Goal = ...,
    ) -> None: ...

class ComputeAndTrackRoute_SendGoal_Response(Message):
    accepted: bool
    stamp: navette.msgs.builtin_interfaces.msg.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: navette.msgs.builtin_interfaces.msg.Time = ...,
    ) -> None: ...

class ComputeAndTrackRoute_SendGoal_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[ComputeAndTrackRoute_SendGoal_Request]
    response: list[ComputeAndTrackRoute_SendGoal_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[ComputeAndTrackRoute_SendGoal_Request] = ...,
        response: list[ComputeAndTrackRoute_SendGoal_Response] = ...,
    ) -> None: ...

class ComputeAndTrackRoute_SendGoal:
    Request = ComputeAndTrackRoute_SendGoal_Request
    Response = ComputeAndTrackRoute_SendGoal_Response
    Event = ComputeAndTrackRoute_SendGoal_Event

class ComputeAndTrackRoute_GetResult_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
    ) -> None: ...

class ComputeAndTrackRoute_GetResult_Response(Message):
    status: int
    result: ComputeAndTrackRoute_Result
    def __init__(
        self,
        *,
        status: int = ...,
        result: ComputeAndTrackRoute_Result = ...,
    ) -> None: ...

class ComputeAndTrackRoute_GetResult_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[ComputeAndTrackRoute_GetResult_Request]
    response: list[ComputeAndTrackRoute_GetResult_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[ComputeAndTrackRoute_GetResult_Request] = ...,
        response: list[ComputeAndTrackRoute_GetResult_Response] = ...,
    ) -> None: ...

class ComputeAndTrackRoute_GetResult:
    Request = ComputeAndTrackRoute_GetResult_Request
    Response = ComputeAndTrackRoute_GetResult_Response
    Event = ComputeAndTrackRoute_GetResult_Event

class ComputeAndTrackRoute:
    Goal = ComputeAndTrackRoute_Goal
    Result = ComputeAndTrackRoute_Result
    Feedback = ComputeAndTrackRoute_Feedback
    class Impl:
        SendGoalService = ComputeAndTrackRoute_SendGoal
        GetResultService = ComputeAndTrackRoute_GetResult
        FeedbackMessage = ComputeAndTrackRoute_FeedbackMessage
        CancelGoalService = navette.msgs.action_msgs.srv.CancelGoal
        GoalStatusMessage = navette.msgs.action_msgs.msg.GoalStatusArray

class ComputePathThroughPoses_Goal(Message):
    goals: list[navette.msgs.geometry_msgs.msg.PoseStamped]
    start: navette.msgs.geometry_msgs.msg.PoseStamped
    planner_id: str
    use_start: bool
    def __init__(
        self,
        *,
        goals: list[navette.msgs.geometry_msgs.msg.PoseStamped] = ...,
        start: navette.msgs.geometry_msgs.msg.PoseStamped = ...,
        planner_id: str = ...,
        use_start: bool = ...,
    ) -> None: ...

class ComputePathThroughPoses_Result(Message):
    NONE: ClassVar[int]
    UNKNOWN: ClassVar[int]
    INVALID_PLANNER: ClassVar[int]
    TF_ERROR: ClassVar[int]
    START_OUTSIDE_MAP: ClassVar[int]
    GOAL_OUTSIDE_MAP: ClassVar[int]
    START_OCCUPIED: ClassVar[int]
    GOAL_OCCUPIED: ClassVar[int]
    TIMEOUT: ClassVar[int]
    NO_VALID_PATH: ClassVar[int]
    NO_VIAPOINTS_GIVEN: ClassVar[int]
    path: navette.msgs.nav_msgs.msg.Path
    planning_time: navette.msgs.builtin_interfaces.msg.Duration
    error_code: int
    error_msg: str
    def __init__(
        self,
        *,
        path: navette.msgs.nav_msgs.msg.Path = ...,
        planning_time: navette.msgs.builtin_interfaces.msg.Duration = ...,
        error_code: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class ComputePathThroughPoses_Feedback(Message):
    def __init__(self) -> None: ...

class ComputePathThroughPoses_FeedbackMessage(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    feedback: ComputePathThroughPoses_Feedback
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        feedback: ComputePathThroughPoses_Feedback = ...,
    ) -> None: ...

class ComputePathThroughPoses_SendGoal_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    goal: ComputePathThroughPoses_Goal
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        goal: ComputePathThroughPoses_Goal = ...,
    ) -> None: ...

class ComputePathThroughPoses_SendGoal_Response(Message):
    accepted: bool
    stamp: navette.msgs.builtin_interfaces.msg.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: navette.msgs.builtin_interfaces.msg.Time = ...,
    ) -> None: ...

class ComputePathThroughPoses_SendGoal_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[ComputePathThroughPoses_SendGoal_Request]
    response: list[ComputePathThroughPoses_SendGoal_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[ComputePathThroughPoses_SendGoal_Request] = ...,
        response: list[ComputePathThroughPoses_SendGoal_Response] = ...,
    ) -> None: ...

class ComputePathThroughPoses_SendGoal:
    Request = ComputePathThroughPoses_SendGoal_Request
    Response = ComputePathThroughPoses_SendGoal_Response
    Event = ComputePathThroughPoses_SendGoal_Event

class ComputePathThroughPoses_GetResult_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
    ) -> None: ...

class ComputePathThroughPoses_GetResult_Response(Message):
    status: int
    result: ComputePathThroughPoses_Result
    def __init__(
        self,
        *,
        status: int = ...,
        result: ComputePathThroughPoses_Result = ...,
    ) -> None: ...

class ComputePathThroughPoses_GetResult_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[ComputePathThroughPoses_GetResult_Request]
    response: list[ComputePathThroughPoses_GetResult_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[ComputePathThroughPoses_GetResult_Request] = ...,
        response: list[ComputePathThroughPoses_GetResult_Response] = ...,
    ) -> None: ...

class ComputePathThroughPoses_GetResult:
    Request = ComputePathThroughPoses_GetResult_Request
    Response = ComputePathThroughPoses_GetResult_Response
    Event = ComputePathThroughPoses_GetResult_Event

class ComputePathThroughPoses:
    Goal = ComputePathThroughPoses_Goal
    Result = ComputePathThroughPoses_Result
    Feedback = ComputePathThroughPoses_Feedback
    class Impl:
        SendGoalService = ComputePathThroughPoses_SendGoal
        GetResultService = ComputePathThroughPoses_GetResult
        FeedbackMessage = ComputePathThroughPoses_FeedbackMessage
        CancelGoalService = navette.msgs.action_msgs.srv.CancelGoal
        GoalStatusMessage = navette.msgs.action_msgs.msg.GoalStatusArray

class ComputePathToPose_Goal(Message):
    goal: navette.msgs.geometry_msgs.msg.PoseStamped
    start: navette.msgs.geometry_msgs.msg.PoseStamped
    planner_id: str
    use_start: bool
    def __init__(
        self,
        *,
        goal: navette.msgs.geometry_msgs.msg.PoseStamped = ...,
        start: navette.msgs.geometry_msgs.msg.PoseStamped = ...,
        planner_id: str = ...,
        use_start: bool = ...,
    ) -> None: ...

class ComputePathToPose_Result(Message):
    NONE: ClassVar[int]
    UNKNOWN: ClassVar[int]
    INVALID_PLANNER: ClassVar[int]
    TF_ERROR: ClassVar[int]
    START_OUTSIDE_MAP: ClassVar[int]
    GOAL_OUTSIDE_MAP: ClassVar[int]
    START_OCCUPIED: ClassVar[int]
    GOAL_OCCUPIED: ClassVar[int]
    TIMEOUT: ClassVar[int]
    NO_VALID_PATH: ClassVar[int]
    path: navette.msgs.nav_msgs.msg.Path
    planning_time: navette.msgs.builtin_interfaces.msg.Duration
    error_code: int
    error_msg: str
    def __init__(
        self,
        *,
        path: navette.msgs.nav_msgs.msg.Path = ...,
        planning_time: navette.msgs.builtin_interfaces.msg.Duration = ...,
        error_code: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class ComputePathToPose_Feedback(Message):
    def __init__(self) -> None: ...

class ComputePathToPose_FeedbackMessage(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    feedback: ComputePathToPose_Feedback
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        feedback: ComputePathToPose_Feedback = ...,
    ) -> None: ...

class ComputePathToPose_SendGoal_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    goal: ComputePathToPose_Goal
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        goal: ComputePathToPose_Goal = ...,
    ) -> None: ...

class ComputePathToPose_SendGoal_Response(Message):
    accepted: bool
    stamp: navette.msgs.builtin_interfaces.msg.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: navette.msgs.builtin_interfaces.msg.Time = ...,
    ) -> None: ...

class ComputePathToPose_SendGoal_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[ComputePathToPose_SendGoal_Request]
    response: list[ComputePathToPose_SendGoal_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[ComputePathToPose_SendGoal_Request] = ...,
        response: list[ComputePathToPose_SendGoal_Response] = ...,
    ) -> None: ...

class ComputePathToPose_SendGoal:
    Request = ComputePathToPose_SendGoal_Request
    Response = ComputePathToPose_SendGoal_Response
    Event = ComputePathToPose_SendGoal_Event

class ComputePathToPose_GetResult_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
    ) -> None: ...

class ComputePathToPose_GetResult_Response(Message):
    status: int
    result: ComputePathToPose_Result
    def __init__(
        self,
        *,
        status: int = ...,
        result: ComputePathToPose_Result = ...,
    ) -> None: ...

class ComputePathToPose_GetResult_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[ComputePathToPose_GetResult_Request]
    response: list[ComputePathToPose_GetResult_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[ComputePathToPose_GetResult_Request] = ...,
        response: list[ComputePathToPose_GetResult_Response] = ...,
    ) -> None: ...

class ComputePathToPose_GetResult:
    Request = ComputePathToPose_GetResult_Request
    Response = ComputePathToPose_GetResult_Response
    Event = ComputePathToPose_GetResult_Event

class ComputePathToPose:
    Goal = ComputePathToPose_Goal
    Result = ComputePathToPose_Result
    Feedback = ComputePathToPose_Feedback
    class Impl:
        SendGoalService = ComputePathToPose_SendGoal
        GetResultService = ComputePathToPose_GetResult
        FeedbackMessage = ComputePathToPose_FeedbackMessage
        CancelGoalService = navette.msgs.action_msgs.srv.CancelGoal
        GoalStatusMessage = navette.msgs.action_msgs.msg.GoalStatusArray

class ComputeRoute_Goal(Message):
    start_id: int
    start: navette.msgs.geometry_msgs.msg.PoseStamped
    goal_id: int
    goal: navette.msgs.geometry_msgs.msg.PoseStamped
    use_start: bool
    use_poses: bool
    def __init__(
        self,
        *,
        start_id: int = ...,
        start: navette.msgs.geometry_msgs.msg.PoseStamped = ...,
        goal_id: int = ...,
        goal: navette.msgs.geometry_msgs.msg.PoseStamped = ...,
        use_start: bool = ...,
        use_poses: bool = ...,
    ) -> None: ...

class ComputeRoute_Result(Message):
    NONE: ClassVar[int]
    UNKNOWN: ClassVar[int]
    TF_ERROR: ClassVar[int]
    NO_VALID_GRAPH: ClassVar[int]
    INDETERMINANT_NODES_ON_GRAPH: ClassVar[int]
    TIMEOUT: ClassVar[int]
    NO_VALID_ROUTE: ClassVar[int]
    INVALID_EDGE_SCORER_USE: ClassVar[int]
    planning_time: navette.msgs.builtin_interfaces.msg.Duration
    path: navette.msgs.nav_msgs.msg.Path
    route: navette.msgs.nav2_msgs.msg.Route
    error_code: int
    def __init__(
        self,
        *,
        planning_time: navette.msgs.builtin_interfaces.msg.Duration = ...,
        path: navette.msgs.nav_msgs.msg.Path = ...,
        route: navette.msgs.nav2_msgs.msg.Route = ...,
        error_code: int = ...,
    ) -> None: ...

class ComputeRoute_Feedback(Message):
    def __init__(self) -> None: ...

class ComputeRoute_FeedbackMessage(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    feedback: ComputeRoute_Feedback
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        feedback: ComputeRoute_Feedback = ...,
    ) -> None: ...

class ComputeRoute_SendGoal_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    goal: ComputeRoute_Goal
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        goal: ComputeRoute_Goal = ...,
    ) -> None: ...

class ComputeRoute_SendGoal_Response(Message):
    accepted: bool
    stamp: navette.msgs.builtin_interfaces.msg.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: navette.msgs.builtin_interfaces.msg.Time = ...,
    ) -> None: ...

class ComputeRoute_SendGoal_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[ComputeRoute_SendGoal_Request]
    response: list[ComputeRoute_SendGoal_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[ComputeRoute_SendGoal_Request] = ...,
        response: list[ComputeRoute_SendGoal_Response] = ...,
    ) -> None: ...

class ComputeRoute_SendGoal:
    Request = ComputeRoute_SendGoal_Request
    Response = ComputeRoute_SendGoal_Response
    Event = ComputeRoute_SendGoal_Event

class ComputeRoute_GetResult_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
    ) -> None: ...

class ComputeRoute_GetResult_Response(Message):
    status: int
    result: ComputeRoute_Result
    def __init__(
        self,
        *,
        status: int = ...,
        result: ComputeRoute_Result = ...,
    ) -> None: ...

class ComputeRoute_GetResult_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[ComputeRoute_GetResult_Request]
    response: list[ComputeRoute_GetResult_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[ComputeRoute_GetResult_Request] = ...,
        response: list[ComputeRoute_GetResult_Response] = ...,
    ) -> None: ...

class ComputeRoute_GetResult:
    Request = ComputeRoute_GetResult_Request
    Response = ComputeRoute_GetResult_Response
    Event = ComputeRoute_GetResult_Event

class ComputeRoute:
    Goal = ComputeRoute_Goal
    Result = ComputeRoute_Result
    Feedback = ComputeRoute_Feedback
    class Impl:
        SendGoalService = ComputeRoute_SendGoal
        GetResultService = ComputeRoute_GetResult
        FeedbackMessage = ComputeRoute_FeedbackMessage
        CancelGoalService = navette.msgs.action_msgs.srv.CancelGoal
        GoalStatusMessage = navette.msgs.action_msgs.msg.GoalStatusArray

class DockRobot_Goal(Message):
    use_dock_id: bool
    dock_id: str
    dock_pose: navette.msgs.geometry_msgs.msg.PoseStamped
    dock_type: str
    max_staging_time: float
    navigate_to_staging_pose: bool
    def __init__(
        self,
        *,
        use_dock_id: bool = ...,
        dock_id: str = ...,
        dock_pose: navette.msgs.geometry_msgs.msg.PoseStamped = ...,
        dock_type: str = ...,
        max_staging_time: float = ...,
        navigate_to_staging_pose: bool = ...,
    ) -> None: ...

class DockRobot_Result(Message):
    NONE: ClassVar[int]
    DOCK_NOT_IN_DB: ClassVar[int]
    DOCK_NOT_VALID: ClassVar[int]
    FAILED_TO_STAGE: ClassVar[int]
    FAILED_TO_DETECT_DOCK: ClassVar[int]
    FAILED_TO_CONTROL: ClassVar[int]
    FAILED_TO_CHARGE: ClassVar[int]
    UNKNOWN: ClassVar[int]
    success: bool
    error_code: int
    num_retries: int
    error_msg: str
    def __init__(
        self,
        *,
        success: bool = ...,
        error_code: int = ...,
        num_retries: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class DockRobot_Feedback(Message):
    NONE: ClassVar[int]
    NAV_TO_STAGING_POSE: ClassVar[int]
    INITIAL_PERCEPTION: ClassVar[int]
    CONTROLLING: ClassVar[int]
    WAIT_FOR_CHARGE: ClassVar[int]
    RETRY: ClassVar[int]
    state: int
    docking_time: navette.msgs.builtin_interfaces.msg.Duration
    num_retries: int
    def __init__(
        self,
        *,
        state: int = ...,
        docking_time: navette.msgs.builtin_interfaces.msg.Duration = ...,
        num_retries: int = ...,
    ) -> None: ...

class DockRobot_FeedbackMessage(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    feedback: DockRobot_Feedback
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        feedback: DockRobot_Feedback = ...,
    ) -> None: ...

class DockRobot_SendGoal_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    goal: DockRobot_Goal
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        goal: DockRobot_Goal = ...,
    ) -> None: ...

class DockRobot_SendGoal_Response(Message):
    accepted: bool
    stamp: navette.msgs.builtin_interfaces.msg.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: navette.msgs.builtin_interfaces.msg.Time = ...,
    ) -> None: ...

class DockRobot_SendGoal_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[DockRobot_SendGoal_Request]
    response: list[DockRobot_SendGoal_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[DockRobot_SendGoal_Request] = ...,
        response: list[DockRobot_SendGoal_Response] = ...,
    ) -> None: ...

class DockRobot_SendGoal:
    Request = DockRobot_SendGoal_Request
    Response = DockRobot_SendGoal_Response
    Event = DockRobot_SendGoal_Event

class DockRobot_GetResult_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
    ) -> None: ...

class DockRobot_GetResult_Response(Message):
    status: int
    result: DockRobot_Result
    def __init__(
        self,
        *,
        status: int = ...,
        result: DockRobot_Result = ...,
    ) -> None: ...

class DockRobot_GetResult_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[DockRobot_GetResult_Request]
    response: list[DockRobot_GetResult_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[DockRobot_GetResult_Request] = ...,
        response: list[DockRobot_GetResult_Response] = ...,
    ) -> None: ...

class DockRobot_GetResult:
    Request = DockRobot_GetResult_Request
    Response = DockRobot_GetResult_Response
    Event = DockRobot_GetResult_Event

class DockRobot:
    Goal = DockRobot_Goal
    Result = DockRobot_Result
    Feedback = DockRobot_Feedback
    class Impl:
        SendGoalService = DockRobot_SendGoal
        GetResultService = DockRobot_GetResult
        FeedbackMessage = DockRobot_FeedbackMessage
        CancelGoalService = navette.msgs.action_msgs.srv.CancelGoal
        GoalStatusMessage = navette.msgs.action_msgs.msg.GoalStatusArray

class DriveOnHeading_Goal(Message):
    target: navette.msgs.geometry_msgs.msg.Point
    speed: float
    time_allowance: navette.msgs.builtin_interfaces.msg.Duration
    def __init__(
        self,
        *,
        target: navette.msgs.geometry_msgs.msg.Point = ...,
        speed: float = ...,
        time_allowance: navette.msgs.builtin_interfaces.msg.Duration = ...,
    ) -> None: ...

class DriveOnHeading_Result(Message):
    NONE: ClassVar[int]
    UNKNOWN: ClassVar[int]
    TIMEOUT: ClassVar[int]
    TF_ERROR: ClassVar[int]
    COLLISION_AHEAD: ClassVar[int]
    INVALID_INPUT: ClassVar[int]
    total_elapsed_time: navette.msgs.builtin_interfaces.msg.Duration
    error_code: int
    error_msg: str
    def __init__(
        self,
        *,
        total_elapsed_time: navette.msgs.builtin_interfaces.msg.Duration = ...,
        error_code: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class DriveOnHeading_Feedback(Message):
    distance_traveled: float
    def __init__(
        self,
        *,
        distance_traveled: float = ...,
    ) -> None: ...

class DriveOnHeading_FeedbackMessage(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    feedback: DriveOnHeading_Feedback
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        feedback: DriveOnHeading_Feedback = ...,
    ) -> None: ...

class DriveOnHeading_SendGoal_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    goal: DriveOnHeading_Goal
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        goal: DriveOnHeading_Goal = ...,
    ) -> None: ...

class DriveOnHeading_SendGoal_Response(Message):
    accepted: bool
    stamp: navette.msgs.builtin_interfaces.msg.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: navette.msgs.builtin_interfaces.msg.Time = ...,
    ) -> None: ...

class DriveOnHeading_SendGoal_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[DriveOnHeading_SendGoal_Request]
    response: list[DriveOnHeading_SendGoal_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[DriveOnHeading_SendGoal_Request] = ...,
        response: list[DriveOnHeading_SendGoal_Response] = ...,
    ) -> None: ...

class DriveOnHeading_SendGoal:
    Request = DriveOnHeading_SendGoal_Request
    Response = DriveOnHeading_SendGoal_Response
    Event = DriveOnHeading_SendGoal_Event

class DriveOnHeading_GetResult_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
    ) -> None: ...

class DriveOnHeading_GetResult_Response(Message):
    status: int
    result: DriveOnHeading_Result
    def __init__(
        self,
        *,
        status: int = ...,
        result: DriveOnHeading_Result = ...,
    ) -> None: ...

class DriveOnHeading_GetResult_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[DriveOnHeading_GetResult_Request]
    response: list[DriveOnHeading_GetResult_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[DriveOnHeading_GetResult_Request] = ...,
        response: list[DriveOnHeading_GetResult_Response] = ...,
    ) -> None: ...

class DriveOnHeading_GetResult:
    Request = DriveOnHeading_GetResult_Request
    Response = DriveOnHeading_GetResult_Response
    Event = DriveOnHeading_GetResult_Event

class DriveOnHeading:
    Goal = DriveOnHeading_Goal
    Result = DriveOnHeading_Result
    Feedback = DriveOnHeading_Feedback
    class Impl:
        SendGoalService = DriveOnHeading_SendGoal
        GetResultService = DriveOnHeading_GetResult
        FeedbackMessage = DriveOnHeading_FeedbackMessage
        CancelGoalService = navette.msgs.action_msgs.srv.CancelGoal
        GoalStatusMessage = navette.msgs.action_msgs.msg.GoalStatusArray

class DummyBehavior_Goal(Message):
    command: navette.msgs.std_msgs.msg.String
    def __init__(
        self,
        *,
        command: navette.msgs.std_msgs.msg.String = ...,
    ) -> None: ...

class DummyBehavior_Result(Message):
    total_elapsed_time: navette.msgs.builtin_interfaces.msg.Duration
    error_code: int
    error_msg: str
    def __init__(
        self,
        *,
        total_elapsed_time: navette.msgs.builtin_interfaces.msg.Duration = ...,
        error_code: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class DummyBehavior_Feedback(Message):
    def __init__(self) -> None: ...

class DummyBehavior_FeedbackMessage(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    feedback: DummyBehavior_Feedback
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        feedback: DummyBehavior_Feedback = ...,
    ) -> None: ...

class DummyBehavior_SendGoal_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    goal: DummyBehavior_Goal
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        goal: DummyBehavior_Goal = ...,
    ) -> None: ...

class DummyBehavior_SendGoal_Response(Message):
    accepted: bool
    stamp: navette.msgs.builtin_interfaces.msg.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: navette.msgs.builtin_interfaces.msg.Time = ...,
    ) -> None: ...

class DummyBehavior_SendGoal_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[DummyBehavior_SendGoal_Request]
    response: list[DummyBehavior_SendGoal_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[DummyBehavior_SendGoal_Request] = ...,
        response: list[DummyBehavior_SendGoal_Response] = ...,
    ) -> None: ...

class DummyBehavior_SendGoal:
    Request = DummyBehavior_SendGoal_Request
    Response = DummyBehavior_SendGoal_Response
    Event = DummyBehavior_SendGoal_Event

class DummyBehavior_GetResult_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
    ) -> None: ...

class DummyBehavior_GetResult_Response(Message):
    status: int
    result: DummyBehavior_Result
    def __init__(
        self,
        *,
        status: int = ...,
        result: DummyBehavior_Result = ...,
    ) -> None: ...

class DummyBehavior_GetResult_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[DummyBehavior_GetResult_Request]
    response: list[DummyBehavior_GetResult_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[DummyBehavior_GetResult_Request] = ...,
        response: list[DummyBehavior_GetResult_Response] = ...,
    ) -> None: ...

class DummyBehavior_GetResult:
    Request = DummyBehavior_GetResult_Request
    Response = DummyBehavior_GetResult_Response
    Event = DummyBehavior_GetResult_Event

class DummyBehavior:
    Goal = DummyBehavior_Goal
    Result = DummyBehavior_Result
    Feedback = DummyBehavior_Feedback
    class Impl:
        SendGoalService = DummyBehavior_SendGoal
        GetResultService = DummyBehavior_GetResult
        FeedbackMessage = DummyBehavior_FeedbackMessage
        CancelGoalService = navette.msgs.action_msgs.srv.CancelGoal
        GoalStatusMessage = navette.msgs.action_msgs.msg.GoalStatusArray

class FollowGPSWaypoints_Goal(Message):
    number_of_loops: int
    goal_index: int
    gps_poses: list[navette.msgs.geographic_msgs.msg.GeoPose]
    def __init__(
        self,
        *,
        number_of_loops: int = ...,
        goal_index: int = ...,
        gps_poses: list[navette.msgs.geographic_msgs.msg.GeoPose] = ...,
    ) -> None: ...

class FollowGPSWaypoints_Result(Message):
    NONE: ClassVar[int]
    UNKNOWN: ClassVar[int]
    TASK_EXECUTOR_FAILED: ClassVar[int]
    missed_waypoints: list[navette.msgs.nav2_msgs.msg.MissedWaypoint]
    error_code: int
    error_msg: str
    def __init__(
        self,
        *,
        missed_waypoints: list[navette.msgs.nav2_msgs.msg.MissedWaypoint] = ...,
        error_code: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class FollowGPSWaypoints_Feedback(Message):
    current_waypoint: int
    def __init__(
        self,
        *,
        current_waypoint: int = ...,
    ) -> None: ...

class FollowGPSWaypoints_FeedbackMessage(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    feedback: FollowGPSWaypoints_Feedback
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        feedback: FollowGPSWaypoints_Feedback = ...,
    ) -> None: ...

class FollowGPSWaypoints_SendGoal_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    goal: FollowGPSWaypoints_Goal
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        goal: FollowGPSWaypoints_Goal = ...,
    ) -> None: ...

class FollowGPSWaypoints_SendGoal_Response(Message):
    accepted: bool
    stamp: navette.msgs.builtin_interfaces.msg.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: navette.msgs.builtin_interfaces.msg.Time = ...,
    ) -> None: ...

class FollowGPSWaypoints_SendGoal_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[FollowGPSWaypoints_SendGoal_Request]
    response: list[FollowGPSWaypoints_SendGoal_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[FollowGPSWaypoints_SendGoal_Request] = ...,
        response: list[FollowGPSWaypoints_SendGoal_Response] = ...,
    ) -> None: ...

class FollowGPSWaypoints_SendGoal:
    Request = FollowGPSWaypoints_SendGoal_Request
    Response = FollowGPSWaypoints_SendGoal_Response
    Event = FollowGPSWaypoints_SendGoal_Event

class FollowGPSWaypoints_GetResult_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
    ) -> None: ...

class FollowGPSWaypoints_GetResult_Response(Message):
    status: int
    result: FollowGPSWaypoints_Result
    def __init__(
        self,
        *,
        status: int = ...,
        result: FollowGPSWaypoints_Result = ...,
    ) -> None: ...

class FollowGPSWaypoints_GetResult_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[FollowGPSWaypoints_GetResult_Request]
    response: list[FollowGPSWaypoints_GetResult_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[FollowGPSWaypoints_GetResult_Request] = ...,
        response: list[FollowGPSWaypoints_GetResult_Response] = ...,
    ) -> None: ...

class FollowGPSWaypoints_GetResult:
    Request = FollowGPSWaypoints_GetResult_Request
    Response = FollowGPSWaypoints_GetResult_Response
    Event = FollowGPSWaypoints_GetResult_Event

class FollowGPSWaypoints:
    Goal = FollowGPSWaypoints_Goal
    Result = FollowGPSWaypoints_Result
    Feedback = FollowGPSWaypoints_Feedback
    class Impl:
        SendGoalService = FollowGPSWaypoints_SendGoal
        GetResultService = FollowGPSWaypoints_GetResult
        FeedbackMessage = FollowGPSWaypoints_FeedbackMessage
        CancelGoalService = navette.msgs.action_msgs.srv.CancelGoal
        GoalStatusMessage = navette.msgs.action_msgs.msg.GoalStatusArray

class FollowObject_Goal(Message):
    pose_topic: str
    tracked_frame: str
    max_duration: navette.msgs.builtin_interfaces.msg.Duration
    def __init__(
        self,
        *,
        pose_topic: str = ...,
        tracked_frame: str = ...,
        max_duration: navette.msgs.builtin_interfaces.msg.Duration = ...,
    ) -> None: ...

class FollowObject_Result(Message):
    NONE: ClassVar[int]
    TF_ERROR: ClassVar[int]
    FAILED_TO_DETECT_OBJECT: ClassVar[int]
    FAILED_TO_CONTROL: ClassVar[int]
    TIMEOUT: ClassVar[int]
    UNKNOWN: ClassVar[int]
    total_elapsed_time: navette.msgs.builtin_interfaces.msg.Duration
    error_code: int
    num_retries: int
    error_msg: str
    def __init__(
        self,
        *,
        total_elapsed_time: navette.msgs.builtin_interfaces.msg.Duration = ...,
        error_code: int = ...,
        num_retries: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class FollowObject_Feedback(Message):
    NONE: ClassVar[int]
    INITIAL_PERCEPTION: ClassVar[int]
    CONTROLLING: ClassVar[int]
    STOPPING: ClassVar[int]
    RETRY: ClassVar[int]
    state: int
    following_time: navette.msgs.builtin_interfaces.msg.Duration
    num_retries: int
    def __init__(
        self,
        *,
        state: int = ...,
        following_time: navette.msgs.builtin_interfaces.msg.Duration = ...,
        num_retries: int = ...,
    ) -> None: ...

class FollowObject_FeedbackMessage(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    feedback: FollowObject_Feedback
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        feedback: FollowObject_Feedback = ...,
    ) -> None: ...

class FollowObject_SendGoal_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    goal: FollowObject_Goal
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        goal: FollowObject_Goal = ...,
    ) -> None: ...

class FollowObject_SendGoal_Response(Message):
    accepted: bool
    stamp: navette.msgs.builtin_interfaces.msg.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: navette.msgs.builtin_interfaces.msg.Time = ...,
    ) -> None: ...

class FollowObject_SendGoal_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[FollowObject_SendGoal_Request]
    response: list[FollowObject_SendGoal_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[FollowObject_SendGoal_Request] = ...,
        response: list[FollowObject_SendGoal_Response] = ...,
    ) -> None: ...

class FollowObject_SendGoal:
    Request = FollowObject_SendGoal_Request
    Response = FollowObject_SendGoal_Response
    Event = FollowObject_SendGoal_Event

class FollowObject_GetResult_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
    ) -> None: ...

class FollowObject_GetResult_Response(Message):
    status: int
    result: FollowObject_Result
    def __init__(
        self,
        *,
        status: int = ...,
        result: FollowObject_Result = ...,
    ) -> None: ...

class FollowObject_GetResult_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[FollowObject_GetResult_Request]
    response: list[FollowObject_GetResult_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[FollowObject_GetResult_Request] = ...,
        response: list[FollowObject_GetResult_Response] = ...,
    ) -> None: ...

class FollowObject_GetResult:
    Request = FollowObject_GetResult_Request
    Response = FollowObject_GetResult_Response
    Event = FollowObject_GetResult_Event

class FollowObject:
    Goal = FollowObject_Goal
    Result = FollowObject_Result
    Feedback = FollowObject_Feedback
    class Impl:
        SendGoalService = FollowObject_SendGoal
        GetResultService = FollowObject_GetResult
        FeedbackMessage = FollowObject_FeedbackMessage
        CancelGoalService = navette.msgs.action_msgs.srv.CancelGoal
        GoalStatusMessage = navette.msgs.action_msgs.msg.GoalStatusArray

class FollowPath_Goal(Message):
    path: navette.msgs.nav_msgs.msg.Path
    controller_id: str
    goal_checker_id: str
    progress_checker_id: str
    def __init__(
        self,
        *,
        path: navette.msgs.nav_msgs.msg.Path = ...,
        controller_id: str = ...,
        goal_checker_id: str = ...,
        progress_checker_id: str = ...,
    ) -> None: ...

class FollowPath_Result(Message):
    NONE: ClassVar[int]
    UNKNOWN: ClassVar[int]
    INVALID_CONTROLLER: ClassVar[int]
    TF_ERROR: ClassVar[int]
    INVALID_PATH: ClassVar[int]
    PATIENCE_EXCEEDED: ClassVar[int]
    FAILED_TO_MAKE_PROGRESS: ClassVar[int]
    NO_VALID_CONTROL: ClassVar[int]
    CONTROLLER_TIMED_OUT: ClassVar[int]
    result: navette.msgs.std_msgs.msg.Empty
    error_code: int
    error_msg: str
    def __init__(
        self,
        *,
        result: navette.msgs.std_msgs.msg.Empty = ...,
        error_code: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class FollowPath_Feedback(Message):
    distance_to_goal: float
    speed: float
    def __init__(
        self,
        *,
        distance_to_goal: float = ...,
        speed: float = ...,
    ) -> None: ...

class FollowPath_FeedbackMessage(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    feedback: FollowPath_Feedback
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        feedback: FollowPath_Feedback = ...,
    ) -> None: ...

class FollowPath_SendGoal_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    goal: FollowPath_Goal
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        goal: FollowPath_Goal = ...,
    ) -> None: ...

class FollowPath_SendGoal_Response(Message):
    accepted: bool
    stamp: navette.msgs.builtin_interfaces.msg.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: navette.msgs.builtin_interfaces.msg.Time = ...,
    ) -> None: ...

class FollowPath_SendGoal_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[FollowPath_SendGoal_Request]
    response: list[FollowPath_SendGoal_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[FollowPath_SendGoal_Request] = ...,
        response: list[FollowPath_SendGoal_Response] = ...,
    ) -> None: ...

class FollowPath_SendGoal:
    Request = FollowPath_SendGoal_Request
    Response = FollowPath_SendGoal_Response
    Event = FollowPath_SendGoal_Event

class FollowPath_GetResult_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
    ) -> None: ...

class FollowPath_GetResult_Response(Message):
    status: int
    result: FollowPath_Result
    def __init__(
        self,
        *,
        status: int = ...,
        result: FollowPath_Result = ...,
    ) -> None: ...

class FollowPath_GetResult_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[FollowPath_GetResult_Request]
    response: list[FollowPath_GetResult_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[FollowPath_GetResult_Request] = ...,
        response: list[FollowPath_GetResult_Response] = ...,
    ) -> None: ...

class FollowPath_GetResult:
    Request = FollowPath_GetResult_Request
    Response = FollowPath_GetResult_Response
    Event = FollowPath_GetResult_Event

class FollowPath:
    Goal = FollowPath_Goal
    Result = FollowPath_Result
    Feedback = FollowPath_Feedback
    class Impl:
        SendGoalService = FollowPath_SendGoal
        GetResultService = FollowPath_GetResult
        FeedbackMessage = FollowPath_FeedbackMessage
        CancelGoalService = navette.msgs.action_msgs.srv.CancelGoal
        GoalStatusMessage = navette.msgs.action_msgs.msg.GoalStatusArray

class FollowWaypoints_Goal(Message):
    number_of_loops: int
    goal_index: int
    poses: list[navette.msgs.geometry_msgs.msg.PoseStamped]
    def __init__(
        self,
        *,
        number_of_loops: int = ...,
        goal_index: int = ...,
        poses: list[navette.msgs.geometry_msgs.msg.PoseStamped] = ...,
    ) -> None: ...

class FollowWaypoints_Result(Message):
    NONE: ClassVar[int]
    UNKNOWN: ClassVar[int]
    TASK_EXECUTOR_FAILED: ClassVar[int]
    missed_waypoints: list[navette.msgs.nav2_msgs.msg.MissedWaypoint]
    error_code: int
    error_msg: str
    def __init__(
        self,
        *,
        missed_waypoints: list[navette.msgs.nav2_msgs.msg.MissedWaypoint] = ...,
        error_code: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class FollowWaypoints_Feedback(Message):
    current_waypoint: int
    def __init__(
        self,
        *,
        current_waypoint: int = ...,
    ) -> None: ...

class FollowWaypoints_FeedbackMessage(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    feedback: FollowWaypoints_Feedback
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        feedback: FollowWaypoints_Feedback = ...,
    ) -> None: ...

class FollowWaypoints_SendGoal_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    goal: FollowWaypoints_Goal
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        goal: FollowWaypoints_Goal = ...,
    ) -> None: ...

class FollowWaypoints_SendGoal_Response(Message):
    accepted: bool
    stamp: navette.msgs.builtin_interfaces.msg.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: navette.msgs.builtin_interfaces.msg.Time = ...,
    ) -> None: ...

class FollowWaypoints_SendGoal_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[FollowWaypoints_SendGoal_Request]
    response: list[FollowWaypoints_SendGoal_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[FollowWaypoints_SendGoal_Request] = ...,
        response: list[FollowWaypoints_SendGoal_Response] = ...,
    ) -> None: ...

class FollowWaypoints_SendGoal:
    Request = FollowWaypoints_SendGoal_Request
    Response = FollowWaypoints_SendGoal_Response
    Event = FollowWaypoints_SendGoal_Event

class FollowWaypoints_GetResult_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
    ) -> None: ...

class FollowWaypoints_GetResult_Response(Message):
    status: int
    result: FollowWaypoints_Result
    def __init__(
        self,
        *,
        status: int = ...,
        result: FollowWaypoints_Result = ...,
    ) -> None: ...

class FollowWaypoints_GetResult_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[FollowWaypoints_GetResult_Request]
    response: list[FollowWaypoints_GetResult_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[FollowWaypoints_GetResult_Request] = ...,
        response: list[FollowWaypoints_GetResult_Response] = ...,
    ) -> None: ...

class FollowWaypoints_GetResult:
    Request = FollowWaypoints_GetResult_Request
    Response = FollowWaypoints_GetResult_Response
    Event = FollowWaypoints_GetResult_Event

class FollowWaypoints:
    Goal = FollowWaypoints_Goal
    Result = FollowWaypoints_Result
    Feedback = FollowWaypoints_Feedback
    class Impl:
        SendGoalService = FollowWaypoints_SendGoal
        GetResultService = FollowWaypoints_GetResult
        FeedbackMessage = FollowWaypoints_FeedbackMessage
        CancelGoalService = navette.msgs.action_msgs.srv.CancelGoal
        GoalStatusMessage = navette.msgs.action_msgs.msg.GoalStatusArray

class NavigateThroughPoses_Goal(Message):
    poses: list[navette.msgs.geometry_msgs.msg.PoseStamped]
    behavior_tree: str
    def __init__(
        self,
        *,
        poses: list[navette.msgs.geometry_msgs.msg.PoseStamped] = ...,
        behavior_tree: str = ...,
    ) -> None: ...

class NavigateThroughPoses_Result(Message):
    NONE: ClassVar[int]
    error_code: int
    error_msg: str
    def __init__(
        self,
        *,
        error_code: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class NavigateThroughPoses_Feedback(Message):
    current_pose: navette.msgs.geometry_msgs.msg.PoseStamped
    navigation_time: navette.msgs.builtin_interfaces.msg.Duration
    estimated_time_remaining: navette.msgs.builtin_interfaces.msg.Duration
    number_of_recoveries: int
    distance_remaining: float
    number_of_poses_remaining: int
    def __init__(
        self,
        *,
        current_pose: navette.msgs.geometry_msgs.msg.PoseStamped = ...,
        navigation_time: navette.msgs.builtin_interfaces.msg.Duration = ...,
        estimated_time_remaining: navette.msgs.builtin_interfaces.msg.Duration = ...,
        number_of_recoveries: int = ...,
        distance_remaining: float = ...,
        number_of_poses_remaining: int = ...,
    ) -> None: ...

class NavigateThroughPoses_FeedbackMessage(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    feedback: NavigateThroughPoses_Feedback
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        feedback: NavigateThroughPoses_Feedback = ...,
    ) -> None: ...

class NavigateThroughPoses_SendGoal_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    goal: NavigateThroughPoses_Goal
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        goal: NavigateThroughPoses_Goal = ...,
    ) -> None: ...

class NavigateThroughPoses_SendGoal_Response(Message):
    accepted: bool
    stamp: navette.msgs.builtin_interfaces.msg.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: navette.msgs.builtin_interfaces.msg.Time = ...,
    ) -> None: ...

class NavigateThroughPoses_SendGoal_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[NavigateThroughPoses_SendGoal_Request]
    response: list[NavigateThroughPoses_SendGoal_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[NavigateThroughPoses_SendGoal_Request] = ...,
        response: list[NavigateThroughPoses_SendGoal_Response] = ...,
    ) -> None: ...

class NavigateThroughPoses_SendGoal:
    Request = NavigateThroughPoses_SendGoal_Request
    Response = NavigateThroughPoses_SendGoal_Response
    Event = NavigateThroughPoses_SendGoal_Event

class NavigateThroughPoses_GetResult_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
    ) -> None: ...

class NavigateThroughPoses_GetResult_Response(Message):
    status: int
    result: NavigateThroughPoses_Result
    def __init__(
        self,
        *,
        status: int = ...,
        result: NavigateThroughPoses_Result = ...,
    ) -> None: ...

class NavigateThroughPoses_GetResult_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[NavigateThroughPoses_GetResult_Request]
    response: list[NavigateThroughPoses_GetResult_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[NavigateThroughPoses_GetResult_Request] = ...,
        response: list[NavigateThroughPoses_GetResult_Response] = ...,
    ) -> None: ...

class NavigateThroughPoses_GetResult:
    Request = NavigateThroughPoses_GetResult_Request
    Response = NavigateThroughPoses_GetResult_Response
    Event = NavigateThroughPoses_GetResult_Event

class NavigateThroughPoses:
    Goal = NavigateThroughPoses_Goal
    Result = NavigateThroughPoses_Result
    Feedback = NavigateThroughPoses_Feedback
    class Impl:
        SendGoalService = NavigateThroughPoses_SendGoal
        GetResultService = NavigateThroughPoses_GetResult
        FeedbackMessage = NavigateThroughPoses_FeedbackMessage
        CancelGoalService = navette.msgs.action_msgs.srv.CancelGoal
        GoalStatusMessage = navette.msgs.action_msgs.msg.GoalStatusArray

class NavigateToPose_Goal(Message):
    pose: navette.msgs.geometry_msgs.msg.PoseStamped
    behavior_tree: str
    def __init__(
        self,
        *,
        pose: navette.msgs.geometry_msgs.msg.PoseStamped = ...,
        behavior_tree: str = ...,
    ) -> None: ...

class NavigateToPose_Result(Message):
    NONE: ClassVar[int]
    error_code: int
    error_msg: str
    def __init__(
        self,
        *,
        error_code: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class NavigateToPose_Feedback(Message):
    current_pose: navette.msgs.geometry_msgs.msg.PoseStamped
    navigation_time: navette.msgs.builtin_interfaces.msg.Duration
    estimated_time_remaining: navette.msgs.builtin_interfaces.msg.Duration
    number_of_recoveries: int
    distance_remaining: float
    def __init__(
        self,
        *,
        current_pose: navette.msgs.geometry_msgs.msg.PoseStamped = ...,
        navigation_time: navette.msgs.builtin_interfaces.msg.Duration = ...,
        estimated_time_remaining: navette.msgs.builtin_interfaces.msg.Duration = ...,
        number_of_recoveries: int = ...,
        distance_remaining: float = ...,
    ) -> None: ...

class NavigateToPose_FeedbackMessage(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    feedback: NavigateToPose_Feedback
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        feedback: NavigateToPose_Feedback = ...,
    ) -> None: ...

class NavigateToPose_SendGoal_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    goal: NavigateToPose_Goal
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        goal: NavigateToPose_Goal = ...,
    ) -> None: ...

class NavigateToPose_SendGoal_Response(Message):
    accepted: bool
    stamp: navette.msgs.builtin_interfaces.msg.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: navette.msgs.builtin_interfaces.msg.Time = ...,
    ) -> None: ...

class NavigateToPose_SendGoal_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[NavigateToPose_SendGoal_Request]
    response: list[NavigateToPose_SendGoal_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[NavigateToPose_SendGoal_Request] = ...,
        response: list[NavigateToPose_SendGoal_Response] = ...,
    ) -> None: ...

class NavigateToPose_SendGoal:
    Request = NavigateToPose_SendGoal_Request
    Response = NavigateToPose_SendGoal_Response
    Event = NavigateToPose_SendGoal_Event

class NavigateToPose_GetResult_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
    ) -> None: ...

class NavigateToPose_GetResult_Response(Message):
    status: int
    result: NavigateToPose_Result
    def __init__(
        self,
        *,
        status: int = ...,
        result: NavigateToPose_Result = ...,
    ) -> None: ...

class NavigateToPose_GetResult_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[NavigateToPose_GetResult_Request]
    response: list[NavigateToPose_GetResult_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[NavigateToPose_GetResult_Request] = ...,
        response: list[NavigateToPose_GetResult_Response] = ...,
    ) -> None: ...

class NavigateToPose_GetResult:
    Request = NavigateToPose_GetResult_Request
    Response = NavigateToPose_GetResult_Response
    Event = NavigateToPose_GetResult_Event

class NavigateToPose:
    Goal = NavigateToPose_Goal
    Result = NavigateToPose_Result
    Feedback = NavigateToPose_Feedback
    class Impl:
        SendGoalService = NavigateToPose_SendGoal
        GetResultService = NavigateToPose_GetResult
        FeedbackMessage = NavigateToPose_FeedbackMessage
        CancelGoalService = navette.msgs.action_msgs.srv.CancelGoal
        GoalStatusMessage = navette.msgs.action_msgs.msg.GoalStatusArray

class SmoothPath_Goal(Message):
    path: navette.msgs.nav_msgs.msg.Path
    smoother_id: str
    max_smoothing_duration: navette.msgs.builtin_interfaces.msg.Duration
    check_for_collisions: bool
    def __init__(
        self,
        *,
        path: navette.msgs.nav_msgs.msg.Path = ...,
        smoother_id: str = ...,
        max_smoothing_duration: navette.msgs.builtin_interfaces.msg.Duration = ...,
        check_for_collisions: bool = ...,
    ) -> None: ...

class SmoothPath_Result(Message):
    NONE: ClassVar[int]
    UNKNOWN: ClassVar[int]
    INVALID_SMOOTHER: ClassVar[int]
    TIMEOUT: ClassVar[int]
    SMOOTHED_PATH_IN_COLLISION: ClassVar[int]
    FAILED_TO_SMOOTH_PATH: ClassVar[int]
    INVALID_PATH: ClassVar[int]
    path: navette.msgs.nav_msgs.msg.Path
    smoothing_duration: navette.msgs.builtin_interfaces.msg.Duration
    was_completed: bool
    error_code: int
    error_msg: str
    def __init__(
        self,
        *,
        path: navette.msgs.nav_msgs.msg.Path = ...,
        smoothing_duration: navette.msgs.builtin_interfaces.msg.Duration = ...,
        was_completed: bool = ...,
        error_code: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class SmoothPath_Feedback(Message):
    def __init__(self) -> None: ...

class SmoothPath_FeedbackMessage(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    feedback: SmoothPath_Feedback
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        feedback: SmoothPath_Feedback = ...,
    ) -> None: ...

class SmoothPath_SendGoal_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    goal: SmoothPath_Goal
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        goal: SmoothPath_Goal = ...,
    ) -> None: ...

class SmoothPath_SendGoal_Response(Message):
    accepted: bool
    stamp: navette.msgs.builtin_interfaces.msg.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: navette.msgs.builtin_interfaces.msg.Time = ...,
    ) -> None: ...

class SmoothPath_SendGoal_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[SmoothPath_SendGoal_Request]
    response: list[SmoothPath_SendGoal_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[SmoothPath_SendGoal_Request] = ...,
        response: list[SmoothPath_SendGoal_Response] = ...,
    ) -> None: ...

class SmoothPath_SendGoal:
    Request = SmoothPath_SendGoal_Request
    Response = SmoothPath_SendGoal_Response
    Event = SmoothPath_SendGoal_Event

class SmoothPath_GetResult_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
    ) -> None: ...

class SmoothPath_GetResult_Response(Message):
    status: int
    result: SmoothPath_Result
    def __init__(
        self,
        *,
        status: int = ...,
        result: SmoothPath_Result = ...,
    ) -> None: ...

class SmoothPath_GetResult_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[SmoothPath_GetResult_Request]
    response: list[SmoothPath_GetResult_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[SmoothPath_GetResult_Request] = ...,
        response: list[SmoothPath_GetResult_Response] = ...,
    ) -> None: ...

class SmoothPath_GetResult:
    Request = SmoothPath_GetResult_Request
    Response = SmoothPath_GetResult_Response
    Event = SmoothPath_GetResult_Event

class SmoothPath:
    Goal = SmoothPath_Goal
    Result = SmoothPath_Result
    Feedback = SmoothPath_Feedback
    class Impl:
        SendGoalService = SmoothPath_SendGoal
        GetResultService = SmoothPath_GetResult
        FeedbackMessage = SmoothPath_FeedbackMessage
        CancelGoalService = navette.msgs.action_msgs.srv.CancelGoal
        GoalStatusMessage = navette.msgs.action_msgs.msg.GoalStatusArray

class Spin_Goal(Message):
    target_yaw: float
    time_allowance: navette.msgs.builtin_interfaces.msg.Duration
    def __init__(
        self,
        *,
        target_yaw: float = ...,
        time_allowance: navette.msgs.builtin_interfaces.msg.Duration = ...,
    ) -> None: ...

class Spin_Result(Message):
    NONE: ClassVar[int]
    UNKNOWN: ClassVar[int]
    TIMEOUT: ClassVar[int]
    TF_ERROR: ClassVar[int]
    COLLISION_AHEAD: ClassVar[int]
    total_elapsed_time: navette.msgs.builtin_interfaces.msg.Duration
    error_code: int
    error_msg: str
    def __init__(
        self,
        *,
        total_elapsed_time: navette.msgs.builtin_interfaces.msg.Duration = ...,
        error_code: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class Spin_Feedback(Message):
    angular_distance_traveled: float
    def __init__(
        self,
        *,
        angular_distance_traveled: float = ...,
    ) -> None: ...

class Spin_FeedbackMessage(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    feedback: Spin_Feedback
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        feedback: Spin_Feedback = ...,
    ) -> None: ...

class Spin_SendGoal_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    goal: Spin_Goal
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        goal: Spin_Goal = ...,
    ) -> None: ...

class Spin_SendGoal_Response(Message):
    accepted: bool
    stamp: navette.msgs.builtin_interfaces.msg.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: navette.msgs.builtin_interfaces.msg.Time = ...,
    ) -> None: ...

class Spin_SendGoal_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[Spin_SendGoal_Request]
    response: list[Spin_SendGoal_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[Spin_SendGoal_Request] = ...,
        response: list[Spin_SendGoal_Response] = ...,
    ) -> None: ...

class Spin_SendGoal:
    Request = Spin_SendGoal_Request
    Response = Spin_SendGoal_Response
    Event = Spin_SendGoal_Event

class Spin_GetResult_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
    ) -> None: ...

class Spin_GetResult_Response(Message):
    status: int
    result: Spin_Result
    def __init__(
        self,
        *,
        status: int = ...,
        result: Spin_Result = ...,
    ) -> None: ...

class Spin_GetResult_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[Spin_GetResult_Request]
    response: list[Spin_GetResult_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[Spin_GetResult_Request] = ...,
        response: list[Spin_GetResult_Response] = ...,
    ) -> None: ...

class Spin_GetResult:
    Request = Spin_GetResult_Request
    Response = Spin_GetResult_Response
    Event = Spin_GetResult_Event

class Spin:
    Goal = Spin_Goal
    Result = Spin_Result
    Feedback = Spin_Feedback
    class Impl:
        SendGoalService = Spin_SendGoal
        GetResultService = Spin_GetResult
        FeedbackMessage = Spin_FeedbackMessage
        CancelGoalService = navette.msgs.action_msgs.srv.CancelGoal
        GoalStatusMessage = navette.msgs.action_msgs.msg.GoalStatusArray

class UndockRobot_Goal(Message):
    dock_type: str
    max_undocking_time: float
    def __init__(
        self,
        *,
        dock_type: str = ...,
        max_undocking_time: float = ...,
    ) -> None: ...

class UndockRobot_Result(Message):
    NONE: ClassVar[int]
    DOCK_NOT_VALID: ClassVar[int]
    FAILED_TO_CONTROL: ClassVar[int]
    UNKNOWN: ClassVar[int]
    success: bool
    error_code: int
    error_msg: str
    def __init__(
        self,
        *,
        success: bool = ...,
        error_code: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class UndockRobot_Feedback(Message):
    def __init__(self) -> None: ...

class UndockRobot_FeedbackMessage(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    feedback: UndockRobot_Feedback
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        feedback: UndockRobot_Feedback = ...,
    ) -> None: ...

class UndockRobot_SendGoal_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    goal: UndockRobot_Goal
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        goal: UndockRobot_Goal = ...,
    ) -> None: ...

class UndockRobot_SendGoal_Response(Message):
    accepted: bool
    stamp: navette.msgs.builtin_interfaces.msg.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: navette.msgs.builtin_interfaces.msg.Time = ...,
    ) -> None: ...

class UndockRobot_SendGoal_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[UndockRobot_SendGoal_Request]
    response: list[UndockRobot_SendGoal_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[UndockRobot_SendGoal_Request] = ...,
        response: list[UndockRobot_SendGoal_Response] = ...,
    ) -> None: ...

class UndockRobot_SendGoal:
    Request = UndockRobot_SendGoal_Request
    Response = UndockRobot_SendGoal_Response
    Event = UndockRobot_SendGoal_Event

class UndockRobot_GetResult_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
    ) -> None: ...

class UndockRobot_GetResult_Response(Message):
    status: int
    result: UndockRobot_Result
    def __init__(
        self,
        *,
        status: int = ...,
        result: UndockRobot_Result = ...,
    ) -> None: ...

class UndockRobot_GetResult_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[UndockRobot_GetResult_Request]
    response: list[UndockRobot_GetResult_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[UndockRobot_GetResult_Request] = ...,
        response: list[UndockRobot_GetResult_Response] = ...,
    ) -> None: ...

class UndockRobot_GetResult:
    Request = UndockRobot_GetResult_Request
    Response = UndockRobot_GetResult_Response
    Event = UndockRobot_GetResult_Event

class UndockRobot:
    Goal = UndockRobot_Goal
    Result = UndockRobot_Result
    Feedback = UndockRobot_Feedback
    class Impl:
        SendGoalService = UndockRobot_SendGoal
        GetResultService = UndockRobot_GetResult
        FeedbackMessage = UndockRobot_FeedbackMessage
        CancelGoalService = navette.msgs.action_msgs.srv.CancelGoal
        GoalStatusMessage = navette.msgs.action_msgs.msg.GoalStatusArray

class Wait_Goal(Message):
    time: navette.msgs.builtin_interfaces.msg.Duration
    def __init__(
        self,
        *,
        time: navette.msgs.builtin_interfaces.msg.Duration = ...,
    ) -> None: ...

class Wait_Result(Message):
    total_elapsed_time: navette.msgs.builtin_interfaces.msg.Duration
    error_code: int
    error_msg: str
    def __init__(
        self,
        *,
        total_elapsed_time: navette.msgs.builtin_interfaces.msg.Duration = ...,
        error_code: int = ...,
        error_msg: str = ...,
    ) -> None: ...

class Wait_Feedback(Message):
    time_left: navette.msgs.builtin_interfaces.msg.Duration
    def __init__(
        self,
        *,
        time_left: navette.msgs.builtin_interfaces.msg.Duration = ...,
    ) -> None: ...

class Wait_FeedbackMessage(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    feedback: Wait_Feedback
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        feedback: Wait_Feedback = ...,
    ) -> None: ...

class Wait_SendGoal_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    goal: Wait_Goal
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
        goal: Wait_Goal = ...,
    ) -> None: ...

class Wait_SendGoal_Response(Message):
    accepted: bool
    stamp: navette.msgs.builtin_interfaces.msg.Time
    def __init__(
        self,
        *,
        accepted: bool = ...,
        stamp: navette.msgs.builtin_interfaces.msg.Time = ...,
    ) -> None: ...

class Wait_SendGoal_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[Wait_SendGoal_Request]
    response: list[Wait_SendGoal_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[Wait_SendGoal_Request] = ...,
        response: list[Wait_SendGoal_Response] = ...,
    ) -> None: ...

class Wait_SendGoal:
    Request = Wait_SendGoal_Request
    Response = Wait_SendGoal_Response
    Event = Wait_SendGoal_Event

class Wait_GetResult_Request(Message):
    goal_id: navette.msgs.unique_identifier_msgs.msg.UUID
    def __init__(
        self,
        *,
        goal_id: navette.msgs.unique_identifier_msgs.msg.UUID = ...,
    ) -> None: ...

class Wait_GetResult_Response(Message):
    status: int
    result: Wait_Result
    def __init__(
        self,
        *,
        status: int = ...,
        result: Wait_Result = ...,
    ) -> None: ...

class Wait_GetResult_Event(Message):
    info: navette.msgs.service_msgs.msg.ServiceEventInfo
    request: list[Wait_GetResult_Request]
    response: list[Wait_GetResult_Response]
    def __init__(
        self,
        *,
        info: navette.msgs.service_msgs.msg.ServiceEventInfo = ...,
        request: list[Wait_GetResult_Request] = ...,
        response: list[Wait_GetResult_Response] = ...,
    ) -> None: ...

class Wait_GetResult:
    Request = Wait_GetResult_Request
    Response = Wait_GetResult_Response
    Event = Wait_GetResult_Event

class Wait:
    Goal = Wait_Goal
    Result = Wait_Result
    Feedback = Wait_Feedback
    class Impl:
        SendGoalService = Wait_SendGoal
        GetResultService = Wait_GetResult
        FeedbackMessage = Wait_FeedbackMessage
        CancelGoalService = navette.msgs.action_msgs.srv.CancelGoal
        GoalStatusMessage = navette.msgs.action_msgs.msg.GoalStatusArray
