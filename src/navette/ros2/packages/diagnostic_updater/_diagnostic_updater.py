"""Diagnostic tasks and the updater that publishes their statuses."""

# ruff: noqa: N802 - the names are diagnostic_updater's

import threading
from collections.abc import Callable
from typing import Any, NamedTuple

from navette.msgs import topics
from navette.msgs.diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from navette.ros2.packages.diagnostic_updater._diagnostic_status_wrapper import (
    DiagnosticStatusWrapper,
)
from navette.runtime import Node

Fill = Callable[[DiagnosticStatusWrapper], DiagnosticStatusWrapper]

_PERIOD = "diagnostic_updater.period"
_USE_FQN = "diagnostic_updater.use_fqn"


class DiagnosticTask:
    """Base of the diagnostic tasks."""

    def __init__(self, name: str) -> None:
        self.name = name

    def getName(self) -> str:
        return self.name

    def run(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        """Fill the status and return it."""
        return stat


class FunctionDiagnosticTask(DiagnosticTask):
    """Task that calls a function."""

    def __init__(self, name: str, fn: Fill) -> None:
        super().__init__(name)
        self.fn = fn

    def run(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        return self.fn(stat)


class CompositeDiagnosticTask(DiagnosticTask):
    """Several tasks with one status: the worst level and its messages."""

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.tasks: list[DiagnosticTask] = []

    def addTask(self, t: DiagnosticTask) -> None:
        self.tasks.append(t)

    def run(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        given, combined = DiagnosticStatusWrapper(), DiagnosticStatusWrapper()
        given.summary(stat)
        for task in self.tasks:
            stat.summary(given)
            stat = _filled(task.name, task.run, stat)
            combined.mergeSummary(stat)
        stat.summary(combined)
        return stat


class _NamedFill(NamedTuple):
    name: str
    fn: Fill

    def run(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        stat.name = self.name
        return _filled(self.name, self.fn, stat)


class DiagnosticTaskVector:
    """List of tasks in the order in which they were added."""

    DiagnosticTaskInternal = _NamedFill

    def __init__(self) -> None:
        self.tasks: list[_NamedFill] = []
        self.lock = threading.RLock()

    def addedTaskCallback(self, task: _NamedFill) -> None:
        """Override to react to an added task."""

    def add(self, *args: Any) -> None:
        """Add a task: ``add(task)`` or ``add(name, function)``."""
        if len(args) == 1:
            args = args[0].getName(), args[0].run
        task = _NamedFill(*args)
        with self.lock:
            self.tasks.append(task)
            self.addedTaskCallback(task)

    def removeByName(self, name: str) -> bool:
        """Remove the first task of that name; return False if there is none."""
        with self.lock:
            for task in self.tasks:
                if task.name == name:
                    self.tasks.remove(task)
                    return True
        return False


class Updater(DiagnosticTaskVector):
    """Runs its tasks periodically and publishes their statuses.

    Args:
        node: publishes the statuses. Its parameters are ``diagnostic_updater.period``
            (s) and ``diagnostic_updater.use_fqn`` (use the node's full name).
        period: default of the parameter, in s.
    """

    def __init__(self, node: Node, period: float = 1.0) -> None:
        super().__init__()
        self.node = node
        self.publisher = node.create_publisher(
            DiagnosticArray, topics.DIAGNOSTICS.name, 1
        )
        self.period_parameter = _PERIOD
        self.use_fqn_parameter = _USE_FQN
        self.verbose = False
        self.hwid = ""
        self.warn_nohwid_done = False
        use_fqn = _parameter(node, _USE_FQN, False)
        self.node_name = node.get_fully_qualified_name() if use_fqn else node.get_name()
        self._period = float(_parameter(node, _PERIOD, float(period)))
        self.timer = node.create_timer(self._period, self.update)

    @property
    def period(self) -> float:
        """Time between two updates, in s."""
        return self._period

    @period.setter
    def period(self, period: float) -> None:
        self._period = period
        self.node.destroy_timer(self.timer)
        self.timer = self.node.create_timer(period, self.update)

    def setHardwareID(self, hwid: str) -> None:
        self.hwid = hwid

    def update(self) -> None:
        with self.lock:
            statuses = [self._run(task) for task in tuple(self.tasks)]
        is_fine = all(status.level == DiagnosticStatus.OK for status in statuses)
        if is_fine and not self.hwid and not self.warn_nohwid_done:
            self.warn_nohwid_done = True
            self.node.get_logger().warning(
                "diagnostic_updater: the hardware ID is not set; call setHardwareID "
                "(with 'none' if there is no device)"
            )
        self.publish(statuses)

    def force_update(self) -> None:
        self.update()

    def broadcast(self, lvl: bytes, msg: str) -> None:
        """Publish one summary for all tasks without running them."""
        statuses = []
        for task in tuple(self.tasks):
            status = DiagnosticStatusWrapper(name=task.name)
            status.summary(lvl, msg)
            statuses.append(status)
        self.publish(statuses)

    def publish(self, msg: DiagnosticStatus | list[Any]) -> None:
        """Publish one or several statuses, prefixed with the node's name."""
        array = DiagnosticArray()
        array.header.stamp = self.node.get_clock().now().to_msg()
        for status in msg if isinstance(msg, list) else [msg]:
            status.name = f"{self.node_name}: {status.name}"
            array.status.append(
                DiagnosticStatus(
                    level=status.level,
                    name=status.name,
                    message=status.message,
                    hardware_id=status.hardware_id,
                    values=status.values,
                )
            )
        self.publisher.publish(array)

    def addedTaskCallback(self, task: _NamedFill) -> None:
        status = DiagnosticStatusWrapper(name=task.name)
        status.summary(DiagnosticStatus.OK, "Node starting up")
        self.publish(status)

    def _run(self, task: _NamedFill) -> DiagnosticStatusWrapper:
        status = task.run(
            DiagnosticStatusWrapper(
                level=DiagnosticStatus.ERROR,
                name=task.name,
                message="No message was set",
                hardware_id=self.hwid,
            )
        )
        if self.verbose and status.level != DiagnosticStatus.OK:
            self.node.get_logger().warning(
                f"Non-zero diagnostic status. Name: {status.name}, "
                f"status {status.level[0]}: {status.message}"
            )
        return status


def _filled(
    name: str, fill: Fill, stat: DiagnosticStatusWrapper
) -> DiagnosticStatusWrapper:
    filled = fill(stat)
    if not isinstance(filled, DiagnosticStatus):
        raise TypeError(
            f"diagnostic task {name!r} must return the status that it received, "
            f"got {filled!r}"
        )
    return filled


def _parameter(node: Node, name: str, default: Any) -> Any:
    """Return a parameter's value; declare it if no other updater of the node has."""
    if node.has_parameter(name):
        return node.get_parameter(name).value
    return node.declare_parameter(name, default).value
