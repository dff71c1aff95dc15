"""rclpy.logging: loggers without a node."""

from collections.abc import Iterator
from pathlib import Path

import pytest

import navette
from navette.errors import InvalidValueError
from navette.runtime import LoggingSeverity, VirtualClock, program_log
from navette.runtime.context import get_default_context, reset_default_context
from navette.runtime.log_sinks import get_logging_directory


@pytest.fixture(autouse=True)
def fresh_default_context() -> Iterator[None]:
    reset_default_context()
    yield
    get_default_context().try_shutdown()
    reset_default_context()


def test_messages_before_init_go_to_the_console(
    capsys: pytest.CaptureFixture[str],
) -> None:
    logger = program_log.get_logger("early")
    assert logger.info("bird")
    assert not logger.debug("hidden")
    assert logger.get_child("child").warning("too")
    text = capsys.readouterr().err
    assert "[early]: bird" in text
    assert "[early.child]: too" in text


def test_messages_after_init_go_to_the_context(
    capsys: pytest.CaptureFixture[str],
) -> None:
    logger = program_log.get_logger("tool")
    navette.init(args=["--ros-args", "--disable-stdout-logs"], clock=VirtualClock())
    logger.info("suppressed")
    assert capsys.readouterr().err == ""
    records = []
    get_default_context().log.sinks.append(records.append)
    logger.info("once", once=True)
    assert [(r.name, r.message) for r in records] == [("tool", "once")]
    assert records[0].function == "test_messages_after_init_go_to_the_context"
    navette.shutdown()
    navette.init(args=[], clock=VirtualClock())
    logger.info("the next context's")
    assert len(records) == 1
    assert "the next context's" in capsys.readouterr().err


def test_levels_are_shared_with_the_loggers_of_nodes() -> None:
    navette.init(args=["--ros-args", "--disable-stdout-logs"], clock=VirtualClock())
    program_log.set_logger_level("arm", LoggingSeverity.ERROR)
    node = navette.Node("arm")
    assert node.get_logger().get_effective_level() is LoggingSeverity.ERROR
    assert program_log.get_logger_level("arm.hand") is LoggingSeverity.UNSET
    assert program_log.get_logger_effective_level("arm.hand") is LoggingSeverity.ERROR
    program_log.clear_config()
    assert program_log.get_logger_effective_level("arm") is LoggingSeverity.INFO


def test_names_of_levels_and_loggers() -> None:
    assert program_log.get_logging_severity_from_string("Warn") is LoggingSeverity.WARN
    with pytest.raises(InvalidValueError, match="known: unset, debug"):
        program_log.get_logging_severity_from_string("loud")
    with pytest.raises(ValueError, match="must not be empty"):
        program_log.get_logger("")
    with pytest.raises(ValueError, match="must not be empty"):
        program_log.get_logger("a").get_child("")


def test_the_directory_follows_the_environment(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path))
    assert get_logging_directory() == tmp_path
    monkeypatch.delenv("ROS_LOG_DIR")
    monkeypatch.setenv("ROS_HOME", str(tmp_path))
    assert get_logging_directory() == tmp_path / "log"
    monkeypatch.delenv("ROS_HOME")
    assert get_logging_directory() == Path.home() / ".ros" / "log"
