"""Launch as a library: coroutines, typed values, logs, output, prepared commands."""

import asyncio
import logging
import signal
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from navette.ros2.packages.launch import Action, LaunchContext, LaunchDescription
from navette.ros2.packages.launch import LaunchService as Service
from navette.ros2.packages.launch import logging as launch_logging
from navette.ros2.packages.launch.actions import (
    DeclareLaunchArgument,
    ExecuteProcess,
    GroupAction,
    IncludeLaunchDescription,
    OpaqueCoroutine,
    RegisterEventHandler,
    Shutdown,
    TimerAction,
)
from navette.ros2.packages.launch.conditions import IfCondition
from navette.ros2.packages.launch.descriptions import Executable
from navette.ros2.packages.launch.event_handlers import OnShutdown
from navette.ros2.packages.launch.frontend import Parser, expose_action
from navette.ros2.packages.launch.launch_description_sources import (
    LaunchDescriptionSource,
)
from navette.ros2.packages.launch.substitutions import PythonExpression
from navette.ros2.packages.launch.utilities import AsyncSafeSignalManager
from navette.ros2.packages.launch.utilities.type_utils import (
    get_typed_value,
    normalize_typed_substitution,
    perform_typed_substitution,
)


@pytest.fixture(autouse=True)
def reset_logging() -> Iterator[None]:
    launch_logging.reset()
    yield
    launch_logging.reset()


class _Waits(Action):
    """Waits in a coroutine, as custom actions of other packages do."""

    def execute(self, context: LaunchContext) -> None:
        assert context.asyncio_loop is not None
        self.task = context.asyncio_loop.create_task(self._wait())

    async def _wait(self) -> None:
        for _ in range(3):
            await asyncio.sleep(0)  # as ROS 2 programs do
        self.is_done = True

    def get_asyncio_future(self) -> "asyncio.Future[Any]":
        return self.task


def test_a_launch_waits_for_the_future_of_an_action() -> None:
    action = _Waits()
    service = Service()
    service.include_launch_description(LaunchDescription([action]))
    assert service.run() == 0
    assert action.is_done


def test_a_coroutine_that_raises_fails_the_launch() -> None:
    async def fail(context: LaunchContext) -> None:
        raise ValueError("no map")

    service = Service()
    service.include_launch_description(
        LaunchDescription([OpaqueCoroutine(coroutine=fail)])
    )
    assert service.run() == 1
    assert "no map" in str(service.errors[0])


def test_a_service_runs_in_a_loop_and_again() -> None:
    reasons: list[str] = []
    service = Service()
    service.include_launch_description(
        LaunchDescription(
            [
                RegisterEventHandler(
                    OnShutdown(
                        on_shutdown=lambda event, _: reasons.append(event.reason)
                    )
                )
            ]
        )
    )

    async def run() -> int:
        task = asyncio.create_task(service.run_async(shutdown_when_idle=False))
        await asyncio.sleep(0)  # as ROS 2 programs do
        ended = service.shutdown(reason="enough")
        if ended is not None:
            await ended
        return await task

    assert asyncio.run(run()) == 0
    assert service.run() == 0
    assert reasons[0] == "enough"
    assert len(reasons) == 2


def test_a_timer_that_outlives_the_shutdown_fires(launch: Any) -> None:
    reasons: list[str] = []
    launch.run(
        RegisterEventHandler(
            OnShutdown(on_shutdown=lambda event, _: reasons.append(event.reason))
        ),
        TimerAction(period=1.0, actions=[Shutdown(reason="first")]),
        TimerAction(
            period=2.0, actions=[Shutdown(reason="late")], cancel_on_shutdown=False
        ),
    )
    assert reasons == ["first", "late"]


def test_a_prepared_command_has_its_results() -> None:
    context = LaunchContext()
    context.launch_configurations.update(
        {"launch-prefix": "nice", "launch-prefix-filter": "ls"}
    )
    listing = Executable(cmd=["/bin/ls", "-l"], cwd="no/such", env={"A": "1"})
    listing.prepare(context, None)
    assert listing.final_cmd == ["nice", "/bin/ls", "-l"]
    assert (listing.final_cwd, listing.final_env) == ("no/such", {"A": "1"})
    assert str(listing.final_name).startswith("ls")
    other = Executable(cmd=["cat"])
    other.prepare(context)
    assert other.final_cmd == ["cat"]


