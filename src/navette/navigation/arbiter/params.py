"""Parameters of the arbiter; sources and locks are named as in twist_mux."""

from dataclasses import dataclass

from navette.msgs import topics
from navette.params import Params, param

_AFTER = ("resume", "end")


@dataclass(frozen=True, kw_only=True)
class ArbiterParams(Params):
    """Output of the arbiter; ``topics.NAME`` and ``locks.NAME`` are parameters too."""

    use_stamped: bool = param(
        False, "publish /cmd_vel as TwistStamped instead of Twist"
    )
    base_frame: str = param("base_link", "frame of stamped commands")
    after_takeover: str = param(
        "resume",
        "what becomes of navigation's goal when another source commands: it resumes "
        "afterwards, or it ends",
        choices=_AFTER,
    )
    after_stop: str = param(
        "resume",
        "what becomes of navigation's goal when the emergency stop is engaged",
        choices=_AFTER,
    )
    max_speed_mps: float = param(
        0.0, "limit of every command; 0: no limit", at_least=0.0
    )
    max_turn_rate_radps: float = param(
        0.0, "limit of every command; 0: no limit", at_least=0.0
    )


@dataclass(frozen=True, kw_only=True)
class CommandSourceParams(Params):
    """A source of commands: ``topics.NAME.topic``, ``.timeout``, …"""

    topic: str = param("", "topic of its commands; empty = none")
    timeout: float = param(
        0.5, "age in seconds at which a command expires; 0: never", at_least=0.0
    )
    priority: int = param(
        10, "the source with the highest priority commands", at_least=0, at_most=255
    )
    hold: float = param(
        0.0,
        "seconds for which the robot stays stopped after the last command expired, "
        "before a source of lower priority commands again",
        at_least=0.0,
    )
    over_limit: str = param(
        "refuse",
        "what to do with a command over the limits: refuse it, or scale it",
        choices=("refuse", "scale"),
    )


@dataclass(frozen=True, kw_only=True)
class CommandLockParams(Params):
    """A lock: ``locks.NAME.topic``, ``.timeout``, ``.priority``."""

    topic: str = param("", "topic of its state, std_msgs/msg/Bool; empty = none")
    timeout: float = param(
        0.0,
        "seconds without a message after which it is locked; 0: never",
        at_least=0.0,
    )
    priority: int = param(
        100, "masks every source of a lower priority", at_least=0, at_most=255
    )


NAVIGATION = "navigation"
REFLEX = "reflex"

SOURCES: dict[str, CommandSourceParams] = {
    NAVIGATION: CommandSourceParams(topic=topics.CMD_VEL_NAV.name, priority=10),
    # After a contact; operators and programs beside the arbiter overrule it.
    REFLEX: CommandSourceParams(
        topic=topics.CMD_VEL_REFLEX.name, priority=30, over_limit="scale"
    ),
    # Programs that publish the arbiter's output themselves.
    "external": CommandSourceParams(
        topic=topics.CMD_VEL.name, priority=50, hold=1.0, over_limit="scale"
    ),
    "drive": CommandSourceParams(
        topic=topics.DRIVE.name, priority=50, hold=1.0, over_limit="scale"
    ),
    "operator": CommandSourceParams(
        topic=topics.CMD_VEL_TELEOP.name, priority=100, hold=1.0, over_limit="scale"
    ),
    # The operator's commands after the collision check: they mask the unchecked ones.
    "assisted_teleop": CommandSourceParams(
        topic=topics.CMD_VEL_ASSISTED.name, priority=110, over_limit="scale"
    ),
}
"""The sources without any parameter."""

LOCKS: dict[str, CommandLockParams] = {
    "pause": CommandLockParams(topic=topics.PAUSE_NAVIGATION.name, priority=20),
    # The state of the robot's own emergency stop.
    "emergency_stop": CommandLockParams(
        topic=topics.EMERGENCY_STOP_ACTIVE.name, priority=255
    ),
}
"""The locks without any parameter."""
