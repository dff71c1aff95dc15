"""Table of the names in rclpy's modules and of their places in Navette.

The import hook makes rclpy's modules from this table; each name is imported when a
program first uses it.
"""

from functools import cache
from typing import NamedTuple

#: Navette's module → the names that rclpy takes from it, as in an import statement.
_ORIGINS = {
    "navette.msgs.action_msgs.msg": "GoalStatus",
    "navette.msgs.rcl_interfaces.msg": """
        FloatingPointRange, IntegerRange, ListParametersResult, ParameterDescriptor,
        ParameterEvent, Parameter as ParameterMsg, ParameterType, ParameterValue,
        SetParametersResult
    """,
    "navette.runtime": """
        ActionClient, ActionServer, AsyncParameterClient, CallbackGroup, CancelResponse,
        Client, Clock, ClockType, Context, create_node, deserialize_message,
        DurabilityPolicy, Duration, Executor, ExternalShutdownException, Future,
        get_default_context, get_global_executor, GoalResponse, HistoryPolicy, init,
        InitContextManager, JumpThreshold, LifecycleNode, LifecyclePublisher,
        LivelinessPolicy, LoggingSeverity, MessageInfo, MultiThreadedExecutor,
        MutuallyExclusiveCallbackGroup, Node, NotInitializedException, ok, Parameter,
        ParameterAlreadyDeclaredException, ParameterEventHandler,
        ParameterNotDeclaredException, Publisher, qos_profile_sensor_data,
        qos_profile_system_default, QoSPresetProfiles, QoSProfile, Rate,
        ReentrantCallbackGroup, ReliabilityPolicy, remove_ros_args, ROSClock,
        ROSInterruptException, serialize_message, Service, shutdown,
        SignalHandlerOptions, SingleThreadedExecutor, spin, spin_once,
        spin_until_future_complete, Subscription, Task, Time, TimeJump, Timer,
        TransitionCallbackReturn, try_shutdown
    """,
    "navette.runtime.action": """
        get_action_client_names_and_types_by_node, get_action_names_and_types,
        get_action_server_names_and_types_by_node
    """,
    "navette.runtime.action.client": "ClientGoalHandle",
    "navette.runtime.action.goal_states": "GoalEvent",
    "navette.runtime.action.server": """
        default_cancel_callback, default_goal_callback, default_handle_accepted_callback
    """,
    "navette.runtime.action.server_goal_handle": "ServerGoalHandle",
    "navette.runtime.exceptions": """
        ConditionReachedException, InvalidHandle, InvalidNamespaceException,
        InvalidNodeNameException, InvalidParameterException,
        InvalidParameterTypeException, InvalidParameterValueException,
        InvalidServiceNameException, InvalidTopicNameException, NameValidationException,
        NodeNameNonExistentError, ParameterException, ParameterImmutableException,
        ParameterUninitializedException, RCLError, ShutdownException, TimeoutException,
        UnknownROSArgsError
    """,
    "navette.runtime.executor": "await_or_execute, EventsExecutor, TimeoutObject",
    "navette.runtime.guard_condition": "GuardCondition",
    "navette.runtime.lifecycle": """
        LifecycleNodeMixin, LifecycleState, ManagedEntity, NodeMixin,
        SimpleManagedEntity, State
    """,
    "navette.runtime.log": "Logger as RcutilsLogger",
    "navette.runtime.logging_service": "LoggingService",
    "navette.runtime.names": """
        expand_topic_name, HIDDEN_TOPIC_PREFIX, topic_or_service_is_hidden,
        TOPIC_SEPARATOR_STRING, validate_full_topic_name, validate_namespace,
        validate_node_name, validate_topic_name
    """,
    "navette.runtime.node": "HIDDEN_NODE_PREFIX",
    "navette.runtime.parameter": """
        AllowableParameterValue, get_parameter_value, parameter_dict_from_yaml_file,
        PARAMETER_SEPARATOR_STRING, parameter_value_to_python, validate_parameter_name
    """,
    "navette.runtime.parameter_event_handler": """
        ParameterCallbackHandle, ParameterEventCallbackHandle
    """,
    "navette.runtime.parameter_service": "ParameterService",
    "navette.runtime.poll_set": "PollSet as WaitSet",
    "navette.runtime.log_sinks": "get_logging_directory",
    "navette.runtime.program_log": """
        clear_config, get_logger, get_logger_effective_level, get_logger_level,
        get_logging_severity_from_string, initialize, set_logger_level
    """,
    "navette.runtime.qos": """
        DeadlineBestAvailable, InvalidQoSProfileException,
        LivelinessLeaseDurationeBestAvailable, qos_check_compatible,
        qos_policy_name_from_kind, qos_profile_action_status_default,
        qos_profile_best_available, qos_profile_default, qos_profile_parameter_events,
        qos_profile_parameters, qos_profile_services_default, qos_profile_unknown,
        QoSCompatibility, QoSDurabilityPolicy, QoSHistoryPolicy, QoSLivelinessPolicy,
        QoSPolicyEnum, QoSPolicyKind, QoSReliabilityPolicy
    """,
    "navette.runtime.qos_events": """
        EventHandler, IncompatibleTypeInfo, PublisherEventCallbacks,
        EventHandler as QoSEventHandler, QoSLivelinessChangedInfo,
        QoSLivelinessLostInfo, QoSMessageLostInfo, QoSOfferedDeadlineMissedInfo,
        QoSOfferedIncompatibleQoSInfo, QoSPublisherEventType, QoSPublisherMatchedInfo,
        QoSRequestedDeadlineMissedInfo, QoSRequestedIncompatibleQoSInfo,
        QoSSubscriptionEventType, QoSSubscriptionMatchedInfo,
        SubscriptionEventCallbacks, UnsupportedEventTypeError
    """,
    "navette.runtime.qos_overriding_options": """
        InvalidQosOverridesError, QosCallbackResult, QosCallbackType,
        QoSOverridingOptions
    """,
    "navette.runtime.rmw": """
        get_available_rmw_implementations, get_rmw_implementation_identifier
    """,
    "navette.runtime.ros_clock": "ClockChange, JumpHandle",
    "navette.runtime.service_introspection": "ServiceIntrospectionState",
    "navette.runtime.signals": """
        get_current_signal_handlers_options, install_signal_handlers,
        SignalHandlerGuardCondition, uninstall_signal_handlers
    """,
    "navette.runtime.subscription": "ContentFilterOptions",
    "navette.runtime.time": "Infinite, NS_PER_S as S_TO_NS, timeout_sec_to_nsec",
    "navette.runtime.time_source": "CLOCK_TOPIC, TimeSource, USE_SIM_TIME_NAME",
    "navette.runtime.timer": "TimerInfo",
    "navette.runtime.topic_endpoint_info": """
        EndpointTypeEnum, ServiceEndpointInfo, TopicEndpointInfo, TopicEndpointTypeEnum
    """,
    "navette.runtime.type_description_service": """
        START_TYPE_DESCRIPTION_SERVICE_PARAM, TypeDescriptionService
    """,
    "navette.runtime.type_hash": "TypeHash",
    "navette.runtime.type_support": """
        check_for_type_support, check_is_valid_action_type, check_is_valid_msg_type,
        check_is_valid_srv_type, Msg, MsgT, MsgT as MsgType,
        NoTypeSupportImportedException, SrvEventT, SrvRequestT, SrvResponseT,
        SrvT as SrvType, SrvRequestT as SrvTypeRequest, SrvResponseT as SrvTypeResponse
    """,
    "navette.runtime.wait_for_message": "wait_for_message",
    "navette.runtime.wait_set": "NumberOfEntities",
    "navette.runtime.waitable": "Waitable",
    "rclpy": "_rclpy_pybind11 as rclpy_implementation",
}

