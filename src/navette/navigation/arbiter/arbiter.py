"""Command multiplexer with priorities, timeouts and locks, after twist_mux.

The live source with the highest priority commands. A lock masks every source of a lower
priority. The emergency stop masks all of them and stays engaged until it is released.

Differences from twist_mux: a command that expires is followed by zero; with ``hold``,
the sources of lower priority stay masked for a while after that; a *direct* source
publishes on the output itself, and its commands are overruled unless it commands.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

from navette.errors import UnknownNameError
from navette.navigation.arbiter.command_limits import ZERO, CommandLimits, Velocity

IDLE = "idle"
EMERGENCY_STOP = "emergency_stop"
_ALL = 256  # above every priority
_REPEAT_NS = 100_000_000  # period of the zeros while the robot is kept stopped


@dataclass(frozen=True)
class CommandSource:
    """A source of commands.

    Attributes:
        timeout_ns: age at which a command expires; 0: never.
        hold_ns: how long sources of lower priority stay masked after that.
        is_direct: whether its commands reach the wheels without the arbiter.
        scales: whether commands over the limits are scaled instead of refused.
    """

    name: str
    priority: int
    timeout_ns: int = 500_000_000
    hold_ns: int = 0
    is_direct: bool = False
    scales: bool = False


@dataclass(frozen=True)
class CommandLock:
    """A lock; without a message for ``timeout_ns`` (0: no limit) it is engaged."""

    name: str
    priority: int
    timeout_ns: int = 0


class Decision(NamedTuple):
    """Who commands, and what.

    Attributes:
        commander: name of a source or lock, ``idle`` or ``emergency_stop``.
        floor: sources of a lower priority are masked.
        command: None if the arbiter has nothing to publish.
        is_held: whether the robot is kept stopped by a lock or after a source.
    """

    commander: str
    floor: int
    command: Velocity | None
    is_held: bool = False


class _SourceState:
    """The newest command of a source."""

    def __init__(self, source: CommandSource) -> None:
        self.source = source
        self.stamp_ns: int | None = None
        self.command = ZERO
        self.refusal = ""

    def is_live(self, now_ns: int) -> bool:
        if self.stamp_ns is None:
            return False
        timeout_ns = self.source.timeout_ns
        return not timeout_ns or now_ns - self.stamp_ns < timeout_ns

    def holds(self, now_ns: int) -> bool:
        """Whether the newest command has expired and lower priorities stay masked."""
        if self.stamp_ns is None or not self.source.hold_ns:
            return False
        end_ns = self.source.timeout_ns + self.source.hold_ns
        return now_ns - self.stamp_ns < end_ns and not self.is_live(now_ns)


class Arbiter:
    """Chooses the command; :meth:`receive` and :meth:`step` return what to publish.

    All times are those of one clock, which does not go backward (else :meth:`reset`).
    """

    def __init__(
        self,
        sources: Iterable[CommandSource],
        locks: Iterable[CommandLock] = (),
        limits: CommandLimits | None = None,
    ) -> None:
        ordered = sorted(sources, key=lambda each: -each.priority)
        self._sources = {each.name: _SourceState(each) for each in ordered}
        ordered_locks = sorted(locks, key=lambda each: -each.priority)
        self._locks = {each.name: each for each in ordered_locks}
        self._locked: dict[str, bool] = {}
        self._locked_ns: dict[str, int] = {}
        self._published = ZERO
        self._published_ns: int | None = None
        self._commander = IDLE
        self.limits = limits or CommandLimits()
        #: That of the newest command, lock or step.
        self.decision = Decision(IDLE, 0, None)
        #: Whether the emergency stop is engaged.
        self.is_stopped = False

    def reset(self) -> None:
        """Drop all commands and the age of all locks; an emergency stop remains."""
        for state in self._sources.values():
            state.stamp_ns = None
        self._locked_ns.clear()
        self._published_ns = None

    def receive(self, name: str, command: Velocity, now_ns: int) -> Velocity | None:
        """Store the command of a source and return the command to publish, if any."""
        state = self._source(name)
        source = state.source
        state.stamp_ns = now_ns
        if source.scales:
            command = self.limits.scaled(command)
        state.refusal = self.limits.refusal(command)
        state.command = ZERO if state.refusal else command
        decision = self.decision = self.decide(now_ns)
        if decision.commander == name:
            self._commander = name
            return self._publish(decision.command, now_ns)
        if source.is_direct:  # the wheels have received its command: overrule it
            return self._publish(decision.command or ZERO, now_ns)
        return self.step(now_ns)

    def set_lock(self, name: str, *, engaged: bool, now_ns: int) -> Velocity | None:
        """Store the state of a lock and return the command to publish, if any."""
        self._locked[name] = engaged
        self._locked_ns[name] = now_ns
        return self.step(now_ns)

    def stop(self, now_ns: int) -> Velocity | None:
        """Engage the emergency stop and return the command to publish."""
        self.is_stopped = True
        return self.step(now_ns)

    def release(self, now_ns: int) -> Velocity | None:
        """Release the emergency stop. No command of the time before it counts."""
        if self.is_stopped:
            self.is_stopped = False
            for state in self._sources.values():
                state.stamp_ns = None
        return self.step(now_ns)

    def step(self, now_ns: int) -> Velocity | None:
        """Return the command to publish because time has passed or a lock changed."""
        decision = self.decision = self.decide(now_ns)
        changed = decision.commander != self._commander
        self._commander = decision.commander
        if decision.is_held:
            due = (
                self._published_ns is None or now_ns - self._published_ns >= _REPEAT_NS
            )
            if changed or due or self._published != ZERO:
                return self._publish(ZERO, now_ns)
            return None
        if not changed:
            return None
        if decision.commander == IDLE:
            return self._publish(ZERO, now_ns)
        return self._publish(decision.command, now_ns)

    def decide(self, now_ns: int) -> Decision:
        """Return who commands now."""
        if self.is_stopped:
            return Decision(EMERGENCY_STOP, _ALL, ZERO, is_held=True)
        lock = self._highest_lock(now_ns)
        floor = 0 if lock is None else lock.priority
        for name, state in self._sources.items():
            priority = state.source.priority
            if priority < floor:
                break  # so are the others
            if state.is_live(now_ns):
                command = None if state.source.is_direct else state.command
                return Decision(name, max(priority, floor), command)
            if state.holds(now_ns):
                return Decision(name, priority, ZERO, is_held=True)
        if lock is not None:
            return Decision(lock.name, floor, ZERO, is_held=True)
        return Decision(IDLE, 0, None)

    def masked(self, now_ns: int) -> list[str]:
        """Return the names of the sources whose commands do not count now."""
        floor = self.decide(now_ns).floor
        return [n for n, s in self._sources.items() if s.source.priority < floor]

    def refusal(self, name: str) -> str:
        """Return why the newest command of a source is refused; "" if it is not."""
        state = self._sources.get(name)
        return "" if state is None else state.refusal

    def _source(self, name: str) -> _SourceState:
        state = self._sources.get(name)
        if state is None:
            raise UnknownNameError.of("source", name, list(self._sources))
        return state

    def _highest_lock(self, now_ns: int) -> CommandLock | None:
        for lock in self._locks.values():  # the highest priority first
            if self._engaged(lock, now_ns):
                return lock
        return None

    def _engaged(self, lock: CommandLock, now_ns: int) -> bool:
        is_locked = self._locked.get(lock.name, False)
        if is_locked or not lock.timeout_ns:
            return is_locked
        stamp_ns = self._locked_ns.get(lock.name)
        return stamp_ns is None or now_ns - stamp_ns >= lock.timeout_ns

    def _publish(self, command: Velocity | None, now_ns: int) -> Velocity | None:
        """Note what is published; the last check of every command is here."""
        if command is None:
            return None
        if self.limits.refusal(command):
            command = ZERO
        self._published, self._published_ns = command, now_ns
        return command
