import os
import re
import sys
from pathlib import Path
from typing import Any

import pytest

from navette.ros2.packages.launch import LaunchContext
from navette.ros2.packages.launch.conditions import (
    IfCondition,
    InvalidConditionExpressionError,
    LaunchConfigurationEquals,
    LaunchConfigurationNotEquals,
    UnlessCondition,
)
from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.substitutions import (
    AllSubstitution,
    AndSubstitution,
    AnonName,
    AnySubstitution,
    Command,
    EnvironmentVariable,
    EqualsSubstitution,
    FileContent,
    FindExecutable,
    IfElseSubstitution,
    LaunchConfiguration,
    LocalSubstitution,
    NotEqualsSubstitution,
    NotSubstitution,
    OrSubstitution,
    PathJoinSubstitution,
    PythonExpression,
    SubstitutionFailure,
    TextSubstitution,
    ThisLaunchFileDir,
)


@pytest.fixture
def context(launch: Any) -> LaunchContext:
    found: LaunchContext = launch.context
    found.launch_configurations.update(name="burger", sim="true", count="3")
    return found


@pytest.mark.parametrize(
    ("substitution", "text"),
    [
        (TextSubstitution(text="x"), "x"),
        (LaunchConfiguration("name"), "burger"),
        (LaunchConfiguration(["na", TextSubstitution(text="me")]), "burger"),
        (LaunchConfiguration("missing", default="else"), "else"),
        (LaunchConfiguration("missing", default=4), "4"),
        (EnvironmentVariable("NOT_SET_HERE", default_value="d"), "d"),
        (PathJoinSubstitution(["a", LaunchConfiguration("name"), "c"]), "a/burger/c"),
        (PathJoinSubstitution(["a"]) / [LaunchConfiguration("name"), ".x"],
         "a/burger.x"),
        (NotSubstitution("true"), "false"),
        (AndSubstitution("true", LaunchConfiguration("sim")), "true"),
        (OrSubstitution("false", "0"), "false"),
        (AnySubstitution("false", "1"), "true"),
        (AllSubstitution("true", "1", "false"), "false"),
        (EqualsSubstitution(LaunchConfiguration("name"), "burger"), "true"),
        (EqualsSubstitution("1.0", 1), "true"),
        (EqualsSubstitution(True, "1"), "true"),
        (NotEqualsSubstitution("a", None), "true"),
        (IfElseSubstitution(LaunchConfiguration("sim"), "yes", "no"), "yes"),
        (IfElseSubstitution("0", else_value="no"), "no"),
        (PythonExpression(["'", LaunchConfiguration("name"), "' == 'burger'"]), "True"),
        (PythonExpression(["not ", LaunchConfiguration("sim")]), "False"),
        (PythonExpression("math.floor(2.7) + sqrt(16)"), "6.0"),
        (FindExecutable(name="sh"), "/bin/sh"),
        (Command([sys.executable, " -c 'print(1+1)'"]), "2\n"),
    ],
    ids=lambda value: value.describe() if hasattr(value, "describe") else None,
)  # fmt: skip
def test_the_text_of_a_substitution(
    context: LaunchContext, substitution: Any, text: str
) -> None:
    found = substitution.perform(context)
    if text == "/bin/sh":
        assert found.endswith("/sh")
    else:
        assert found == text


@pytest.mark.parametrize(
    ("substitution", "reason"),
    [
        (LaunchConfiguration("nam"), "'nam' does not exist \\(known: .*name"),
        (EnvironmentVariable("NOT_SET_HERE"), "'NOT_SET_HERE' does not exist"),
        (NotSubstitution("perhaps"), "'perhaps': expected true"),
        (FindExecutable(name="no-such-thing"), "'no-such-thing' is not on PATH"),
        (FileContent("/no/such/file"), "File not found: /no/such/file"),
        (Command("no-such-thing"), "no-such-thing"),
        (Command([sys.executable, " -c 'exit(3)'"]), "command failed.*code 3"),
        (LocalSubstitution("event.pid"), "unknown local 'event.pid'"),
        (ThisLaunchFileDir(), "no launch file is running"),
        (PythonExpression("burger == 1"), "unknown name 'burger'"),
        (PythonExpression("1", ["no_module"]), "No module named 'no_module'"),
    ],
)
def test_a_failed_substitution_lists_the_known_values(
    context: LaunchContext, substitution: Any, reason: str
) -> None:
    with pytest.raises(SubstitutionFailure, match=reason):
        substitution.perform(context)


def test_standard_error_of_a_command_is_handled(
    context: LaunchContext, caplog: pytest.LogCaptureFixture
) -> None:
    words = [sys.executable, " -c 'import sys; print(1); sys.stderr.write(\"oh\")'"]
    with pytest.raises(SubstitutionFailure, match="oh"):
        Command(words).perform(context)
    assert Command(words, on_stderr="ignore").perform(context) == "1\n"
    assert Command(words, on_stderr="capture").perform(context) == "1\noh"
    Command(words, on_stderr="warn").perform(context)
    assert "oh" in caplog.text
    with pytest.raises(InvalidLaunchValueError, match="fail, ignore, warn, capture"):
        Command(words, on_stderr="shout").perform(context)


def test_environment_and_files(
    context: LaunchContext, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("NAVETTE_TEST", "from outside")
    assert EnvironmentVariable("NAVETTE_TEST").perform(context) == "from outside"
    (tmp_path / "a.txt").write_text("inside")
    assert FileContent([str(tmp_path), "/a.txt"]).perform(context) == "inside"


def test_an_anonymous_name_is_stable(context: LaunchContext) -> None:
    first = AnonName("rviz").perform(context)
    assert first == AnonName("rviz").perform(context)
    assert re.fullmatch(rf"rviz_\w+_{os.getpid()}_\d+", first)
    assert AnonName("other").perform(context) != first


@pytest.mark.parametrize("value", [3, 2.5, None, ["a", 3], {"a": 1}])
def test_invalid_substitutions_are_refused_on_construction(value: object) -> None:
    with pytest.raises(InvalidLaunchValueError, match="expected text"):
        LaunchConfiguration(value)  # type: ignore[arg-type]


def test_conditions(context: LaunchContext) -> None:
    assert IfCondition(LaunchConfiguration("sim")).evaluate(context)
    assert not UnlessCondition(LaunchConfiguration("sim")).evaluate(context)
    with pytest.raises(
        InvalidConditionExpressionError, match="'burger': expected true"
    ):
        IfCondition(LaunchConfiguration("name")).evaluate(context)


def test_conditions_that_ros2_deprecates(context: LaunchContext) -> None:
    with pytest.warns(UserWarning, match="use IfCondition with EqualsSubstitution"):
        is_burger = LaunchConfigurationEquals("name", "burger")
    with pytest.warns(UserWarning, match="LaunchConfigurationNotEquals is deprecated"):
        differs = LaunchConfigurationNotEquals("name", "waffle")
    with pytest.warns(UserWarning, match="deprecated"):
        is_missing = LaunchConfigurationEquals("missing", None)
    for condition in (is_burger, differs, is_missing):
        assert condition.evaluate(context)
