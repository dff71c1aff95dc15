"""Queue of clients' commands for the executor, with a limit on the executor's time.

Clients' commands run on the thread of the robot's nodes. The queue runs them in small
slices between other callbacks, the clients in turn, so that the commands of one client
delay neither the robot nor the commands of other clients.
"""

import itertools
import threading
import time
from collections import OrderedDict, deque
from collections.abc import Callable, Hashable

from navette.viewer.token_bucket import TokenBucket

_SLICE_S = 0.002  # after which other callbacks run first
_SHARE = 0.1  # seconds of the executor's time per second
_BURST_S = 0.1

Command = Callable[[], None]


class CommandQueue:
    """Commands in lanes, one lane per client; lanes take turns.

    :meth:`add` is called on any thread, commands run on the executor's.

    Args:
        run_soon: runs a function on the executor's thread.
        run_later: runs a function on the socket thread after a delay in seconds.
        now_s: monotonic wall time.
        cpu_s: CPU time of the calling thread: waiting for the interpreter is not work.
    """

    def __init__(
        self,
        run_soon: Callable[[Command], None],
        run_later: Callable[[float, Command], None],
        now_s: Callable[[], float],
        *,
        cpu_s: Callable[[], float] = time.thread_time,
    ) -> None:
        self._run_soon, self._run_later, self._cpu_s = run_soon, run_later, cpu_s
        self._lanes: dict[Hashable, OrderedDict[Hashable, Command]] = {}
        self._turns: deque[Hashable] = deque()
        self._lock = threading.Lock()
        self._is_scheduled = False
        self._numbers = itertools.count()
        self._budget = TokenBucket(_SHARE, _BURST_S, now_s)

    def add(
        self, lane: Hashable, command: Command, key: Hashable | None = None
    ) -> None:
        """Queue a command behind those of its lane.

        Args:
            key: a queued command of the same key is dropped.
        """
        with self._lock:
            commands = self._lanes.get(lane)
            if commands is None:
                commands = self._lanes[lane] = OrderedDict()
                self._turns.append(lane)
            name = next(self._numbers) if key is None else (key,)
            commands.pop(name, None)
            commands[name] = command
            if self._is_scheduled:
                return
            self._is_scheduled = True
        self._run_soon(self._run_slice)

    def _run_slice(self) -> None:
        """Run commands for a short time, then let other callbacks run."""
        begin_s = self._cpu_s()
        while (command := self._next()) is not None:
            command()
            used_s = self._cpu_s() - begin_s
            if used_s >= _SLICE_S:
                break
        else:
            used_s = self._cpu_s() - begin_s
        self._budget.take(used_s)
        with self._lock:
            self._is_scheduled = bool(self._turns)
            if not self._is_scheduled:
                return
        wait_s = self._budget.wait_s()
        if wait_s:
            self._run_later(wait_s, lambda: self._run_soon(self._run_slice))
        else:
            self._run_soon(self._run_slice)

    def _next(self) -> Command | None:
        with self._lock:
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
