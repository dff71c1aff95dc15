"""No sequence of events leaves a moving robot that no source commands."""

import math

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from navette.msgs.geometry_msgs.msg import Twist, Vector3
from navette.msgs.std_msgs.msg import Bool, Empty
from navette.navigation.arbiter import (
    EMERGENCY_STOP,
    Arbiter,
    CommandLock,
    CommandSource,
    Velocity,
)
from navette.navigation.stack import RunOptions
from navette.navigation.stack.simulation import Simulation
from navette.runtime import Node

MS = 1_000_000
TIMEOUT_NS = 500 * MS
PRIORITIES = {"navigation": 10, "external": 50, "operator": 100}
#: Command timeout of the robot, the step that sends zeros, and braking from 1 m/s.
SETTLED_S = 1.2

events = st.lists(
    st.one_of(
        st.tuples(st.just("command"), st.sampled_from(sorted(PRIORITIES))),
        st.tuples(st.just("lock"), st.booleans()),
        st.tuples(st.sampled_from(["stop", "release"]), st.none()),
        st.tuples(st.just("wait"), st.integers(1, 2000)),
    ),
    max_size=40,
)


class Model:
    """The rules in short: newest commands, two flags, and what the wheels have."""

    def __init__(self) -> None:
        sources = [
            CommandSource(
                name, priority, TIMEOUT_NS, 1000 * MS, is_direct=name == "external"
            )
            for name, priority in PRIORITIES.items()
        ]
        self.mux = Arbiter(sources, [CommandLock("pause", 20)])
        self.now = self.number = 0
        self.wheels, self.wheels_ns = Velocity(), -(10**12)
        self.newest: dict[str, tuple[int, Velocity]] = {}
        self.stopped = self.paused = False

    def send(self, command: Velocity | None) -> None:
        if command is not None:
            self.wheels, self.wheels_ns = command, self.now

    def command(self, name: str) -> None:
        self.number += 1
        command = Velocity(vx=0.001 * self.number)
        self.newest[name] = (self.now, command)
        if name == "external":
            self.send(command)
        self.send(self.mux.receive(name, command, self.now))

    def lock(self, engaged: bool) -> None:
        self.paused = engaged
        self.send(self.mux.set_lock("pause", engaged=engaged, now_ns=self.now))

    def stop(self, _: object) -> None:
        self.stopped = True
        self.send(self.mux.stop(self.now))

    def release(self, _: object) -> None:
        if self.stopped:
            self.newest.clear()
        self.stopped = False
        self.send(self.mux.release(self.now))

    def wait(self, milliseconds: int) -> None:
        for _ in range(milliseconds):
            self.now += MS
            self.send(self.mux.step(self.now))

    def is_live(self, name: str) -> bool:
        return self.now - self.newest[name][0] < TIMEOUT_NS

    def check(self) -> None:
        """The wheels have zero, or the newest command of the source that commands."""
        self.send(self.mux.step(self.now))
        if self.stopped:
            assert self.mux.decide(self.now).commander == EMERGENCY_STOP
        if self.wheels == Velocity() or self.now - self.wheels_ns >= TIMEOUT_NS:
            return
        assert not self.stopped
        (name,) = [n for n, (_, each) in self.newest.items() if each == self.wheels]
        assert self.is_live(name)
        assert not (self.paused and PRIORITIES[name] < 20)
        higher = [n for n in self.newest if PRIORITIES[n] > PRIORITIES[name]]
        assert not any(map(self.is_live, higher))


@given(events)
def test_the_wheels_have_only_commands_of_a_live_unmasked_source(
    sequence: list[tuple[str, object]],
) -> None:
    model = Model()
    for name, argument in sequence:
        getattr(model, name)(argument)
        model.check()


actions = st.sampled_from(
    [
        *("goal", "cancel", "takeover", "let_go", "external", "stop", "release"),
        *("pause", "resume", "kill control", "kill arbiter", "kill planner", "wait"),
    ]
)