#: rclpy's module → its names. A name with dots is given with its place in Navette,
#: if that differs from its place in the other modules.
_MODULES = {
    "rclpy": """
        Context, create_node, Executor, Future, get_available_rmw_implementations,
        get_default_context, get_global_executor, get_rmw_implementation_identifier,
        init, InitContextManager, install_signal_handlers, Node, ok, Parameter,
        remove_ros_args, shutdown, SignalHandlerOptions, SingleThreadedExecutor, spin,
        spin_once, spin_until_future_complete, try_shutdown, uninstall_signal_handlers
    """,
    "rclpy._rclpy_pybind11": "InvalidHandle, RCLError, UnknownROSArgsError, WaitSet",
    "rclpy.action": """
        ActionClient, ActionServer, CancelResponse,
        get_action_client_names_and_types_by_node, get_action_names_and_types,
        get_action_server_names_and_types_by_node, GoalResponse
    """,
    "rclpy.action.client": """
        ActionClient, await_or_execute, check_for_type_support, ClientGoalHandle,
        Future, GoalStatus, Node, NumberOfEntities, qos_profile_action_status_default,
        qos_profile_services_default, QoSProfile, Waitable
    """,
    "rclpy.action.graph": """
        get_action_client_names_and_types_by_node, get_action_names_and_types,
        get_action_server_names_and_types_by_node, Node
    """,
    "rclpy.action.server": """
        ActionServer, await_or_execute, CancelResponse, check_for_type_support,
        default_cancel_callback, default_goal_callback,
        default_handle_accepted_callback, Future, GoalEvent, GoalResponse, GoalStatus,
        Node, NumberOfEntities, qos_profile_action_status_default,
        qos_profile_services_default, QoSProfile, RCLError, ServerGoalHandle, Waitable
    """,
    "rclpy.callback_groups": """
        CallbackGroup, Client, GuardCondition, MutuallyExclusiveCallbackGroup,
        ReentrantCallbackGroup, Service, Subscription, Timer, Waitable
    """,
    "rclpy.client": """
        CallbackGroup, Client, Clock, Context, Future, QoSProfile,
        ServiceIntrospectionState, SrvEventT, SrvRequestT, SrvResponseT, SrvType,
        SrvTypeRequest, SrvTypeResponse
    """,
    "rclpy.clock": """
        Clock, ClockChange, ClockType, Context, Duration, get_default_context,
        JumpHandle, JumpThreshold, NotInitializedException, ROSClock, Time, TimeJump
    """,
    "rclpy.clock_type": "ClockType",
    "rclpy.constants": "S_TO_NS",
    "rclpy.context": "Context, get_default_context",
    "rclpy.duration": "Duration, Infinite, S_TO_NS",
    "rclpy.endpoint_info": "EndpointTypeEnum, ServiceEndpointInfo, TopicEndpointInfo",
    "rclpy.event_handler": """
        CallbackGroup, EventHandler, get_logger, IncompatibleTypeInfo, NumberOfEntities,
        PublisherEventCallbacks, qos_policy_name_from_kind, QoSEventHandler,
        QoSLivelinessChangedInfo, QoSLivelinessLostInfo, QoSMessageLostInfo,
        QoSOfferedDeadlineMissedInfo, QoSOfferedIncompatibleQoSInfo,
        QoSPublisherEventType, QoSPublisherMatchedInfo, QoSRequestedDeadlineMissedInfo,
        QoSRequestedIncompatibleQoSInfo, QoSSubscriptionEventType,
        QoSSubscriptionMatchedInfo, SubscriptionEventCallbacks,
        UnsupportedEventTypeError, Waitable
    """,
    "rclpy.exceptions": """
        InvalidHandle, InvalidNamespaceException, InvalidNodeNameException,
        InvalidParameterException, InvalidParameterTypeException,
        InvalidParameterValueException, InvalidServiceNameException,
        InvalidTopicNameException, NameValidationException, NotInitializedException,
        NoTypeSupportImportedException, Parameter, ParameterAlreadyDeclaredException,
        ParameterException, ParameterImmutableException, ParameterNotDeclaredException,
        ParameterUninitializedException, ROSInterruptException
    """,
    "rclpy.executors": """
        await_or_execute, Client, Clock, ClockType, ConditionReachedException, Context,
        Executor, ExternalShutdownException, Future, get_default_context,
        GuardCondition, InvalidHandle, MultiThreadedExecutor, Node, NumberOfEntities,
        Service, ShutdownException, SignalHandlerGuardCondition, SingleThreadedExecutor,
        Subscription, Task, timeout_sec_to_nsec, TimeoutException, TimeoutObject, Timer,
        TimerInfo, Waitable
    """,
    "rclpy.expand_topic_name": "expand_topic_name",
    "rclpy.experimental": "EventsExecutor",
    "rclpy.experimental.events_executor": "EventsExecutor",
    "rclpy.guard_condition": """
        CallbackGroup, Context, get_default_context, GuardCondition
    """,
    "rclpy.impl": "",
    "rclpy.impl.implementation_singleton": "rclpy_implementation",
    "rclpy.impl.logging_severity": "LoggingSeverity",
    "rclpy.impl.rcutils_logger": "Clock, LoggingSeverity, RcutilsLogger",
    "rclpy.lifecycle": """
        LifecycleNode, LifecycleNodeMixin, LifecyclePublisher, LifecycleState,
        ManagedEntity, navette.runtime.lifecycle.Node, NodeMixin,
        navette.runtime.lifecycle.Publisher, SimpleManagedEntity, State,
        TransitionCallbackReturn
    """,
    "rclpy.lifecycle.managed_entity": """
        ManagedEntity, SimpleManagedEntity, TransitionCallbackReturn
    """,
    "rclpy.lifecycle.node": """
        CallbackGroup, check_is_valid_srv_type, Context, LifecycleNode,
        LifecycleNodeMixin, LifecyclePublisher, LifecycleState, ManagedEntity, Node,
        Parameter, PublisherEventCallbacks, QoSOverridingOptions, QoSProfile, Service,
        TransitionCallbackReturn
    """,
    "rclpy.lifecycle.publisher": """
        CallbackGroup, LifecyclePublisher, Publisher, PublisherEventCallbacks,
        QoSProfile, SimpleManagedEntity
    """,
    "rclpy.logging": """
        clear_config, get_logger, get_logger_effective_level, get_logger_level,
        get_logging_directory, get_logging_severity_from_string, initialize,
        LoggingSeverity, RcutilsLogger, set_logger_level,
        navette.runtime.program_log.shutdown
    """,
    "rclpy.logging_service": "LoggingService, LoggingSeverity",
    "rclpy.node": """
        AllowableParameterValue, CallbackGroup, check_is_valid_msg_type,
        check_is_valid_srv_type, Client, Clock, Context, Executor, expand_topic_name,
        FloatingPointRange, get_default_context, get_logger, GuardCondition,
        HIDDEN_NODE_PREFIX, IntegerRange, InvalidHandle, InvalidParameterTypeException,
        InvalidParameterValueException, InvalidTopicNameException, ListParametersResult,
        LoggingService, MessageInfo, MsgT, MsgType, MutuallyExclusiveCallbackGroup,
        Node, NodeNameNonExistentError, NotInitializedException, Parameter,
        PARAMETER_SEPARATOR_STRING, ParameterAlreadyDeclaredException,
        ParameterDescriptor, ParameterEvent, ParameterImmutableException, ParameterMsg,
        ParameterNotDeclaredException, ParameterService, ParameterType,
        ParameterUninitializedException, ParameterValue, Publisher,
        PublisherEventCallbacks, qos_profile_parameter_events,
        qos_profile_services_default, QoSOverridingOptions, QoSProfile, Rate,
        RcutilsLogger, ReentrantCallbackGroup, ROSClock, S_TO_NS, Service,
        SetParametersResult, SrvEventT, SrvRequestT, SrvResponseT, SrvType,
        SrvTypeRequest, SrvTypeResponse, Subscription, SubscriptionEventCallbacks,
        Timer, TimerInfo, TimeSource, TopicEndpointInfo, TypeDescriptionService,
        validate_full_topic_name, validate_namespace, validate_node_name,
        validate_parameter_name, validate_topic_name, Waitable
    """,
    "rclpy.parameter": """
        AllowableParameterValue, get_parameter_value, Parameter,
        parameter_dict_from_yaml_file, PARAMETER_SEPARATOR_STRING,
        parameter_value_to_python, ParameterMsg, ParameterType, ParameterValue
    """,
    "rclpy.parameter_client": """
        AsyncParameterClient, CallbackGroup, Future, Node, Parameter,
        parameter_dict_from_yaml_file, QoSOverridingOptions, QoSProfile, Subscription,
        SubscriptionEventCallbacks
    """,
    "rclpy.parameter_event_handler": """
        CallbackGroup, Node, Parameter, ParameterCallbackHandle,
        ParameterEventCallbackHandle, ParameterEventHandler, QoSOverridingOptions,
        QoSProfile, SubscriptionEventCallbacks
    """,
    "rclpy.parameter_service": """
        Parameter, ParameterNotDeclaredException, ParameterService,
        ParameterUninitializedException
    """,
    "rclpy.publisher": """
        CallbackGroup, Duration, EventHandler, MsgT, MsgType, Publisher,
        PublisherEventCallbacks, QoSProfile
    """,
    "rclpy.qos": """
        DeadlineBestAvailable, DurabilityPolicy, Duration, HistoryPolicy,
        InvalidQoSProfileException, LivelinessLeaseDurationeBestAvailable,
        LivelinessPolicy, qos_check_compatible, qos_policy_name_from_kind,
        qos_profile_action_status_default, qos_profile_best_available,
        qos_profile_default, qos_profile_parameter_events, qos_profile_parameters,
        qos_profile_sensor_data, qos_profile_services_default,
        qos_profile_system_default, qos_profile_unknown, QoSCompatibility,
        QoSDurabilityPolicy, QoSHistoryPolicy, QoSLivelinessPolicy, QoSPolicyEnum,
        QoSPolicyKind, QoSPresetProfiles, QoSProfile, QoSReliabilityPolicy,
        ReliabilityPolicy
    """,
    "rclpy.qos_overriding_options": """
        Duration, InvalidQosOverridesError, Parameter,
        ParameterAlreadyDeclaredException, Publisher, QosCallbackResult,
        QosCallbackType, QoSDurabilityPolicy, QoSHistoryPolicy, QoSLivelinessPolicy,
        QoSOverridingOptions, QoSPolicyKind, QoSProfile, QoSReliabilityPolicy,
        Subscription
    """,
    "rclpy.serialization": """
        check_for_type_support, deserialize_message, MsgT, serialize_message
    """,
    "rclpy.service": """
        CallbackGroup, Clock, QoSProfile, Service, ServiceIntrospectionState, SrvEventT,
        SrvRequestT, SrvResponseT, SrvType, SrvTypeRequest, SrvTypeResponse
    """,
    "rclpy.service_introspection": "ServiceIntrospectionState",
    "rclpy.signals": """
        get_current_signal_handlers_options, GuardCondition, install_signal_handlers,
        InvalidHandle, SignalHandlerGuardCondition, SignalHandlerOptions,
        uninstall_signal_handlers
    """,
    "rclpy.subscription": """
        CallbackGroup, ContentFilterOptions, EventHandler, MessageInfo, MsgT, MsgType,
        QoSProfile, Subscription, SubscriptionEventCallbacks
    """,
    "rclpy.subscription_content_filter_options": "ContentFilterOptions",
    "rclpy.task": "Executor, Future, Task",
    "rclpy.time": "ClockType, Duration, S_TO_NS, Time",
    "rclpy.time_source": """
        Clock, CLOCK_TOPIC, ClockType, Node, Parameter, QoSProfile, ReliabilityPolicy,
        ROSClock, Time, TimeSource, USE_SIM_TIME_NAME
    """,
    "rclpy.timer": """
        CallbackGroup, Clock, ClockType, Context, get_default_context, InvalidHandle,
        Rate, ROSInterruptException, Time, Timer, TimerInfo
    """,
    "rclpy.topic_endpoint_info": """
        QoSHistoryPolicy, QoSPresetProfiles, QoSProfile, TopicEndpointInfo,
        TopicEndpointTypeEnum, TypeHash
    """,
    "rclpy.topic_or_service_is_hidden": """
        HIDDEN_TOPIC_PREFIX, topic_or_service_is_hidden
    """,
    "rclpy.type_description_service": """
        check_is_valid_srv_type, Parameter, Service,
        START_TYPE_DESCRIPTION_SERVICE_PARAM, TypeDescriptionService
    """,
    "rclpy.type_hash": "TypeHash",
    "rclpy.type_support": """
        check_for_type_support, check_is_valid_action_type, check_is_valid_msg_type,
        check_is_valid_srv_type, Msg, MsgT, NoTypeSupportImportedException, SrvEventT,
        SrvRequestT, SrvResponseT
    """,
    "rclpy.utilities": """
        Context, get_available_rmw_implementations, get_default_context,
        get_rmw_implementation_identifier, ok, remove_ros_args, S_TO_NS, shutdown,
        timeout_sec_to_nsec, try_shutdown
    """,
    "rclpy.validate_full_topic_name": """
        InvalidServiceNameException, InvalidTopicNameException, validate_full_topic_name
    """,
    "rclpy.validate_namespace": "InvalidNamespaceException, validate_namespace",
    "rclpy.validate_node_name": "InvalidNodeNameException, validate_node_name",
    "rclpy.validate_parameter_name": """
        InvalidParameterException, validate_parameter_name
    """,
    "rclpy.validate_topic_name": """
        InvalidServiceNameException, InvalidTopicNameException, TOPIC_SEPARATOR_STRING,
        validate_topic_name
    """,
    "rclpy.wait_for_message": """
        Node, QoSProfile, SignalHandlerGuardCondition, timeout_sec_to_nsec,
        wait_for_message
    """,
    "rclpy.waitable": "CallbackGroup, Future, NumberOfEntities, Waitable",
}
# The former name of rclpy.event_handler.
_MODULES["rclpy.qos_event"] = _MODULES["rclpy.event_handler"]


class Place(NamedTuple):
    """Where Navette defines a name of rclpy."""

    module: str
    attribute: str


@cache
def rclpy_modules() -> dict[str, dict[str, Place]]:
    """Return rclpy's modules, each with its names and their places."""
    places = _places()
    return {
        module: dict(_export(name, places) for name in _split(names))
        for module, names in _MODULES.items()
    }


def _places() -> dict[str, Place]:
    places = {}
    for module, names in _ORIGINS.items():
        for name in _split(names):
            attribute, _, alias = name.partition(" as ")
            places[alias or attribute] = Place(module, attribute)
    return places


def _export(name: str, places: dict[str, Place]) -> tuple[str, Place]:
    module, _, attribute = name.rpartition(".")
    return attribute, Place(module, attribute) if module else places[attribute]


def _split(names: str) -> list[str]:
    return [name.strip() for name in names.split(",") if name.strip()]
