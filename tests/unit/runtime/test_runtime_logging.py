"""Logging: levels, filters, console, file, /rosout, the algorithms' loggers."""

import fcntl
import io
import logging
import os
import pty
import re
import struct
import termios
from dataclasses import replace
from pathlib import Path

import pytest

from navette.errors import FileFormatError, InvalidValueError
from navette.runtime import Context, LoggingSeverity, Node, VirtualClock
from navette.runtime.clock import Wakeup
from navette.runtime.log import Logger, LogHub, LogRecord
from navette.runtime.log_levels import severity_from_string
from navette.runtime.log_sinks import ConsoleSink, FileSink, format_record
from navette.runtime.loop import EventLoop
from navette.runtime.testing import GraphHarness


class Hub(LogHub):
    """A hub with a clock that the test sets."""

    def __init__(self) -> None:
        self.clock = VirtualClock()
        super().__init__(EventLoop(self.clock))
        self.records: list[LogRecord] = []
        self.sinks.append(self.records.append)

    @property
    def texts(self) -> list[str]:
        return [record.message for record in self.records]


@pytest.fixture
def hub() -> Hub:
    return Hub()


def test_levels(hub: Hub) -> None:
    logger = Logger("a", hub)
    assert not logger.debug("d")
    assert logger.info("i")
    assert logger.warning("w")
    assert logger.warn("w2")
    assert logger.error("e")
    assert logger.fatal("f")
    assert logger.log("l", LoggingSeverity.INFO)
    assert hub.texts == ["i", "w", "w2", "e", "f", "l"]
    assert [r.severity.name for r in hub.records[:5]] == [
        "INFO",
        "WARN",
        "WARN",
        "ERROR",
        "FATAL",
    ]


def test_children_inherit_the_nearest_level(hub: Hub) -> None:
    logger = Logger("a", hub)
    child = logger.get_child("b").get_child("c")
    assert child.name == "a.b.c"
    logger.set_level(LoggingSeverity.ERROR)
    assert child.get_effective_level() is LoggingSeverity.ERROR
    child.set_level(LoggingSeverity.DEBUG)
    assert child.is_enabled_for(LoggingSeverity.DEBUG)
    assert not logger.is_enabled_for(LoggingSeverity.WARN)
    child.set_level(LoggingSeverity.UNSET)
    assert child.get_effective_level() is LoggingSeverity.ERROR
    hub.set_level("", LoggingSeverity.WARN)
    assert Logger("other", hub).get_effective_level() is LoggingSeverity.WARN
    assert hub.get_level("") is LoggingSeverity.WARN
    with pytest.raises(InvalidValueError, match="child"):
        logger.get_child("")


def test_a_record_contains_file_and_line(hub: Hub) -> None:
    Logger("a", hub).info("here")
    record = hub.records[0]
    assert record.function == "test_a_record_contains_file_and_line"
    assert Path(record.file).name == "test_runtime_logging.py"
    assert record.line > 0


def test_once_skip_first_and_throttle(hub: Hub) -> None:
    logger = Logger("a", hub)
    for step in range(5):
        hub.clock.now_ns = step * 1_000_000_000
        logger.info(f"once {step}", once=True)
        logger.info(f"skip {step}", skip_first=True)
        logger.info(f"throttle {step}", throttle_duration_sec=2.0)
    assert hub.texts == [
        "once 0",
        "throttle 0",
        "skip 1",
        "skip 2",
        "throttle 2",
        "skip 3",
        "skip 4",
        "throttle 4",
    ]


def test_each_line_has_its_own_filters(hub: Hub) -> None:
    logger = Logger("a", hub)
    logger.info("first line", once=True)
    logger.info("second line", once=True)
    assert len(hub.records) == 2


def test_an_unknown_option_is_an_error(hub: Hub) -> None:
    with pytest.raises(TypeError, match="unknown logging option 'ones'"):
        Logger("a", hub).info("x", ones=True)


def test_a_filtered_line_has_one_severity(hub: Hub) -> None:
    logger = Logger("a", hub)

    def log(severity: LoggingSeverity) -> None:
        logger.log("x", severity, once=True)

    log(LoggingSeverity.INFO)
    with pytest.raises(ValueError, match="severity"):
        log(LoggingSeverity.ERROR)


def test_the_format_of_ros() -> None:
    record = LogRecord(1_500_000_001, LoggingSeverity.WARN, "robot.n", "text")
    assert format_record(record) == "[WARN] [1.500000001] [robot.n]: text"


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_console_is_coloured_on_a_terminal_only() -> None:
    record = LogRecord(0, LoggingSeverity.ERROR, "n", "text")
    plain, terminal = io.StringIO(), Terminal()
    ConsoleSink(plain)(record)
    ConsoleSink(terminal)(record)
    assert plain.getvalue() == "[ERROR] [0.000000000] [n]: text\n"
    assert terminal.getvalue().startswith("\x1b[31m[ERROR]")


def on_a_terminal(record: LogRecord, columns: int) -> list[str]:
    """Return the lines that a pseudo-terminal of a width receives."""
    controller, terminal = pty.openpty()
    with (
        os.fdopen(controller, "rb", buffering=0) as received,
        os.fdopen(terminal, "w") as stream,
    ):
        size = struct.pack("4H", 24, columns, 0, 0)
        fcntl.ioctl(stream.fileno(), termios.TIOCSWINSZ, size)
        ConsoleSink(stream)(record)
        stream.write("\0")
        stream.flush()
        # The terminal passes on what it gets in pieces.
        output = b""
        while not output.endswith(b"\0"):
            output += received.read(4096)
        return output[:-1].decode().splitlines()


