"""Nodes."""

from navette.msgs.rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ListParametersResult,
    ParameterDescriptor,
    ParameterEvent,
    ParameterType,
    ParameterValue,
    SetParametersResult,
)
from navette.msgs.rcl_interfaces.msg import Parameter as ParameterMsg
from navette.runtime import (
    CallbackGroup,
    Client,
    Clock,
    Context,
    Executor,
    MessageInfo,
    MutuallyExclusiveCallbackGroup,
    Node,
    Parameter,
    Publisher,
    QoSProfile,
    Rate,
    ReentrantCallbackGroup,
    ROSClock,
    Service,
    Subscription,
    Timer,
    get_default_context,
)
from navette.runtime.exceptions import (
    InvalidHandle,
    InvalidParameterTypeException,
    InvalidParameterValueException,
    InvalidTopicNameException,
    NotInitializedException,
    ParameterAlreadyDeclaredException,
    ParameterImmutableException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
)
from navette.runtime.guard_condition import GuardCondition
from navette.runtime.log import Logger as RcutilsLogger
from navette.runtime.logging_service import LoggingService
from navette.runtime.names import (
    expand_topic_name,
    validate_full_topic_name,
    validate_namespace,
    validate_node_name,
    validate_topic_name,
)
from navette.runtime.node import HIDDEN_NODE_PREFIX
from navette.runtime.node_graph import NodeNameNonExistentError
from navette.runtime.parameter import (
    PARAMETER_SEPARATOR_STRING,
    AllowableParameterValue,
    validate_parameter_name,
)
from navette.runtime.parameter_service import ParameterService
from navette.runtime.program_log import get_logger
from navette.runtime.qos import (
    qos_profile_parameter_events,
    qos_profile_services_default,
)
from navette.runtime.qos_events import (
    PublisherEventCallbacks,
    SubscriptionEventCallbacks,
)
from navette.runtime.qos_overriding_options import QoSOverridingOptions
from navette.runtime.time import NS_PER_S as S_TO_NS
from navette.runtime.time_source import TimeSource
from navette.runtime.timer import TimerInfo
from navette.runtime.topic_endpoint_info import TopicEndpointInfo
from navette.runtime.type_description_service import TypeDescriptionService
from navette.runtime.type_support import (
    MsgT,
    SrvEventT,
    SrvRequestT,
    SrvResponseT,
    check_is_valid_msg_type,
    check_is_valid_srv_type,
)
from navette.runtime.type_support import MsgT as MsgType
from navette.runtime.type_support import SrvRequestT as SrvTypeRequest
from navette.runtime.type_support import SrvResponseT as SrvTypeResponse
from navette.runtime.type_support import SrvT as SrvType
from navette.runtime.waitable import Waitable

__all__ = [
    "AllowableParameterValue",
    "CallbackGroup",
    "Client",
    "Clock",
    "Context",
    "Executor",
    "FloatingPointRange",
    "GuardCondition",
    "HIDDEN_NODE_PREFIX",
    "IntegerRange",
    "InvalidHandle",
    "InvalidParameterTypeException",
    "InvalidParameterValueException",
    "InvalidTopicNameException",
    "ListParametersResult",
    "LoggingService",
    "MessageInfo",
    "MsgT",
    "MsgType",
    "MutuallyExclusiveCallbackGroup",
    "Node",
    "NodeNameNonExistentError",
    "NotInitializedException",
    "PARAMETER_SEPARATOR_STRING",
    "Parameter",
    "ParameterAlreadyDeclaredException",
    "ParameterDescriptor",
    "ParameterEvent",
    "ParameterImmutableException",
    "ParameterMsg",
    "ParameterNotDeclaredException",
    "ParameterService",
    "ParameterType",
    "ParameterUninitializedException",
    "ParameterValue",
    "Publisher",
    "PublisherEventCallbacks",
    "QoSOverridingOptions",
    "QoSProfile",
    "ROSClock",
    "Rate",
    "RcutilsLogger",
    "ReentrantCallbackGroup",
    "S_TO_NS",
    "Service",
    "SetParametersResult",
    "SrvEventT",
    "SrvRequestT",
    "SrvResponseT",
    "SrvType",
    "SrvTypeRequest",
    "SrvTypeResponse",
    "Subscription",
    "SubscriptionEventCallbacks",
    "TimeSource",
    "Timer",
    "TimerInfo",
    "TopicEndpointInfo",
    "TypeDescriptionService",
    "Waitable",
    "check_is_valid_msg_type",
    "check_is_valid_srv_type",
    "expand_topic_name",
    "get_default_context",
    "get_logger",
    "qos_profile_parameter_events",
    "qos_profile_services_default",
    "validate_full_topic_name",
    "validate_namespace",
    "validate_node_name",
    "validate_parameter_name",
    "validate_topic_name",
]
