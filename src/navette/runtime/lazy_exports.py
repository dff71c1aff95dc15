"""Public names of the runtime whose modules are imported on first use."""

from typing import Any

_ACTION = frozenset({"ActionClient", "ActionServer", "CancelResponse", "GoalResponse"})
_LIFECYCLE = frozenset(
    {"LifecycleNode", "LifecyclePublisher", "TransitionCallbackReturn"}
)
_STAGE_NODE = frozenset({"Input", "Output", "StageNode"})
_STATUS = frozenset({"StatusReporter", "status_output"})
_TF = frozenset(
    {
        "Buffer",
        "StaticTransformBroadcaster",
        "TransformBroadcaster",
        "TransformListener",
    }
)
_PARAMETERS = frozenset(
    {
        "AsyncParameterClient",
        "ParameterEventHandler",
        "declare_params",
        "read_parameter_file",
    }
)
_SERIALIZATION = frozenset({"deserialize_message", "serialize_message"})


def find(name: str) -> Any:
    """Import and return the object of that name.

    Raises:
        AttributeError: the name is unknown.
    """
    module: Any
    if name in _ACTION:
        from navette.runtime import action as module
    elif name in _LIFECYCLE:
        from navette.runtime import lifecycle as module
    elif name in _SERIALIZATION:
        from navette.runtime import serialization as module
    elif name in _TF:
        from navette.runtime import tf as module
    elif name in _STAGE_NODE:
        from navette.runtime.stage import stage_node as module
    elif name in _STATUS:
        from navette.runtime.stage import status as module
    elif name in _PARAMETERS:
        module = _parameter_module(name)
    else:
        raise AttributeError(f"module 'navette.runtime' has no attribute {name!r}")
    return getattr(module, name)


def _parameter_module(name: str) -> Any:
    module: Any
    if name == "declare_params":
        from navette.runtime.stage import params as module
    elif name == "AsyncParameterClient":
        from navette.runtime import parameter_client as module
    elif name == "ParameterEventHandler":
        from navette.runtime import parameter_event_handler as module
    else:
        from navette.runtime import parameter_files as module
    return module