LONG = LogRecord(
    0, LoggingSeverity.INFO, "n", "the planner has found no path\n a table"
)


def test_a_terminal_gets_lines_that_end_between_words() -> None:
    assert on_a_terminal(LONG, 40) == [
        "[INFO] [0.000000000] [n]: the planner",
        "  has found no path",
        " a table",
    ]
    warning = replace(LONG, severity=LoggingSeverity.WARN)
    first, *_, last = on_a_terminal(warning, 40)
    assert first == "\x1b[33m[WARN] [0.000000000] [n]: the planner"
    assert last == " a table\x1b[0m"


def test_a_pipe_and_a_terminal_without_a_size_get_one_line_per_record() -> None:
    lines = format_record(LONG).splitlines()
    assert on_a_terminal(LONG, 0) == lines
    piped = io.StringIO()
    ConsoleSink(piped)(LONG)
    assert piped.getvalue().splitlines() == lines


def test_the_console_is_standard_error(capsys: pytest.CaptureFixture[str]) -> None:
    context = Context(clock=VirtualClock())
    Node("n", context=context).get_logger().info("hello")
    assert capsys.readouterr().err == "[INFO] [0.000000000] [n]: hello\n"


def test_file(tmp_path: Path) -> None:
    path = tmp_path / "deep" / "run.log"
    context = Context(clock=VirtualClock())
    context.init(["--ros-args", "--log-file", str(path), "--disable-stdout-logs"])
    node = Node("n", context=context)
    node.get_logger().info("into the file")
    context.shutdown()
    node.get_logger().info("after the end")
    assert path.read_text() == "[INFO] [0.000000000] [n]: into the file\n"
    with pytest.raises(FileFormatError, match="cannot be written"):
        FileSink(tmp_path)


def test_level_arguments() -> None:
    context = Context(clock=VirtualClock())
    context.init(["--ros-args", "--log-level", "error", "--log-level", "n:=debug"])
    assert Node("n", context=context).get_logger().is_enabled_for(10)
    assert not Node("m", context=context).get_logger().is_enabled_for(30)
    assert severity_from_string("Warning") is LoggingSeverity.WARN
    with pytest.raises(InvalidValueError, match=r"loud.*known: unset, debug"):
        severity_from_string("loud")


def test_rosout_has_the_messages_of_the_node(graph: GraphHarness) -> None:
    logs = graph.collect("/rosout", "rcl_interfaces/msg/Log")
    graph.run_for(1.0)
    node = graph.add(Node("n", context=graph.context, namespace="/robot"))
    node.get_logger().get_child("part").warning("careful")
    node.get_logger().debug("not this")
    Node("silent", context=graph.context, enable_rosout=False).get_logger().info("x")
    graph.run_for(0)
    assert [(m.name, m.msg, m.level) for m in logs.messages] == [
        ("robot.n.part", "careful", 30)
    ]
    assert logs.last.stamp.sec == 1
    assert logs.last.function == "test_rosout_has_the_messages_of_the_node"


@pytest.fixture
def algorithm_logger() -> logging.Logger:
    return logging.getLogger("navette.navigation.planning.astar")


def test_messages_of_an_algorithm_belong_to_the_node(
    graph: GraphHarness, algorithm_logger: logging.Logger
) -> None:
    logs = graph.collect("/rosout", "rcl_interfaces/msg/Log")
    node = graph.add(Node("planner", context=graph.context))

    def work() -> None:
        algorithm_logger.info("expanded %d cells", 7)
        algorithm_logger.debug("not this")

    node.create_timer(0.5, work)
    graph.run_for(0.5)
    assert [(m.name, m.msg) for m in logs.messages] == [
        ("planner.astar", "expanded 7 cells")
    ]


def test_messages_of_an_algorithm_outside_callbacks_go_to_the_console(
    graph: GraphHarness,
    algorithm_logger: logging.Logger,
    capsys: pytest.CaptureFixture[str],
) -> None:
    algorithm_logger.warning("alone")
    assert re.search(
        r"\[WARN\] .*\[navette\.navigation\.planning\.astar\]: alone",
        capsys.readouterr().err,
    )


def test_messages_of_a_waiting_clock_belong_to_no_node(
    algorithm_logger: logging.Logger, capsys: pytest.CaptureFixture[str]
) -> None:
    """A lock-step that waits for others; whose callback ran last is chance."""

    class Talking(VirtualClock):
        def go_to(self, target_ns: int | None, wakeup: Wakeup) -> bool:
            algorithm_logger.warning("still waiting")
            return super().go_to(target_ns, wakeup)

    with GraphHarness(clock=Talking()) as graph:
        logs = graph.collect("/rosout", "rcl_interfaces/msg/Log")
        node = graph.add(Node("planner", context=graph.context))
        node.create_timer(0.5, lambda: None)
        graph.run_for(2.0)
        assert logs.messages == []
    output = capsys.readouterr().err
    assert "[navette.navigation.planning.astar]: still waiting" in output


def test_a_warning_of_two_nodes_with_one_name(
    graph: GraphHarness, capsys: pytest.CaptureFixture[str]
) -> None:
    Node("twin", context=graph.context)
    Node("twin", context=graph.context)
    assert "another node is named /twin" in capsys.readouterr().err
