import os
from pathlib import Path
from typing import Any

import pytest

from navette.ros2.packages.launch import LaunchDescription, LaunchIntrospector
from navette.ros2.packages.launch.actions import (
    AppendEnvironmentVariable,
    DeclareLaunchArgument,
    EmitEvent,
    ExecuteProcess,
    ForEach,
    ForLoop,
    GroupAction,
    IncludeLaunchDescription,
    Log,
    LogInfo,
    OpaqueFunction,
    RegisterEventHandler,
    ResetEnvironment,
    SetEnvironmentVariable,
    SetLaunchConfiguration,
    Shutdown,
    TimerAction,
    UnregisterEventHandler,
    UnsetEnvironmentVariable,
    UnsetLaunchConfiguration,
)
from navette.ros2.packages.launch.conditions import IfCondition
from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.event import Event
from navette.ros2.packages.launch.event_handler import EventHandler
from navette.ros2.packages.launch.event_handlers import OnShutdown
from navette.ros2.packages.launch.launch_description_sources import (
    PythonLaunchDescriptionSource,
)
from navette.ros2.packages.launch.substitutions import (
    EnvironmentVariable,
    LaunchConfiguration,
    ThisLaunchFileDir,
)


def log_value(name: str) -> LogInfo:
    return LogInfo(msg=[f"{name}=", LaunchConfiguration(name, default="-")])


def messages(caplog: pytest.LogCaptureFixture) -> list[str]:
    return [
        r.getMessage() for r in caplog.records if r.name == "navette.launch.launch.user"
    ]


def test_arguments_have_defaults_and_may_be_given(launch: Any, caplog: Any) -> None:
    code = launch.run(
        DeclareLaunchArgument("a", default_value="1"),
        DeclareLaunchArgument("b", default_value=["x", LaunchConfiguration("a")]),
        log_value("a"),
        log_value("b"),
        a="2",
    )
    assert code == 0
    assert messages(caplog) == ["a=2", "b=x2"]


def test_a_missing_required_argument_is_an_error(launch: Any) -> None:
    argument = DeclareLaunchArgument("map", description="the map's file")
    assert launch.run(argument) == 1
    assert "Required launch argument 'map'" in launch.errors
    assert "give map:=value (the map's file)" in launch.errors
    assert f"{__file__}:" in launch.errors
    assert "DeclareLaunchArgument('map')" in launch.errors


def test_choices_are_checked(launch: Any) -> None:
    with pytest.raises(
        InvalidLaunchValueError, match="'c' is not in provided choices: a, b"
    ):
        DeclareLaunchArgument("x", default_value="c", choices=["a", "b"])
    launch.run(DeclareLaunchArgument("x", choices=["a", "b"]), x="d")
    assert "'d' is not in provided choices: a, b" in launch.errors


