import signal
from typing import Any

import pytest

from navette.ros2.packages.launch.actions import (
    EmitEvent,
    ExecuteProcess,
    LogInfo,
    RegisterEventHandler,
    SetLaunchConfiguration,
    Shutdown,
    TimerAction,
)
from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.event_handlers import (
    OnExecutionComplete,
    OnProcessExit,
    OnProcessIO,
    OnProcessStart,
)
from navette.ros2.packages.launch.events import matches_action
from navette.ros2.packages.launch.events.process import (
    ProcessStdin,
    ShutdownProcess,
    SignalProcess,
    matches_name,
)
from navette.ros2.packages.launch.substitutions import (
    LaunchConfiguration,
    LocalSubstitution,
)


def user_lines(caplog: pytest.LogCaptureFixture) -> list[str]:
    return [
        r.getMessage() for r in caplog.records if r.name == "navette.launch.launch.user"
    ]


def test_a_command_line_with_substitutions(launch: Any, tmp_path: Any) -> None:
    launch.runner.behaviour = lambda p: p.listener.exited(0)
    launch.run(
        SetLaunchConfiguration("n", "3"),
        ExecuteProcess(
            cmd=["bin/tool", "--n", LaunchConfiguration("n"), ["a", "b"]],
            prefix="nice -n 5",
            cwd=str(tmp_path),
            additional_env={"A": LaunchConfiguration("n")},
        ),
        ExecuteProcess(cmd=["other"], name="named", env={"B": "1"}),
    )
    first, second = launch.runner.started
    assert first.command.words == ["nice", "-n", "5", "bin/tool", "--n", "3", "ab"]
    assert first.command.label == "tool-1"
    assert first.command.cwd == str(tmp_path)
    assert first.command.env["A"] == "3"
    assert "PATH" in first.command.env
    assert second.command.label == "named-2"
    assert second.command.env == {"B": "1"}
    assert launch.runner.closed


def test_output_is_labelled_line_by_line(launch: Any, capsys: Any) -> None:
    def talk(process: Any) -> None:
        process.listener.output("stdout", b"one\ntw")
        process.listener.output("stderr", b"bad\r\n")
        process.listener.output("stdout", "o\nthr\xe9e".encode("latin-1"))
        process.listener.exited(0)

    launch.runner.behaviour = talk
    launch.run(ExecuteProcess(cmd=["t"]))
    out, err = capsys.readouterr()
    assert out == "[t-1] one\n[t-1] two\n[t-1] thr\N{REPLACEMENT CHARACTER}e\n"
    assert err == "[t-1] bad\n"


def test_output_can_go_to_a_file(
    launch: Any, capsys: Any, tmp_path: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    def talk(process: Any) -> None:
        process.listener.output("stdout", b"quiet\n")
        process.listener.output("stderr", b"loud\n")
        process.listener.exited(0)

    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "logs"))
    launch.runner.behaviour = talk
    launch.run(ExecuteProcess(cmd=["t"], output="log"))
    assert capsys.readouterr() == ("", "[t-1] loud\n")
    assert (tmp_path / "logs" / "t-1.log").read_text() == "quiet\nloud\n"
    launch.service.errors.clear()


def test_an_unknown_output_destination(launch: Any) -> None:
    launch.run(ExecuteProcess(cmd=["t"], output="sreen"))
    assert "output 'sreen'; expected screen, log" in launch.errors


def test_handlers_receive_start_output_and_exit(launch: Any, caplog: Any) -> None:
    def live(process: Any) -> None:
        process.listener.output("stdout", b"ready\n")
        launch.runner.exit_after(process, 1.0, 0)

    launch.runner.behaviour = live
    watched, other = ExecuteProcess(cmd=["watched"]), ExecuteProcess(cmd=["other"])

    def report(event: Any) -> Any:
        return LogInfo(msg=["received ", event.text.decode().strip()])

    launch.run(
        RegisterEventHandler(
            OnProcessStart(
                target_action=watched,
                on_start=[LogInfo(msg=["pid ", LocalSubstitution("event.pid")])],
            )
        ),
        RegisterEventHandler(OnProcessIO(target_action=watched, on_stdout=report)),
        RegisterEventHandler(
            OnProcessExit(
                target_action=lambda action: action is watched,
                on_exit=lambda event, context: LogInfo(msg=f"code {event.returncode}"),
            )
        ),
        RegisterEventHandler(
            OnExecutionComplete(target_action=watched, on_completion=[])
        ),
        watched,
        other,
    )
    assert user_lines(caplog) == ["pid 100", "received ready", "code 0"]
    with pytest.raises(InvalidLaunchValueError, match="expected an action"):
        OnProcessExit(target_action="talker", on_exit=[])


@pytest.mark.parametrize("how", ["on_exit", "required"])
def test_the_exit_of_a_required_process_ends_the_launch(launch: Any, how: str) -> None:
    def live(process: Any) -> None:
        if process.command.label == "needed-2":
            launch.runner.exit_after(process, 2.0, 1)

    launch.runner.behaviour = live
    options: dict[str, Any] = (
        {"on_exit": Shutdown()} if how == "on_exit" else {"required": True}
    )
    code = launch.run(
        ExecuteProcess(cmd=["rest"]), ExecuteProcess(cmd=["needed"], **options)
    )
    assert code == 0
    assert launch.service.context.failed_labels == ["needed-2"]
    assert launch.runner.started[0].signals == [(2.0, signal.SIGINT)]