class Rig:
    """The whole stack in free space, an operator, and who commands at each moment."""

    def __init__(self) -> None:
        options = RunOptions(world="empty", headless=True, speed=math.inf)
        self.run = Simulation(options)
        self.node = Node("pilot", context=self.run.context)
        self.run.executor.add_node(self.node)
        create = self.node.create_publisher
        self.keys = create(Twist, "/cmd_vel_teleop", 10)
        self.wheels = create(Twist, "/cmd_vel", 10)
        self.flags = {
            "stop": (create(Bool, "/emergency_stop", 10), Bool(data=True)),
            "release": (create(Empty, "/emergency_stop/release", 10), Empty()),
            "pause": (create(Bool, "/pause_navigation", 10), Bool(data=True)),
            "resume": (create(Bool, "/pause_navigation", 10), Bool(data=False)),
            "cancel": (create(Empty, "/cancel_goal", 10), Empty()),
        }
        self.holds: str = ""
        self.commanded_ns = dict.fromkeys(
            ("control", "operator", "external"), -(10**12)
        )
        self.node.create_subscription(Twist, "/cmd_vel_nav", self._on_control, 10)
        self.node.create_timer(0.1, self._hold)
        self.is_stopped = False
        self.dead: set[str] = set()
        self.goals = 0

    def _on_control(self, msg: Twist) -> None:
        self._note("control", msg)

    def _note(self, who: str, msg: Twist) -> None:
        if msg.linear.x or msg.angular.z:
            self.commanded_ns[who] = self.run.context.clock.now_ns

    def _hold(self) -> None:
        if self.holds:
            command = Twist(linear=Vector3(x=0.3), angular=Vector3(z=0.5))
            (self.keys if self.holds == "operator" else self.wheels).publish(command)
            self._note(self.holds, command)

    def act(self, action: str) -> None:
        if action in self.flags:
            publisher, message = self.flags[action]
            publisher.publish(message)
            self.is_stopped = (self.is_stopped or action == "stop") and (
                action != "release"
            )
        elif action == "goal":
            self.goals += 1
            self.run.stack.missions.add_goal(8.0 * (-1) ** self.goals, 3.0)
        elif action in ("takeover", "external", "let_go"):
            self.holds = {"takeover": "operator", "let_go": ""}.get(action, action)
        elif action.startswith("kill"):
            name = action.split()[1]
            if name not in self.dead:
                self.dead.add(name)
                self.run.executor.remove_node(getattr(self.run.stack, name))

    def check(self, seconds: float) -> None:
        """Run, and compare the robot's motion with the commands all the time."""
        for _ in range(round(seconds / 0.1)):
            self.run.executor.spin_for(100 * MS)
            motion = self.run.sim.simulator.motion()
            moves = abs(motion.linear[0]) > 0.05 or abs(motion.angular[2]) > 0.1
            now = self.run.context.clock.now_ns
            recent = [
                n for n, t in self.commanded_ns.items() if now - t < SETTLED_S * 1e9
            ]
            assert not moves or recent, "moves, and no source commands"
            self._settled_stop(moves=moves, now=now)

    def _settled_stop(self, *, moves: bool, now: int) -> None:
        if not self.is_stopped:
            self.stopped_ns = now
        assert not moves or now - self.stopped_ns < SETTLED_S * 1e9, "moves in a stop"


@pytest.mark.slow
@settings(
    max_examples=6,
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow],
    derandomize=True,
)
@given(st.lists(st.tuples(actions, st.sampled_from([0.1, 0.7, 2.0])), max_size=8))
def test_no_sequence_leaves_a_moving_robot_that_no_source_commands(
    sequence: list[tuple[str, float]],
) -> None:
    rig = Rig()
    try:
        rig.check(0.5)
        for action, seconds in [("goal", 1.5), *sequence]:
            rig.act(action)
            rig.check(seconds)
        rig.holds = ""
        rig.act("cancel")
        rig.check(4.0)
        motion = rig.run.sim.simulator.motion()
        assert math.hypot(motion.linear[0], motion.angular[2]) < 0.05
    finally:
        rig.run.close()