def test_a_group_limits_the_scope_of_settings(
    launch: Any, caplog: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NAVETTE_A", "outer")
    show = LogInfo(msg=["env=", EnvironmentVariable("NAVETTE_A", default_value="-")])
    launch.run(
        SetLaunchConfiguration("x", "1"),
        GroupAction(
            [
                SetLaunchConfiguration("x", "2"),
                SetEnvironmentVariable("NAVETTE_A", "inner"),
                log_value("x"),
                show,
            ]
        ),
        log_value("x"),
        LogInfo(msg=["env=", EnvironmentVariable("NAVETTE_A")]),
        GroupAction([SetLaunchConfiguration("x", "3")], scoped=False),
        log_value("x"),
        GroupAction(
            [log_value("x"), log_value("y")],
            forwarding=False,
            launch_configurations={"y": "7"},
        ),
        UnsetLaunchConfiguration("x"),
        log_value("x"),
    )  # fmt: skip
    assert messages(caplog) == [
        *("x=2", "env=inner", "x=1", "env=outer", "x=3", "x=-", "y=7", "x=-"),
    ]
    assert os.environ["NAVETTE_A"] == "outer"


def test_environment_actions(launch: Any, caplog: Any) -> None:
    def show() -> LogInfo:
        return LogInfo(msg=EnvironmentVariable("NAVETTE_P", default_value="-"))

    launch.run(
        AppendEnvironmentVariable("NAVETTE_P", "b", separator=":"),
        AppendEnvironmentVariable("NAVETTE_P", "c", separator=":"),
        AppendEnvironmentVariable("NAVETTE_P", "a", prepend=True, separator=":"),
        show(),
        UnsetEnvironmentVariable("NAVETTE_P"),
        show(),
        SetEnvironmentVariable("NAVETTE_P", "x"),
        ResetEnvironment(),
        show(),
    )
    assert messages(caplog) == ["a:b:c", "-", "-"]
    assert "NAVETTE_P" not in os.environ


def test_timers_fire_in_order_with_their_scope(launch: Any, caplog: Any) -> None:
    def at(seconds: Any, name: str) -> TimerAction:
        return TimerAction(
            period=seconds,
            actions=[
                OpaqueFunction(
                    function=lambda context: LogInfo(
                        msg=f"{name} {context.loop.clock.now_ns / 1e9:g}"
                    )
                ),
                log_value("x"),
            ],
        )

    launch.run(
        GroupAction([SetLaunchConfiguration("x", "in"), at("2.5", "late")]),
        at(1, "early"),
    )
    assert messages(caplog) == ["early 1", "x=-", "late 2.5", "x=in"]


def test_a_timer_does_not_outlive_the_launch(launch: Any, caplog: Any) -> None:
    launch.run(
        TimerAction(period=10.0, actions=[LogInfo(msg="too late")]),
        TimerAction(period=1.0, actions=[Shutdown(reason="enough")]),
        RegisterEventHandler(
            OnShutdown(on_shutdown=lambda event, context: LogInfo(msg=event.reason))
        ),
    )
    assert messages(caplog) == ["enough"]
    assert launch.context.loop.clock.now_ns == 1_000_000_000


@pytest.mark.parametrize("period", ["soon", -1, float("nan")])
def test_a_wrong_period_is_refused(launch: Any, period: object) -> None:
    assert launch.run(TimerAction(period=period, actions=[])) == 1
    assert "period" in launch.errors


def test_custom_events(launch: Any, caplog: Any) -> None:
    class Found(Event):
        name = "test.Found"

    once = EventHandler(
        matcher=lambda event: isinstance(event, Found),
        entities=LogInfo(msg="once"),
        handle_once=True,
    )
    always = EventHandler(
        matcher=lambda event: isinstance(event, Found), entities=[LogInfo(msg="always")]
    )
    launch.run(
        RegisterEventHandler(once),
        RegisterEventHandler(always),
        EmitEvent(event=Found()),
        EmitEvent(event=Found()),
        TimerAction(
            period=1.0,
            actions=[UnregisterEventHandler(always), EmitEvent(event=Found())],
        ),
    )
    assert messages(caplog) == ["always", "once", "always"]


def test_a_function_may_return_entities_and_raise(launch: Any, caplog: Any) -> None:
    def setup(context: Any, name: str, *, count: int) -> list[Any]:
        return [[LogInfo(msg=f"{name} {i}")] for i in range(count)]

    def broken(context: Any) -> None:
        raise KeyError("lost")

    code = launch.run(
        OpaqueFunction(function=setup, args=["n"], kwargs={"count": 2}),
        OpaqueFunction(function=broken),
        LogInfo(msg="never"),
    )
    assert messages(caplog) == ["n 0", "n 1"]
    assert code == 1
    assert "OpaqueFunction(broken): KeyError: 'lost'" in launch.errors


def test_false_conditions_prevent_actions(launch: Any, caplog: Any) -> None:
    launch.run(
        LogInfo(msg="yes", condition=IfCondition("true")),
        LogInfo(msg="no", condition=IfCondition("false")),
        Log(msg="maybe", level="perhaps"),
    )
    assert messages(caplog) == ["yes"]
    assert "'perhaps'; expected debug, info" in launch.errors


LAUNCH_FILE = """
from launch_under_test import *

def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("who"),
        LogInfo(msg=["hello ", LaunchConfiguration("who")]),
        LogInfo(msg=ThisLaunchFileDir()),
    ])
"""


@pytest.fixture
def module(monkeypatch: pytest.MonkeyPatch) -> None:
    import sys
    import types

    names = types.ModuleType("launch_under_test")
    vars(names).update(
        LaunchDescription=LaunchDescription,
        DeclareLaunchArgument=DeclareLaunchArgument,
        LogInfo=LogInfo,
        LaunchConfiguration=LaunchConfiguration,
        ThisLaunchFileDir=ThisLaunchFileDir,
        IncludeLaunchDescription=IncludeLaunchDescription,
        PythonLaunchDescriptionSource=PythonLaunchDescriptionSource,
    )
    monkeypatch.setitem(sys.modules, "launch_under_test", names)


@pytest.mark.usefixtures("module")
def test_an_include_has_arguments_and_its_folder(
    launch: Any, caplog: Any, tmp_path: Path
) -> None:
    file = tmp_path / "part.launch.py"
    file.write_text(LAUNCH_FILE)
    code = launch.run(
        IncludeLaunchDescription(
            PythonLaunchDescriptionSource([str(tmp_path), "/part.launch.py"]),
            launch_arguments={"who": "world", "wo": "x"}.items(),
        ),
        log_value("who"),
    )
    assert code == 0, launch.errors
    assert messages(caplog) == ["hello world", str(tmp_path), "who=world"]
    assert "declares no argument 'wo'; declared: who" in caplog.text


@pytest.mark.usefixtures("module")
def test_an_include_without_a_required_argument(launch: Any, tmp_path: Path) -> None:
    file = tmp_path / "part.launch.py"
    file.write_text(LAUNCH_FILE)
    assert launch.run(IncludeLaunchDescription(str(file))) == 1
    assert launch.errors.startswith(f"{file}:6: DeclareLaunchArgument('who'): ")
    assert "'who' was not provided: give who:=value" in launch.errors


@pytest.mark.usefixtures("module")
@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("x = 1", "has no generate_launch_description"),
        ("def generate_launch_description(): return 3", "returned 3"),
        ("\n\nraise ValueError('oh')", "part.launch.py:3: ValueError: oh"),
        ("def f(:", "part.launch.py:1: SyntaxError"),
        (
            "from launch_under_test import *\ndef generate_launch_description():\n"
            "    return LaunchDescription([LogInfo(msg=3)])",
            "part.launch.py:3: InvalidLaunchValueError: 3",
        ),
        (
            "from launch_under_test import *\ndef generate_launch_description():\n"
            "    return LaunchDescription([IncludeLaunchDescription([__file__, ''])])",
            "nested deeper than 50",
        ),
    ],
)
def test_an_error_in_a_file_names_the_line(
    launch: Any, tmp_path: Path, text: str, reason: str
) -> None:
    file = tmp_path / "part.launch.py"
    file.write_text(text)
    assert launch.run(IncludeLaunchDescription([str(tmp_path), "/part.launch.py"])) == 1
    assert reason in launch.errors


