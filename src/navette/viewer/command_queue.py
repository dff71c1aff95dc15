"""Queue of clients' commands for the executor, with a limit on the executor's time.

Clients' commands run on the thread of the robot's nodes. The queue runs them in small
slices, the clients in turn, so that the commands of one client delay neither the robot
nor the commands of other clients. After each slice it rests: calls from other threads
run before the events that are due, so that slices without a rest would stop the clock.
"""

import itertools
import threading
from collections import OrderedDict, deque
from collections.abc import Callable, Hashable
from typing import Protocol

from navette.viewer.thread_bridge import ThreadBridge
from navette.viewer.token_bucket import TokenBucket
from navette.viewer.wall_clock import WallClock
from navette.viewer.work_time import WorkTime

_SLICE_S = 0.002  # after which other callbacks run first
_MAX_REST_S = 0.02  # after a slice, otherwise as long as the slice took
_SHARE = 0.1  # seconds of the executor's time per second
_BURST_S = 0.25  # a page that opens subscribes to some 40 topics

Command = Callable[[], None]


class CommandRunner(Protocol):
    """Runs commands on the executor's thread."""

    def add(
        self,
        lane: Hashable,
        command: Command,
        key: Hashable | None = None,
        *,
        is_next: bool = False,
    ) -> None:
        """Run a command behind those of its lane; return at once.

        Args:
            key: a command of the same key that has not run yet is dropped.
            is_next: before all other commands; for commands that end work.
        """


class CommandQueue:
    """Commands in lanes, one lane per client; lanes take turns.

    A :class:`CommandRunner` whose :meth:`add` is called on any thread.
    """

    def __init__(self, *, bridge: ThreadBridge, clock: WallClock) -> None:
        self._bridge, self._clock = bridge, clock
        self._work = WorkTime(clock)
        self._lanes: dict[Hashable, OrderedDict[Hashable, Command]] = {}
        self._turns: deque[Hashable] = deque()
        self._urgent: OrderedDict[Hashable, Command] = OrderedDict()
        self._lock = threading.Lock()
        self._is_scheduled = False
        self._numbers = itertools.count()
        self._budget = TokenBucket(_SHARE, _BURST_S, clock)
        self._rested_s = clock.now_s  # when the rest after the last slice ends

    def add(
        self,
        lane: Hashable,
        command: Command,
        key: Hashable | None = None,
        *,
        is_next: bool = False,
    ) -> None:
        with self._lock:
            name = next(self._numbers) if key is None else (key,)
            self._drop(lane, name)
            if is_next:
                self._urgent[lane, name] = command
            else:
                if lane not in self._lanes:
                    self._lanes[lane] = OrderedDict()
                    self._turns.append(lane)
                self._lanes[lane][name] = command
            if self._is_scheduled:
                return
            self._is_scheduled = True
            wait_s = self._wait_s()
        self._schedule(wait_s)

    def _run_slice(self) -> None:
        """Run commands for a short time, then let other callbacks run."""
        begin_s = self._clock.now_s
        self._work.begin()
        while (command := self._next()) is not None:
            command()
            if self._clock.now_s - begin_s >= _SLICE_S:
                break
        work_s, now_s = self._work.elapsed_s(), self._clock.now_s
        with self._lock:
            self._budget.take(work_s)
            self._rested_s = now_s + min(now_s - begin_s, _MAX_REST_S)
            self._is_scheduled = bool(self._turns or self._urgent)
            if not self._is_scheduled:
                return
            wait_s = self._wait_s()
        self._schedule(wait_s)

    def _wait_s(self) -> float:
        """Return the time until the next slice may begin."""
        return max(self._rested_s - self._clock.now_s, self._budget.wait_s())

    def _schedule(self, wait_s: float) -> None:
        if wait_s > 0.0:
            self._bridge.call_later(wait_s, self._run_soon)
        else:
            self._run_soon()

    def _run_soon(self) -> None:
        self._bridge.run_soon(self._run_slice, "command")

    def _drop(self, lane: Hashable, name: Hashable) -> None:
        self._urgent.pop((lane, name), None)
        commands = self._lanes.get(lane)
        if commands and commands.pop(name, None) is not None and not commands:
            del self._lanes[lane]
            self._turns.remove(lane)

    def _next(self) -> Command | None:
        with self._lock:
            if self._urgent:
                return self._urgent.popitem(last=False)[1]
            if not self._turns:
                return None
            lane = self._turns.popleft()
            commands = self._lanes[lane]
            _, command = commands.popitem(last=False)
            if commands:
                self._turns.append(lane)
            else:
                del self._lanes[lane]
            return command
