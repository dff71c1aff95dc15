"""The node ``arbiter``: velocity commands of all sources in, those of one out.

The node publishes no command before it has received one. The command of the source with
the highest priority is published at once, as it arrives; the commands of the others are
masked. When the last command of a source expires, and while a lock or the emergency
stop keeps the robot stopped, the node publishes zeros.
"""

import math
from collections.abc import Mapping
from dataclasses import fields, replace
from functools import partial
from typing import Any, ClassVar, TypeVar

from navette.errors import ParameterError
from navette.msgs import topics
from navette.msgs.ackermann_msgs.msg import AckermannDriveStamped
from navette.msgs.geometry_msgs.msg import Twist, TwistStamped
from navette.msgs.rcl_interfaces.msg import ParameterDescriptor
from navette.msgs.std_msgs.msg import Bool, Empty
from navette.navigation.arbiter.arbiter import (
    EMERGENCY_STOP,
    IDLE,
    Arbiter,
    CommandLock,
    CommandSource,
    Decision,
)
from navette.navigation.arbiter.command_limits import CommandLimits, Velocity
from navette.navigation.arbiter.params import (
    LOCKS,
    NAVIGATION,
    REFLEX,
    SOURCES,
    ArbiterParams,
    CommandLockParams,
    CommandSourceParams,
)
from navette.params import Params
from navette.runtime import Input, Output, StageNode
from navette.runtime.stage.status import StatusReporter, status_output
from navette.runtime.time import ns_to_stamp

_STEP_S = 0.1  # of zeros while the robot is kept stopped, and of checking the locks
_STAMPED = "geometry_msgs/msg/TwistStamped"

P = TypeVar("P", bound=Params)


def _commands(
    topic: topics.StackTopic, meaning: str, *, checks_contents: bool = False
) -> Input:
    """Declare an input of commands.

    Contents are usually not checked: an invalid command stops the robot, a dropped one
    would leave the last one valid.
    """
    return Input.of(
        topic,
        meaning,
        other_types=(_STAMPED,),
        checks_contents=checks_contents,
        callback="on_command",
    )