def test_an_unknown_file_format(launch: Any, tmp_path: Path) -> None:
    (tmp_path / "a.toml").touch()
    launch.run(IncludeLaunchDescription(str(tmp_path / "a.toml")))
    assert "expected a file ending in .py, .xml, .launch, .yaml, .yml" in launch.errors
    with pytest.raises(InvalidLaunchValueError, match=r"\.items\(\)"):
        IncludeLaunchDescription("x", launch_arguments={"a": "b"})  # type: ignore[arg-type]


def test_an_action_runs_once(launch: Any) -> None:
    process = ExecuteProcess(cmd=["x"])
    launch.run(process, process)
    assert "can be executed once" in launch.errors


def test_loops_create_entities(launch: Any, caplog: Any) -> None:
    launch.run(
        ForLoop(LaunchConfiguration("n"), function=lambda i: LogInfo(msg=f"no {i}")),
        ForEach(
            LaunchConfiguration("robots"),
            function=lambda name, id=7: [LogInfo(msg=f"{name} {id + 1}")],
        ),
        ForEach("", function=lambda: LogInfo(msg="never")),
        ForEach("{}", function=lambda: LogInfo(msg="once")),
        n="2",
        robots="{name: 'a', id: 1};{name: b}",
    )
    assert messages(caplog) == ["no 0", "no 1", "a 2", "b 8", "once"]


@pytest.mark.parametrize(
    ("action", "reason"),
    [
        (lambda: ForLoop("two", function=list), "length 'two': expected 0"),
        (lambda: ForEach("[1", function=list), "not YAML"),
        (lambda: ForEach("[1]", function=list), "expected a mapping"),
    ],
)
def test_invalid_loops_are_errors(launch: Any, action: Any, reason: str) -> None:
    assert launch.run(action()) == 1
    assert reason in launch.errors


def test_a_description_can_be_inspected() -> None:
    inner = GroupAction([LogInfo(msg="a"), LogInfo(msg="b")])
    text = LaunchIntrospector().format_launch_description(
        LaunchDescription([inner, LogInfo(msg="c")])
    )
    assert text == (
        "LaunchDescription\n├── GroupAction\n│   ├── LogInfo('a')\n"
        "│   └── LogInfo('b')\n└── LogInfo('c')"
    )
