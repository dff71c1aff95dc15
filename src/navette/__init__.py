"""Robot navigation that you pip install.

rclpy's names are here too (``from navette import Node, spin``); they are loaded when
first used, so that ``import navette`` costs next to nothing.
"""

import sys
from importlib import import_module  # noqa: TID251 - see _COMMANDER
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

if TYPE_CHECKING:
    from navette.runtime import *  # noqa: F403 - for editors; see _RUNTIME_NAMES

_RUNTIME_NAMES = frozenset(
    """
    ActionClient ActionServer AsyncParameterClient Buffer CallbackGroup
    CancelResponse Client Clock ClockType Context DurabilityPolicy Duration Executor
    ExternalShutdownException Future GoalResponse HistoryPolicy Input LifecycleNode
    LifecyclePublisher LivelinessPolicy LoggingSeverity MultiThreadedExecutor
    MutuallyExclusiveCallbackGroup Node NotInitializedException Output PacedClock
    Parameter ParameterAlreadyDeclaredException ParameterEventHandler
    ParameterNotDeclaredException Publisher QoSPresetProfiles QoSProfile ROSClock
    ROSInterruptException Rate ReentrantCallbackGroup ReliabilityPolicy Service
    SingleThreadedExecutor StageNode StaticTransformBroadcaster Subscription
    SystemClock Task Time Timer TransformBroadcaster TransformListener
    TransitionCallbackReturn VirtualClock create_node deserialize_message
    get_default_context get_global_executor init ok qos_profile_sensor_data
    qos_profile_system_default remove_ros_args serialize_message shutdown spin
    spin_once spin_until_future_complete try_shutdown
    """.split()
)

# Nav2's commander, for programs that command a robot. Imported by name: the runtime and
# other layers below it import this module for the version.
_COMMANDER_NAMES = frozenset({"BasicNavigator", "TaskResult"})
_COMMANDER = "navette.ros2.packages.nav2_simple_commander"

__all__ = ["__version__", *sorted(_RUNTIME_NAMES | _COMMANDER_NAMES)]


def __getattr__(name: str) -> Any:
    value: Any
    if name in _RUNTIME_NAMES:
        from navette import runtime

        value = getattr(runtime, name)
    elif name in _COMMANDER_NAMES:
        value = getattr(import_module(_COMMANDER), name)
    else:
        raise AttributeError(f"module 'navette' has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *_RUNTIME_NAMES, *_COMMANDER_NAMES})


def register_environment(gymnasium: Any) -> None:
    """Register the environment for learning by its name; it is loaded when made."""
    name = "navette/Navigation-v0"
    if name not in gymnasium.registry:
        gymnasium.register(
            name, entry_point="navette.navigation.gym.environment:NavigationEnv"
        )


if hasattr(sys.modules.get("gymnasium"), "register"):  # was imported before
    register_environment(sys.modules["gymnasium"])