class ArbiterNode(StageNode):
    """Pass on the velocity commands of one source; stop the robot on request."""

    PARAMS = ArbiterParams
    PARAM_GROUPS: ClassVar = {
        "topics.NAME.": CommandSourceParams,
        "locks.NAME.": CommandLockParams,
    }
    FIXED_AT_START = frozenset({"use_stamped"})
    INPUTS = (
        _commands(
            topics.CMD_VEL_NAV,
            "commands of control and of behaviors (`topics.navigation`)",
        ),
        _commands(
            topics.CMD_VEL_TELEOP, "commands of the operator (`topics.operator`)"
        ),
        _commands(topics.CMD_VEL_REFLEX, "commands after a contact (`topics.reflex`)"),
        _commands(
            topics.CMD_VEL,
            "commands of programs beside the arbiter (`topics.external`)",
        ),
        Input.of(
            topics.DRIVE,
            "commands of programs that steer a car beside the arbiter (`topics.drive`)",
            checks_contents=False,
            callback="on_command",
        ),
        _commands(
            topics.CMD_VEL_ASSISTED,
            "commands of the operator after a check (`topics.assisted_teleop`)",
            checks_contents=True,
        ),
        Input.of(topics.PAUSE_NAVIGATION, "lock (`locks.pause`)", callback="on_lock"),
        Input.of(
            topics.EMERGENCY_STOP_ACTIVE,
            "the robot's own emergency stop (`locks.emergency_stop`)",
            callback="on_lock",
        ),
        Input.of(
            topics.EMERGENCY_STOP,
            "true engages the emergency stop; false has no effect",
            callback="on_emergency_stop",
        ),
        Input.of(
            topics.EMERGENCY_STOP_RELEASE,
            "releases the emergency stop",
            callback="on_release",
        ),
    )
    OUTPUTS = (
        Output.of(topics.CMD_VEL, "command to the wheels", other_types=(_STAMPED,)),
        Output.of(
            topics.CANCEL_GOAL, "when navigation is masked, if `after_…` is `end`"
        ),
        status_output(topics.COMMANDER.name),
    )

    params: ArbiterParams
    _moves = False  # destroy_node() may run before __init__ ends

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("arbiter", **kwargs)
        self._arbiter = Arbiter(
            [self._source(name) for name in self._sources],
            [self._lock(name) for name in self._locks],
            self._limits(),
        )
        self._status = StatusReporter(self, topics.COMMANDER.name)
        self._reported = ("", 0, "")  # commander, floor, refusal
        self._masked_nav = self._was_stopped = False
        #: Runs when the newest command of a source expires.
        self._expiries = {
            name: self.create_timer(each.timeout, self.on_timer, autostart=False)
            for name, each in self._sources.items()
            if each.timeout
        }
        self.create_timer(_STEP_S, self.on_timer)
        self._report(self._arbiter.decide(self._now_ns))

    def declare_params(self) -> Any:
        """Declare the sources and locks too, as twist_mux names them."""
        self._sources = self._declare_group("topics", CommandSourceParams, SOURCES)
        self._locks = self._declare_group("locks", CommandLockParams, LOCKS)
        return super().declare_params()

    def inputs(self) -> tuple[Input, ...]:
        usual = {each.topic: each for each in self.INPUTS}
        command, lock = usual[topics.CMD_VEL.name], usual[topics.PAUSE_NAVIGATION.name]
        return (
            *(
                replace(
                    usual[topics.DRIVE.name] if self._is_drive(each.topic) else command,
                    topic=each.topic,
                    callback=partial(self.on_command, name),
                    ignores_own=self._is_output(each.topic),
                )
                for name, each in self._sources.items()
            ),
            *(
                replace(
                    usual.get(each.topic, lock),
                    topic=each.topic,
                    callback=partial(self.on_lock, name),
                )
                for name, each in self._locks.items()
            ),
            usual[topics.EMERGENCY_STOP.name],
            usual[topics.EMERGENCY_STOP_RELEASE.name],
        )

    def outputs(self) -> tuple[Output, ...]:
        command, *others = self.OUTPUTS
        if not self.params.use_stamped:
            return self.OUTPUTS
        return replace(command, type=_STAMPED, other_types=(command.type,)), *others

    def on_command(
        self, name: str, msg: Twist | TwistStamped | AckermannDriveStamped
    ) -> None:
        """Pass on a command if its source has the highest priority."""
        velocity, now_ns = _velocity(msg), self._now_ns
        if name in self._expiries:
            self._expiries[name].reset()
        self._send(self._arbiter.receive(name, velocity, now_ns))
        refusal = self._arbiter.refusal(name)
        if refusal:
            self.get_logger().error(
                f"{refusal} of {name}: {velocity}; the limits are "
                f"{self.params.max_speed_mps:g} m/s and "
                f"{self.params.max_turn_rate_radps:g} rad/s (0: none)",
                throttle_duration_sec=1.0,
            )

    def on_lock(self, name: str, msg: Bool) -> None:
        """Engage or release a lock."""
        command = self._arbiter.set_lock(name, engaged=msg.data, now_ns=self._now_ns)
        self._send(command)

    def on_emergency_stop(self, msg: Bool) -> None:
        """Engage the emergency stop."""
        if not msg.data:
            return
        if not self._arbiter.is_stopped:
            self.get_logger().warning(
                "emergency stop; release it with: navette stop --release"
            )
        self._send(self._arbiter.stop(self._now_ns))

    def on_release(self, msg: Empty) -> None:
        """Release the emergency stop."""
        if self._arbiter.is_stopped:
            self.get_logger().info("emergency stop released")
        self._send(self._arbiter.release(self._now_ns))

    def on_timer(self) -> None:
        """Publish what the passing of time requires."""
        self._send(self._arbiter.step(self._now_ns))

    def on_params_changed(self, old: ArbiterParams) -> None:
        self._arbiter.limits = self._limits()

    def on_time_jump(self) -> None:
        """Drop all commands; an emergency stop remains engaged."""
        self._arbiter.reset()

    def destroy_node(self) -> None:
        """Stop the robot, then destroy the node."""
        if self._moves and self.context.ok():
            self._send(Velocity())
        super().destroy_node()

    @property
    def _now_ns(self) -> int:
        return self.get_clock().now_ns

    def _declare_group(
        self, group: str, kind: type[P], defaults: Mapping[str, P]
    ) -> dict[str, P]:
        """Declare ``GROUP.NAME.FIELD``; return the entries that have a topic."""
        given = [
            n.split(".") for n in self._node_overrides if n.startswith(f"{group}.")
        ]
        names = dict.fromkeys([*defaults, *(n[1] for n in given if len(n) == 3)])
        fixed = ParameterDescriptor(read_only=True, dynamic_typing=True)
        found = {}
        for name in names:
            usual = defaults.get(name) or kind()
            values = {
                field.name: self.declare_parameter(
                    f"{group}.{name}.{field.name}", getattr(usual, field.name), fixed
                ).value
                for field in fields(kind)
            }
            try:
                entry = kind(**values)
            except ParameterError as error:
                where = f"node {self.get_fully_qualified_name()}: {group}.{name}"
                raise ParameterError(f"{where}: {error}") from None
            if values["topic"]:
                found[name] = entry
        return found

    def _source(self, name: str) -> CommandSource:
        params = self._sources[name]
        return CommandSource(
            name,
            params.priority,
            timeout_ns=round(params.timeout * 1e9),
            hold_ns=round(params.hold * 1e9),
            is_direct=self._is_output(params.topic) or self._is_drive(params.topic),
            scales=params.over_limit == "scale",
        )

    def _lock(self, name: str) -> CommandLock:
        params = self._locks[name]
        return CommandLock(name, params.priority, round(params.timeout * 1e9))

    def _limits(self) -> CommandLimits:
        params = self.params
        return CommandLimits(
            params.max_speed_mps or math.inf, params.max_turn_rate_radps or math.inf
        )

    def _is_output(self, topic: str) -> bool:
        resolve = self.resolve_topic_name
        return resolve(topic) == resolve(topics.CMD_VEL.name)

    def _is_drive(self, topic: str) -> bool:
        """Return whether a topic carries speeds and steering angles to the wheels."""
        resolve = self.resolve_topic_name
        return resolve(topic) == resolve(topics.DRIVE.name)

    def _send(self, command: Velocity | None) -> None:
        """Publish a command, then the commander if it has changed."""
        if command is not None:
            self._moves = any(command)
            self.publish(topics.CMD_VEL.name, self._message(command))
        self._report(self._arbiter.decision)

    def _message(self, command: Velocity) -> Twist | TwistStamped:
        twist = Twist()
        twist.linear.x, twist.linear.y, twist.linear.z = command[:3]
        twist.angular.x, twist.angular.y, twist.angular.z = command[3:]
        if not self.params.use_stamped:
            return twist
        msg = TwistStamped(twist=twist)
        msg.header.stamp = ns_to_stamp(self._now_ns)
        msg.header.frame_id = self.params.base_frame
        return msg

    def _report(self, decision: Decision) -> None:
        refusal = self._arbiter.refusal(decision.commander)
        state = decision.commander, decision.floor, refusal
        if state == self._reported:
            return
        self._reported = state
        masked = self._arbiter.masked(self._now_ns)
        self._end_goal(decision.commander, masked)
        source = self._sources.get(decision.commander)
        is_lock = source is None and decision.commander != IDLE
        self._status.report(
            decision.commander,
            StatusReporter.WARN if is_lock or refusal else StatusReporter.OK,
            topic="" if source is None else self.resolve_topic_name(source.topic),
            nodes="" if source is None else self._nodes_on(source.topic),
            masked=",".join(masked),
            masked_topics=",".join(
                self.resolve_topic_name(self._sources[name].topic) for name in masked
            ),
            refused=refusal,
        )

    def _end_goal(self, commander: str, masked: list[str]) -> None:
        """Cancel navigation's goal as it is masked, if a parameter requires it."""
        before, self._masked_nav = self._masked_nav, NAVIGATION in masked
        stops = commander == EMERGENCY_STOP
        after = self.params.after_stop if stops else self.params.after_takeover
        if commander == REFLEX:  # navigation itself reacts to the contact
            after = "resume"
        began = self._masked_nav and (not before or (stops and not self._was_stopped))
        self._was_stopped = stops
        if began and after == "end":
            self.publish(topics.CANCEL_GOAL.name, Empty())

    def _nodes_on(self, topic: str) -> str:
        """Return the other nodes that publish on a topic."""
        own = self.get_fully_qualified_name()
        found = {
            f"{info.node_namespace.rstrip('/')}/{info.node_name}"
            for info in self.get_publishers_info_by_topic(topic)
        }
        return ",".join(sorted(found - {own}))


def _velocity(msg: Twist | TwistStamped | AckermannDriveStamped) -> Velocity:
    """Return the velocity of a command; of a steered one the speed alone."""
    if isinstance(msg, AckermannDriveStamped):
        return Velocity(msg.drive.speed)
    twist = msg.twist if isinstance(msg, TwistStamped) else msg
    linear, angular = twist.linear, twist.angular
    return Velocity(linear.x, linear.y, linear.z, angular.x, angular.y, angular.z)
