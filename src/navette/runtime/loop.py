"""Event loop of a context: runs all events in order of (time, sequence).

One thread at a time drives the loop. Events of the current time are in ``ready``, in
the order of creation; later events are in a heap. A callback that waits runs the loop
again from inside (nested) while its callback group is held.
"""

import heapq
import threading
from collections import deque
from collections.abc import Callable, Coroutine
from typing import Any, NamedTuple, NoReturn

from navette.errors import CallbackError
from navette.runtime.callback_groups import CallbackGroup, ReentrantCallbackGroup
from navette.runtime.callback_threads import group_of_this_thread
from navette.runtime.clock import ContextClock
from navette.runtime.events import Call, Entity
from navette.runtime.future import Task
from navette.runtime.time import seconds_to_ns
from navette.runtime.wakeup import new_wakeup

# How long a thread that may not drive the loop waits before it checks again.
_TURN_S = 0.005


RunCondition = Callable[[], bool]
"""Whether a run ends; called between two events."""


class _RunEnd(NamedTuple):
    """Conditions that end a run, as in :meth:`EventLoop.run`."""

    until_ns: int | None = None
    done: RunCondition | None = None
    limit: int | None = None
    stop: RunCondition | None = None


class EventLoop:
    """Runs events in order of (time, sequence) under one :class:`ContextClock`."""

    def __init__(self, clock: ContextClock) -> None:
        self.clock = clock
        self.ready: deque[Entity] = deque()
        #: True while the driving thread waits: code that adds an event must wake it.
        self.waiting = False
        self._heap: list[tuple[int, int, Any]] = []
        self._sequence = 0
        self._latest_ns = -(1 << 62)
        self._set_back_ns = 0  # sum of the steps back of the clock
        self.free_group = ReentrantCallbackGroup()
        #: Groups with their own rules that have parked events.
        self._ruled: list[CallbackGroup] = []
        self._ran = 0  # events since those groups' rules were called
        self._inbox: deque[Entity] = deque()
        self._wakeup = new_wakeup()
        self._attention = False
        self._closed = False
        self._driver: int | None = None
        self._running: Entity | None = None
        #: The last SystemExit of a callback, and the node whose callback it was.
        self.exit_of: tuple[SystemExit, str] | None = None
        self._lock = threading.Lock()
        # Entered by itself: Ctrl-C inside the condition's __enter__ leaves it locked.
        self._turn_lock = threading.RLock()
        self._turn = threading.Condition(self._turn_lock)
        self._others = 0  # threads that wait while another thread drives
        self._pending_execute = 0  # threads in execute() that wait for their turn

    def call_soon(
        self,
        function: Callable[[], Any],
        source: str = "call",
        node: str = "",
        group: CallbackGroup | None = None,
    ) -> Call:
        """Run ``function`` at the current time, after the events that are ready."""
        call = Call(function, group or self.free_group, source, node)
        self.ready.append(call)
        if self.waiting:
            self._wakeup.set()
        return call

    def call_soon_threadsafe(
        self, function: Callable[[], Any], source: str = "call", node: str = ""
    ) -> Call:
        """Run ``function`` between two callbacks; callable from any thread."""
        call = Call(function, self.free_group, source, node)
        self._inbox.append(call)
        self.wake()
        return call

    def call_at(
        self,
        time_ns: int,
        function: Callable[[], Any],
        source: str = "call",
        node: str = "",
    ) -> Call:
        """Run ``function`` at ``time_ns``, or now if that time has passed."""
        call = Call(function, self.free_group, source, node)
        self.schedule(time_ns, call)
        return call

    def schedule(self, time_ns: int, entity: Any) -> None:
        """Queue ``entity`` for ``time_ns`` and set its ``token``.

        The entity runs only if it still has that token.
        """
        with self._lock:
            self._sequence += 1
            entity.token = token = self._sequence
            heapq.heappush(self._heap, (time_ns, token, entity))
        if self.waiting:
            self._wakeup.set()

    def deadline_ns(self, timeout_sec: float | None) -> int | None:
        """Return the end of a timeout in ns; None (no limit) if None or negative."""
        if timeout_sec is None or timeout_sec < 0:
            return None
        return self.clock.now_ns + seconds_to_ns(float(timeout_sec))

    def wake(self) -> None:
        """Make the driving thread check its conditions."""
        self._attention = True
        if self.waiting:
            self._wakeup.set()
        self.notify_threads()

    def notify_threads(self) -> None:
        """Make the threads that wait for their turn check their conditions."""
        if self._others:
            with self._turn_lock:
                self._turn.notify_all()

    @property
    def now_ns(self) -> int:
        """Time of the present clock; callable from any thread."""
        return self.clock.now_ns

    @property
    def running_node(self) -> str:
        """Full name of the node whose callback runs in this thread, or empty."""
        if self._running is None or self.waiting or not self.in_driver_thread:
            return ""
        return self._running.origin()[0]

    def create_task(
        self,
        handler: Callable[..., Any] | Coroutine[Any, Any, Any],
        *args: Any,
        source: str = "task",
        node: str = "",
        step_group: CallbackGroup | None = None,
        **kwargs: Any,
    ) -> Task[Any]:
        """Run a function or coroutine on this loop; the task gets its result.

        With a ``step_group`` that has threads, the steps of the task run in them.
        """
        task: Task[Any] = Task(
            handler, args, kwargs, loop=self, source=source, node=node
        )

        def fail(error: Exception) -> None:
            awaited = task.has_done_callbacks
            task.set_exception(error)
            if not awaited:  # no other code would receive the exception
                raise error

        task.on_error = fail
        task.step_group = step_group
        self.call_soon(task, source, node, step_group)
        return task

    def close(self) -> None:
        """End every run; later runs return immediately."""
        self._closed = True
        self.wake()

    @property
    def is_running(self) -> bool:
        """Whether a thread is driving the loop."""
        return self._driver is not None

    @property
    def in_driver_thread(self) -> bool:
        """Whether the calling thread is driving the loop (runs inside a callback)."""
        return self._driver == threading.get_ident()

    @property
    def is_driven_elsewhere(self) -> bool:
        """Whether a thread other than the caller's is driving the loop."""
        return self._driver is not None and self._driver != threading.get_ident()

    def wait_for_end(self, timeout_s: float) -> bool:
        """Wait until no other thread runs a callback; call after :meth:`close`."""
        if self.in_driver_thread:
            return True
        with self._turn_lock:
            return self._turn.wait_for(lambda: self._driver is None, timeout_s)

    def run(
        self,
        *,
        until_ns: int | None = None,
        done: RunCondition | None = None,
        limit: int | None = None,
        stop: RunCondition | None = None,
        calling: bool = False,
    ) -> None:
        """Run events until one of the conditions holds.

        Args:
            until_ns: run all events up to and including this time, then stop.
            done: checked before every event.
            limit: maximum number of events.
            stop: a request from another thread; checked only after :meth:`wake`.
            calling: a callback waits for a service, so servers of its group may run.

        Under a virtual clock the run also ends when no events are left.

        Raises:
            CallbackError: a callback raised; names node, source and stamp.
        """
        end = _RunEnd(until_ns, done, limit, stop)
        if self.in_driver_thread:
            self._run_nested(end, calling=calling)
            return
        waiting = group_of_this_thread() if calling else None
        if waiting is None:
            self._run_in_turn(end)
            return
        waiting.begin_call()
        try:
            self._run_in_turn(end)
        finally:
            waiting.end_call()

    def _run_in_turn(self, end: _RunEnd) -> None:
        """Drive the loop, or wait for ``end`` while another thread does."""
        until_ns, done, _, stop = end
        while not self._closed and not (done is not None and done()):
            if self._take_turn():
                try:
                    self._run(end)
                finally:
                    self._give_turn()
                return
            if until_ns is not None and self.clock.now_ns >= until_ns:
                return
            if stop is not None and stop():
                return

    def run_calls(self, done: Callable[[], bool]) -> None:
        """Run calls of other threads and the events that result, until ``done`` holds.

        For a callback that waits while virtual time is stopped. Events that are ready
        already wait, so that a run without such calls stays deterministic. The group of
        the callback is not held. ``done`` is checked before every event and after
        :meth:`wake`.
        """
        assert self.in_driver_thread, "called from a callback"
        outer, others = self._running, list(self.ready)
        self.ready.clear()
        try:
            while True:
                self._attention = False
                if self._closed or done():
                    return
                self._run_inbox()
                self._run_ready(done, None)
                if self.ready or self._inbox or self._attention or done():
                    continue
                self.waiting = True
                # Checked again now that other threads see ``waiting``.
                if not (self._inbox or self._attention or self._closed):
                    self._wakeup.wait(None)
                self.waiting = False
                self._wakeup.clear()
        finally:
            self.waiting = False
            self.ready.extendleft(reversed(others))
            self._running = outer
            self._attention = True  # the wake-up may concern the outer run

    def take(self, until_ns: int | None, stop: Callable[[], bool]) -> Entity | None:
        """Return the next event that may run now, without running it.

        None if there is none until ``until_ns``, or ``stop`` holds.
        """
        while not self._closed and not stop():
            if self._pending_execute or not self._take_turn():
                self._yield_to_execute()
                if until_ns is not None and self.clock.now_ns >= until_ns:
                    return None
                continue
            try:
                self._attention = False
                self._collect()
                entity = self._next_ready()
                if entity is not None or not self._advance(until_ns):
                    return entity
            finally:
                self._give_turn()
        return None

    def execute(self, entity: Entity) -> None:
        """Run an event from :meth:`take` between two callbacks; from any thread.

        Raises:
            CallbackError: as :meth:`run`.
        """
        if self.in_driver_thread:
            self.ready.appendleft(entity)
            end = _RunEnd(until_ns=self.clock.now_ns, limit=1)
            self._run_nested(end, calling=False)
        elif self._claim_turn():
            try:
                self.ready.appendleft(entity)
                self._run(_RunEnd(until_ns=self.clock.now_ns, limit=1))
            finally:
                self._give_turn()

    def _claim_turn(self) -> bool:
        """Become the driver before any :meth:`take`; False once closed."""
        with self._turn_lock:
            self._pending_execute += 1
        self.wake()
        with self._turn_lock:
            while self._driver is not None and not self._closed:
                self._turn.wait(_TURN_S)
            self._pending_execute -= 1
            if not self._closed:
                self._driver = threading.get_ident()
            return not self._closed

    def _yield_to_execute(self) -> None:
        with self._turn_lock:
            if self._pending_execute:
                self._turn.wait(_TURN_S)

    def _next_ready(self) -> Entity | None:
        ready = self.ready
        while ready:
            entity = ready.popleft()
            if not self._must_wait(entity):
                return entity
            self._park(entity)
        return None

    @staticmethod
    def _must_wait(entity: Entity) -> bool:
        group = entity.group
        is_held = bool(group.held) and not (entity.runs_during_calls and group.calling)
        return is_held and group.blocks(entity)

    def _take_turn(self) -> bool:
        """Become the driver; False after a short wait if another thread is."""
        with self._turn_lock:
            if self._driver is not None:
                self._others += 1
                self._turn.wait(_TURN_S)
                self._others -= 1
            if self._driver is None:
                self._driver = threading.get_ident()
                return True
            return False

    def _give_turn(self) -> None:
        with self._turn_lock:
            self._driver = None
            self._turn.notify_all()

    def _run_nested(self, end: _RunEnd, *, calling: bool) -> None:
        outer = self._running
        held = outer.group if outer is not None and outer.group.exclusive else None
        # A coroutine's later step holds the group of the callback that started it.
        waiting = outer.waiting_group() if outer is not None and calling else None
        if held is not None:
            held.hold()
        if waiting is not None:
            waiting.begin_call()
        try:
            self._run(end)
        finally:
            if waiting is not None:
                waiting.end_call()
            if held is not None:
                held.release()
            self._running = outer
            self._attention = True  # the wake-up may concern the outer run

    def _run(self, end: _RunEnd) -> None:
        until_ns, done, limit, stop = end
        count = 0
        is_late = False
        self._watch_clock()
        set_back_ns = self._set_back_ns
        while not self._closed:
            self._attention = False
            if stop is not None and stop():
                self._attention = True  # for the runs around this one
                return
            self._collect()
            if until_ns is not None and self._set_back_ns != set_back_ns:
                until_ns += self._set_back_ns - set_back_ns
                set_back_ns = self._set_back_ns
            count += self._run_ready(done, self._batch(limit, count))
            if done is not None and done():
                return
            if limit is not None and count >= limit:
                return
            if until_ns is not None and self.clock.now_ns > until_ns:
                # A callback that waited has moved the time past the end. The events
                # parked meanwhile run once more only: each may wait as long again.
                if is_late:
                    return
                is_late = True
            if self.ready or self._inbox or self._attention:
                continue
            if not self._advance(until_ns):
                return

    def _batch(self, limit: int | None, count: int) -> int | None:
        """Return how many events to run before timers are looked at; None: all."""
        if self.clock.is_virtual:  # callbacks take no time
            return None if limit is None else limit - count
        return 1

    def _collect(self) -> None:
        """Move due events to ``ready``; run the calls of other threads."""
        now = self._watch_clock()
        heap = self._heap
        if heap and heap[0][0] <= now:
            with self._lock:
                # In real time a timer does not wait for all messages that are queued,
                # nor these for a timer that is always late: they take turns.
                at = len(self.ready) if self.clock.is_virtual else 1
                while heap and heap[0][0] <= now:
                    _, token, entity = heapq.heappop(heap)
                    if entity.token == token:
                        self.ready.insert(at, entity)
                        at += 1
        self._run_inbox()

    def _run_inbox(self) -> None:
        while self._inbox:
            # Not counted as an event: spin_once must still run one of the program's.
            self.ready.appendleft(self._inbox.popleft())
            # Not interruptible: otherwise the next call would overtake this one.
            self._run_ready(None, 1, interruptible=False)

    def _watch_clock(self) -> int:
        """Return the current time; move the events if the clock was set back."""
        now = self.clock.now_ns
        if now < self._latest_ns:
            self._follow_step_back(now - self._latest_ns)
        self._latest_ns = now
        return now

    def _follow_step_back(self, step_ns: int) -> None:
        """Move all events by a step back of the system clock.

        Otherwise timers would pause until the clock has reached the old time again.
        """
        self._set_back_ns += step_ns
        with self._lock:
            moved = [(time_ns + step_ns, *rest) for time_ns, *rest in self._heap]
            self._heap[:] = moved  # still a heap: the order is the same
        for _, token, entity in moved:
            if entity.token == token:
                entity.on_clock_set_back(step_ns)

    def _run_ready(
        self,
        done: Callable[[], bool] | None,
        limit: int | None,
        *,
        interruptible: bool = True,
    ) -> int:
        """Run the events that are ready at the start, at most ``limit``.

        An ``interruptible`` batch ends early after :meth:`wake`.
        """
        ready = self.ready
        count = 0
        for _ in range(len(ready)):
            if (interruptible and self._attention) or not ready or count == limit:
                break
            if done is not None and done():
                break
            entity = ready.popleft()
            group = entity.group
            rules = None
            if group.held and not (entity.runs_during_calls and group.calling):
                if group.blocks(entity) or not group.beginning_execution(entity):
                    self._park(entity)
                    continue
                rules = group if group.has_rules else None
                if group.threads is not None:
                    group.threads.start(entity, rules)
                    count += 1
                    continue
            self._running = entity
            count += 1
            try:
                result = entity.run()
            except (Exception, SystemExit) as error:  # a callback may raise anything
                self._raise(entity.origin(), error)
            if result is not None and isinstance(result, Coroutine):
                self._start(entity, result, rules)
            elif rules is not None:
                rules.ending_execution(entity)
        self._ran += count
        return count

    def _park(self, entity: Entity) -> None:
        group = entity.group
        group.parked.append(entity)
        if group.has_rules and group not in self._ruled:
            self._ruled.append(group)

    def _advance(self, until_ns: int | None) -> bool:
        """Advance to the next event's time; False without anything to wait for."""
        if self._retry_parked():
            return True
        heap = self._heap
        with self._lock:
            while heap and heap[0][2].token != heap[0][1]:
                heapq.heappop(heap)
            target = heap[0][0] if heap else None
        if until_ns is not None:
            if self.clock.now_ns >= until_ns:
                return False
            target = until_ns if target is None else min(target, until_ns)
        if target is None and self.clock.is_virtual and not self.clock.is_shared:
            return False
        self.waiting = True
        try:
            # Checked again now that other threads see ``waiting``: an event added in
            # between must not be missed.
            if self.ready or self._inbox or self._attention or self._closed:
                return True
            self.clock.go_to(target, self._wakeup)
        finally:
            self.waiting = False
            self._wakeup.clear()
        return True

    def _retry_parked(self) -> bool:
        """Call the groups' rules again if an event ran that may have changed them."""
        if self._ran and self._ruled:
            self._ran = 0
            for group in self._ruled:
                group.retry_parked()
        return bool(self.ready)

    def _start(
        self,
        entity: Entity,
        coroutine: Coroutine[Any, Any, Any],
        rules: CallbackGroup | None,
    ) -> None:
        """Run a coroutine callback; an exclusive group is held until it ends."""
        node, source = entity.origin()
        task: Task[Any] = Task(coroutine, loop=self, source=source, node=node)
        task.group = entity.group

        def fail(error: Exception) -> None:
            self._raise((node, source), error)

        task.on_error = fail
        task()
        if rules is not None:
            task.add_done_callback(lambda _: rules.ending_execution(entity))
        if not task.done() and entity.group.exclusive:
            group = entity.group
            group.hold()
            task.add_done_callback(lambda _: group.release())

    def _raise(
        self, origin: tuple[str, str], error: Exception | SystemExit
    ) -> NoReturn:
        if isinstance(error, SystemExit):
            self.exit_of = error, origin[0]
            raise error
        # A nested run or a coroutine's step has already named the source.
        if isinstance(error, CallbackError):
            raise error
        node, source = origin
        named = CallbackError.of(node or "(none)", source, self.clock.now_ns, error)
        raise named from error
