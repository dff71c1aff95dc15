"""Actions that run a command: once, or again whenever it has ended."""

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from navette.ros2.packages.launch.action import Action
from navette.ros2.packages.launch.descriptions import Executable
from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.event import Event
from navette.ros2.packages.launch.event_handler import AnsweringHandler
from navette.ros2.packages.launch.event_handlers import OnProcessExit
from navette.ros2.packages.launch.events import Shutdown as ShutdownEvent
from navette.ros2.packages.launch.events.process import (
    ProcessStdin,
    ProcessTargetedEvent,
    SignalProcess,
)
from navette.ros2.packages.launch.execution import Execution
from navette.ros2.packages.launch.launch_description_entity import (
    LaunchDescriptionEntity,
)
from navette.ros2.packages.launch.logging import get_logger
from navette.ros2.packages.launch.output import LabelledOutput, output_places
from navette.ros2.packages.launch.running import Command
from navette.ros2.packages.launch.substitution import (
    Substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from navette.ros2.packages.launch.substitutions import LaunchConfiguration
from navette.ros2.packages.launch.typed import perform_bool, perform_seconds
from navette.supervisor import Patience

if TYPE_CHECKING:
    from navette.ros2.packages.launch.launch_context import LaunchContext

_SECONDS = LaunchConfiguration("sigterm_timeout", default="5")
_LAST_SECONDS = LaunchConfiguration("sigkill_timeout", default="5")


class ExecuteLocal(Action):
    """Runs a command; ends it when the launch ends.

    Args:
        process_description: the command line.
        shell: a shell reads it.
        sigterm_timeout: seconds from SIGINT to SIGTERM when it is to end.
        sigkill_timeout: seconds from there to SIGKILL.
        emulate_tty: accepted; Python programs are told not to buffer their output.
        output: ``screen`` (default), ``log``, ``both``, ``own_log``, or a dict.
        output_format: accepted where it is ROS 2's default.
        log_cmd: print the command line before it starts.
        on_exit: entities, or ``on_exit(event, context)``, for when it has ended.
        respawn: run it again when it has ended by itself.
        respawn_delay: seconds before that.
        respawn_max_retries: at most so many times; -1: without limit.
        required: the launch ends with it (as ``on_exit=Shutdown()`` does).
    """

    def __init__(
        self,
        *,
        process_description: Executable,
        shell: bool = False,
        sigterm_timeout: Any = _SECONDS,
        sigkill_timeout: Any = _LAST_SECONDS,
        emulate_tty: Any = False,
        output: Any = "screen",
        output_format: str | None = None,
        cached_output: bool = False,
        log_cmd: bool = False,
        on_exit: Any = None,
        respawn: Any = False,
        respawn_delay: float | None = None,
        respawn_max_retries: int = -1,
        required: bool = False,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.process_description = process_description
        self.shell = shell
        self.sigterm_timeout = sigterm_timeout
        self.sigkill_timeout = sigkill_timeout
        self.emulate_tty = emulate_tty
        self.output = output
        self.output_format = output_format
        self.cached_output = cached_output
        self.log_cmd = log_cmd
        self.respawn = respawn
        self.respawn_delay = respawn_delay
        self.respawn_max_retries = respawn_max_retries
        self.required = required
        self._on_exit = on_exit
        self._handlers: list[AnsweringHandler] = []
        self._retries = 0
        self._respawns = False
        self._execution: Execution | None = None

    def describe(self) -> str:
        return f"{type(self).__name__}({self.process_description.describe()})"

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        on_exit = self._on_exit
        if on_exit is None or callable(on_exit):
            return []
        return OnProcessExit(on_exit=on_exit).entities

    # -- what others ask -----------------------------------------------------------

    @property
    def process_details(self) -> dict[str, Any] | None:
        """Name, command line and pid, once it was started."""
        return None if self._execution is None else self._execution.details

    @property
    def name(self) -> str | None:
        """Its label (``talker-1``), once it was started."""
        return None if self._execution is None else self._execution.command.label

    @property
    def return_code(self) -> int | None:
        """How it ended; None before."""
        return None if self._execution is None else self._execution.return_code

    def write(self, data: bytes) -> None:
        """Write to its standard input, while it runs."""
        if self._execution is not None:
            self._execution.write(data)

    # -- running -------------------------------------------------------------------

    def make_command(self, context: "LaunchContext") -> Command:
        """The command with everything worked out."""
        return self.process_description.command(
            context, shell=self.shell, tty=perform_bool(context, self.emulate_tty)
        )

    def execute(self, context: "LaunchContext") -> list[LaunchDescriptionEntity] | None:
        if context.is_shutdown:
            return None
        if self._execution is not None:
            raise InvalidLaunchValueError(
                f"{self.name} was started already: an action can be executed once"
            )
        self._register(context)
        self._start(context)
        return None

    def _start(self, context: "LaunchContext") -> None:
        command = self.make_command(context)
        if self.log_cmd:
            get_logger(command.label).info("%s", " ".join(command.words))
        self._execution = Execution(
            self,
            context,
            command,
            LabelledOutput(command.label, output_places(self._output(context))),
            Patience(
                perform_seconds(context, self.sigterm_timeout, "sigterm_timeout"),
                perform_seconds(context, self.sigkill_timeout, "sigkill_timeout"),
            ),
            lambda execution: self._ended(execution, context),
        )
        self._respawns = perform_bool(context, self.respawn)
        self._execution.start()

    def _output(self, context: "LaunchContext") -> Any:
        output = self.output
        if isinstance(output, dict):
            return output
        if not isinstance(output, (str, Substitution, list, tuple)):
            return output
        return perform_substitutions(
            context, normalize_to_list_of_substitutions(output)
        )

    def _register(self, context: "LaunchContext") -> None:
        self._handlers = [
            AnsweringHandler(matcher=self._concerns, answer=self._obey),
        ]
        if self.required:
            self._handlers.append(
                OnProcessExit(target_action=self, on_exit=self._end_launch)
            )
        if self._on_exit is not None:
            self._handlers.append(
                OnProcessExit(target_action=self, on_exit=self._on_exit)
            )
        for handler in self._handlers:
            context.register_event_handler(handler)

    def _end_launch(self, event: Any, context: "LaunchContext") -> None:
        if not context.is_shutdown:
            get_logger("launch").info(
                "process[%s] was required: shutting down launched system", self.name
            )
            context.emit_event(ShutdownEvent(reason=f"{self.name} ended"))

    def _concerns(self, event: Event) -> bool:
        if isinstance(event, ProcessTargetedEvent):
            return bool(event.process_matcher(self))
        return isinstance(event, ShutdownEvent)

    def _obey(self, event: Event, context: "LaunchContext") -> None:
        execution = self._execution
        if execution is None:
            return
        if isinstance(event, SignalProcess):
            execution.signal(int(event.signal))
        elif isinstance(event, ProcessStdin):
            execution.write(event.text)
        elif not execution.was_asked_to_end:
            execution.end()

    def _ended(self, execution: Execution, context: "LaunchContext") -> None:
        left = self.respawn_max_retries < 0 or self._retries < self.respawn_max_retries
        asked = execution.was_asked_to_end or context.is_shutdown
        if not (self._respawns and left) or asked:
            return
        self._retries += 1
        delay_s = self.respawn_delay or 0.0
        pause = object()
        context.busy.add(pause)

        def again() -> None:
            context.busy.discard(pause)
            if not context.is_shutdown:
                self._start(context)

        call = context.call_after(delay_s, again, f"respawn of {self.name}")

        def give_up(event: Event, context: "LaunchContext") -> None:
            call.cancel()
            context.busy.discard(pause)

        context.register_event_handler(
            AnsweringHandler(
                matcher=lambda event: isinstance(event, ShutdownEvent),
                answer=give_up,
                handle_once=True,
            )
        )


class ExecuteProcess(ExecuteLocal):
    """Runs a command line, given by its words.

    Args:
        cmd: the words; each may be a list of substitutions.
        prefix, name, cwd, env, additional_env: see :class:`Executable`.
    """

    def __init__(
        self,
        *,
        cmd: Iterable[Any],
        prefix: Any = None,
        name: Any = None,
        cwd: Any = None,
        env: Any = None,
        additional_env: Any = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(
            process_description=Executable(
                cmd=cmd,
                prefix=prefix,
                name=name,
                cwd=cwd,
                env=env,
                additional_env=additional_env,
            ),
            **kwargs,
        )

    @property
    def cmd(self) -> list[Any]:
        return self.process_description.cmd

    @property
    def cwd(self) -> Any:
        return self.process_description.cwd