def test_conditional_entities_are_described() -> None:
    inner = DeclareLaunchArgument("who")
    group = GroupAction([inner], condition=IfCondition("true"))
    assert group.describe_sub_entities() == []
    assert [each for _, each in group.describe_conditional_sub_entities()] == [[inner]]
    argument = LaunchDescription([group]).get_launch_arguments()[0]
    assert argument._conditionally_included


def test_an_include_inside_must_give_what_it_declares() -> None:
    part = LaunchDescriptionSource(LaunchDescription([DeclareLaunchArgument("who")]))
    outer = LaunchDescription([IncludeLaunchDescription(part)])
    service = Service()
    service.include_launch_description(
        LaunchDescription(
            [
                IncludeLaunchDescription(
                    LaunchDescriptionSource(outer),
                    launch_arguments={"who": "world"}.items(),
                )
            ]
        )
    )
    assert service.run() == 1
    assert "missing required argument 'who'" in str(service.errors[0])


def test_an_extension_inherits_the_attributes_of_its_base(tmp_path: Path) -> None:
    @expose_action("say_loudly")
    class SayLoudly(ExecuteProcess):
        @classmethod
        def parse(cls, entity: Any, parser: Any) -> Any:
            _, kwargs = super().parse(entity, parser)
            kwargs["cmd"] += [entity.get_attr("word").upper()]
            return cls, kwargs

    file = tmp_path / "a.launch.xml"
    file.write_text('<launch><say_loudly cmd="echo so" word="hey" shell="1"/></launch>')
    root, parser = Parser.load(file)
    action: Any = parser.parse_description(root).entities[0]
    assert isinstance(action, SayLoudly)
    words = [word.perform(LaunchContext()) for word in action.cmd]
    assert (words, action.shell) == (["echo", "so", "HEY"], True)


@pytest.mark.parametrize(
    ("expression", "modules", "value"),
    [
        ("sys.maxsize > 1 and os.path.join('a', 'b')", "os, sys", "a/b"),
        ("math.ceil(1.2)", ["math"], "2"),
    ],
)
def test_expressions_use_modules(expression: str, modules: Any, value: str) -> None:
    assert PythonExpression(expression, modules).perform(LaunchContext()) == value


def test_an_expression_without_modules_has_no_math() -> None:
    with pytest.raises(NameError, match="unknown name 'ceil'"):
        PythonExpression("ceil(1.2)", []).perform(LaunchContext())


def test_typed_values() -> None:
    assert get_typed_value("[on, false]", list[bool]) == [True, False]
    assert get_typed_value(["1", "x"], list[int], can_be_str=True) == [1, "x"]
    with pytest.raises(ValueError, match="not a value of one type"):
        get_typed_value("[1, 2.0]")
    context = LaunchContext()
    parts = normalize_typed_substitution([PythonExpression("1 + 1"), 3], list[int])
    assert perform_typed_substitution(context, parts, list[int]) == [2, 3]


def test_output_loggers_write_to_their_places(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    launch_logging.launch_config.log_dir = str(tmp_path)
    out, err = launch_logging.get_output_loggers(
        "talker", {"stdout": {"screen", "log"}, "stderr": "own_log"}
    )
    out.info("hello")
    err.info("oops")
    assert capsys.readouterr().out == "hello\n"
    assert (tmp_path / "launch.log").read_text().endswith(" hello\n")
    assert (tmp_path / "talker-stderr.log").read_text() == "oops\n"


def test_formats_of_the_log(capsys: pytest.CaptureFixture[str]) -> None:
    config = launch_logging.launch_config
    config.set_screen_format("{name}: {message}", screen_style="{")
    logger = launch_logging.get_logger("part")
    logger.addHandler(config.get_screen_handler())
    config.level = logging.WARNING
    logger.info("not shown")
    logger.warning("%d left", 3)
    assert capsys.readouterr().out == "part: 3 left\n"
    with pytest.raises(ValueError, match="leave it out"):
        config.set_log_format("default", log_style="%")
    with pytest.raises(ValueError, match="no such folder"):
        config.log_dir = "not/a/folder"


def test_signals_reach_an_asyncio_loop() -> None:
    async def run() -> int:
        loop = asyncio.get_running_loop()
        received: asyncio.Future[int] = loop.create_future()
        manager = AsyncSafeSignalManager(loop)
        manager.handle(signal.SIGUSR1, received.set_result)
        before = signal.getsignal(signal.SIGUSR1)
        with manager:
            signal.raise_signal(signal.SIGUSR1)
            number = await received
        assert signal.getsignal(signal.SIGUSR1) == before
        return number

    assert asyncio.run(run()) == signal.SIGUSR1