def test_signals_escalate(launch: Any) -> None:
    def live(process: Any) -> None:
        process.stubborn = True

    launch.runner.behaviour = live
    launch.run(
        ExecuteProcess(cmd=["rock"], sigterm_timeout="3", sigkill_timeout=4.0),
        TimerAction(period=1.0, actions=[Shutdown()]),
    )
    assert launch.runner.started[0].signals == [
        (1.0, signal.SIGINT),
        (4.0, signal.SIGTERM),
        (8.0, signal.SIGKILL),
    ]


def test_a_second_interrupt_escalates(launch: Any) -> None:
    def live(process: Any) -> None:
        process.stubborn = True
        launch.runner.loop.call_at(2_000_000_000, launch.service.escalate)

    launch.runner.behaviour = live
    launch.run(
        ExecuteProcess(cmd=["rock"]), TimerAction(period=1.0, actions=[Shutdown()])
    )
    assert launch.runner.started[0].signals[:2] == [
        (1.0, signal.SIGINT),
        (2.0, signal.SIGTERM),
    ]


def test_respawn_has_a_delay_and_a_limit(launch: Any) -> None:
    launch.runner.behaviour = lambda p: launch.runner.exit_after(p, 1.0, 1)
    code = launch.run(
        ExecuteProcess(
            cmd=["flaky"], respawn=True, respawn_delay=0.5, respawn_max_retries=2
        )
    )
    assert [p.at_s for p in launch.runner.started] == [0.0, 1.5, 3.0]
    assert launch.labels == ["flaky-1", "flaky-2", "flaky-3"]
    assert code == 0
    assert launch.service.context.failed_labels == launch.labels


def test_a_shutdown_cancels_respawns(launch: Any) -> None:
    def live(process: Any) -> None:
        if process.command.label.startswith("flaky"):
            launch.runner.exit_after(process, 1.0, 0)

    launch.runner.behaviour = live
    launch.run(
        ExecuteProcess(cmd=["flaky"], respawn="true", respawn_delay=10.0),
        TimerAction(period=2.0, actions=[Shutdown()]),
    )
    assert launch.labels == ["flaky-1"]
    assert launch.context.loop.clock.now_ns == 2_000_000_000


def test_events_for_processes(launch: Any) -> None:
    first, second = ExecuteProcess(cmd=["a"]), ExecuteProcess(cmd=["b"])
    launch.run(
        first,
        second,
        EmitEvent(
            event=ProcessStdin(text=b"hi", process_matcher=matches_action(first))
        ),
        TimerAction(
            period=1.0,
            actions=[
                EmitEvent(
                    event=ShutdownProcess(process_matcher=matches_name("a-1")),
                ),
                EmitEvent(
                    event=SignalProcess(
                        signal_number="SIGTERM", process_matcher=matches_name("b-2")
                    )
                ),
            ],
        ),
    )
    a, b = launch.runner.started
    assert a.written == b"hi"
    assert a.signals == [(1.0, signal.SIGINT)]
    assert b.signals == [(1.0, signal.SIGTERM)]
    with pytest.raises(InvalidLaunchValueError, match=r"'SIGHELP'; known: .*SIGINT"):
        SignalProcess(signal_number="SIGHELP", process_matcher=matches_name("b"))


def test_a_failed_launch_ends_what_it_started(launch: Any) -> None:
    code = launch.run(
        ExecuteProcess(cmd=["a"]), LogInfo(msg=LaunchConfiguration("missing"))
    )
    assert code == 1
    assert launch.runner.started[0].signals == [(0.0, signal.SIGINT)]
    assert "LogInfo(LaunchConfiguration('missing'))" in launch.errors


def test_invalid_command_lines_are_refused() -> None:
    with pytest.raises(InvalidLaunchValueError, match="expected a list of words"):
        ExecuteProcess(cmd="ls -l")
    with pytest.raises(InvalidLaunchValueError, match="empty"):
        ExecuteProcess(cmd=[])


def test_the_completion_of_actions(
    launch: Any, caplog: pytest.LogCaptureFixture
) -> None:
    """A process is complete at its exit, a timer when it fires, others at once."""
    launch.runner.behaviour = lambda p: p.listener.exited(0)
    program = ExecuteProcess(cmd=["program"])
    timer = TimerAction(period=1.0, actions=[LogInfo(msg="inside")])
    note = LogInfo(msg="note")
    handlers = [
        RegisterEventHandler(
            OnExecutionComplete(
                target_action=action, on_completion=[LogInfo(msg=f"{name} complete")]
            )
        )
        for name, action in (("program", program), ("timer", timer), ("note", note))
    ]
    exited = OnProcessExit(target_action=program, on_exit=[LogInfo(msg="exit")])
    launch.run(*handlers, RegisterEventHandler(exited), timer, note, program)
    lines = user_lines(caplog)
    assert sorted(lines) == sorted(
        [
            *("note", "note complete", "exit"),
            *("program complete", "inside", "timer complete"),
        ]
    )
    assert lines.index("exit") < lines.index("program complete")
    assert lines.index("program complete") < lines.index("timer complete")
