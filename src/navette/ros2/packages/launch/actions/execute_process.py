"""Actions that run a command, once or with respawn."""

import math
import sys
from collections.abc import Iterable
from typing import Any

from navette.ros2.packages.launch.action import Action
from navette.ros2.packages.launch.descriptions import Executable
from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.event import Event
from navette.ros2.packages.launch.event_handler import CallbackHandler
from navette.ros2.packages.launch.event_handlers import OnProcessExit
from navette.ros2.packages.launch.events import Shutdown as ShutdownEvent
from navette.ros2.packages.launch.events.process import (
    ProcessStdin,
    ProcessTargetedEvent,
    SignalProcess,
)
from navette.ros2.packages.launch.frontend.grammar import split_words
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.launch_description_entity import (
    LaunchDescriptionEntity,
    normalize_to_list_of_entities,
)
from navette.ros2.packages.launch.launched_process import LaunchedProcess
from navette.ros2.packages.launch.logging import get_logger, output_places
from navette.ros2.packages.launch.output import LabelledOutput
from navette.ros2.packages.launch.running import LaunchCommand
from navette.ros2.packages.launch.substitution import (
    Parts,
    Substitution,
)
from navette.ros2.packages.launch.substitutions import LaunchConfiguration
from navette.ros2.packages.launch.typed import perform_bool, perform_seconds
from navette.supervisor import GracePeriods, RestartPolicy

_SECONDS = LaunchConfiguration("sigterm_timeout", default="5")
_LAST_SECONDS = LaunchConfiguration("sigkill_timeout", default="5")


class ExecuteLocal(Action):
    """Runs a command; ends it when the launch ends.

    Args:
        process_description: the command line.
        shell: run the command line in a shell.
        sigterm_timeout: seconds from SIGINT to SIGTERM.
        sigkill_timeout: seconds from SIGTERM to SIGKILL.
        emulate_tty: accepted without effect; Python programs do not buffer output.
        output: ``screen`` (default), ``log``, ``both``, ``own_log``, or a dict.
        cached_output: keep the output for ``get_stdout()`` and ``get_stderr()``.
        output_format: accepted where it is ROS 2's default.
        log_cmd: log the command line.
        on_exit: entities, or ``on_exit(event, context)``, for the exit.
        respawn: restart the command when it ends by itself.
        respawn_delay: seconds before a restart.
        respawn_max_retries: maximum number of restarts; -1: no limit.
        required: shut the launch down at the exit (as ``on_exit=Shutdown()`` does).
    """

    completes_later = True  # with the last exit

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
        self._output: dict[str, bytearray] = {"stdout": bytearray()}
        self._output["stderr"] = bytearray()
        self._process: LaunchedProcess | None = None

    def describe(self) -> str:
        return f"{type(self).__name__}({self.process_description.describe()})"

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        on_exit = self._on_exit
        if on_exit is None or callable(on_exit):
            return []
        return normalize_to_list_of_entities(on_exit)

    @property
    def process_details(self) -> dict[str, Any] | None:
        """Name, command line and pid; None before the start."""
        if self._process is None or self._process.command is None:
            return None
        return self._process.details

    @property
    def name(self) -> Any:
        """Label (``talker-1``); before the start the given name, or None."""
        if self._process is None:
            return self.process_description.final_name or self.process_description.name
        return self._process.label or None

    @property
    def return_code(self) -> int | None:
        """Exit code; None before the exit."""
        return None if self._process is None else self._process.exit_code

    def keep_output(self, stream: str, data: bytes) -> None:
        """Store output for :meth:`get_stdout`, with ``cached_output``."""
        if self.cached_output:
            self._output[stream] += data

    def get_stdout(self) -> str:
        """Return the standard output so far, of an action with ``cached_output``."""
        return self._cached("stdout")

    def get_stderr(self) -> str:
        """Return the standard error so far, of an action with ``cached_output``."""
        return self._cached("stderr")

    def _cached(self, stream: str) -> str:
        if not self.cached_output:
            raise InvalidLaunchValueError(
                f"{self.describe()}: its output is kept with cached_output=True only"
            )
        return bytes(self._output[stream]).decode(errors="replace")

    def write(self, data: bytes) -> None:
        """Write to the standard input while the process runs."""
        if self._process is not None:
            self._process.write(data)

    def prepare(self, context: LaunchContext) -> None:
        """Perform the substitutions of the command; the start does so, too."""
        self.process_description.prepare(context, self)

    def make_command(self, context: LaunchContext) -> LaunchCommand:
        """Return the command with all substitutions performed."""
        self.prepare(context)
        return self.process_description.command(
            shell=self.shell, tty=perform_bool(context, self.emulate_tty)
        )

    def make_output(self, context: LaunchContext, label: str) -> LabelledOutput:
        """Return where the output of the process goes."""
        output = self.output
        if isinstance(output, (str, Substitution, list, tuple)):
            parts = Parts.of(output)
            output = parts.perform(context)
        return LabelledOutput(label, output_places(output))

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        if context.is_shutdown:
            return None
        if self._process is not None:
            raise InvalidLaunchValueError(
                f"{self.name} was started already: an action can be executed once"
            )
        grace = GracePeriods(
            perform_seconds(context, self.sigterm_timeout, "sigterm_timeout"),
            perform_seconds(context, self.sigkill_timeout, "sigkill_timeout"),
        )
        self._process = LaunchedProcess(self, context, self._policy(context), grace)
        self._register_handlers(context)
        self._process.start()
        return None

    def _policy(self, context: LaunchContext) -> RestartPolicy:
        retries, delay_s = self.respawn_max_retries, self.respawn_delay or 0.0
        return RestartPolicy(
            condition="always" if perform_bool(context, self.respawn) else "no",
            delay_s=delay_s,
            max_delay_s=delay_s,
            max_attempts=sys.maxsize if retries < 0 else retries,
            window_s=math.inf,
        )

    def _register_handlers(self, context: LaunchContext) -> None:
        handlers = [CallbackHandler(matcher=self._is_target, callback=self._obey)]
        if self.required:
            handlers.append(
                OnProcessExit(target_action=self, on_exit=self._shut_down_launch)
            )
        if self._on_exit is not None:
            handlers.append(OnProcessExit(target_action=self, on_exit=self._on_exit))
        for handler in handlers:
            context.register_event_handler(handler)

    def _shut_down_launch(self, event: Any, context: LaunchContext) -> None:
        if not context.is_shutdown:
            get_logger("launch").info(
                "process[%s] was required: shutting down launched system", self.name
            )
            context.emit_event_sync(ShutdownEvent(reason=f"{self.name} ended"))

    def _is_target(self, event: Event) -> bool:
        if isinstance(event, ProcessTargetedEvent):
            return bool(event.process_matcher(self))
        return isinstance(event, ShutdownEvent)

    def _obey(self, event: Event, context: LaunchContext) -> None:
        process = self._process
        assert process is not None, "registered by execute"
        if isinstance(event, SignalProcess):
            process.signal(int(event.signal))
        elif isinstance(event, ProcessStdin):
            process.write(event.text)
        else:
            process.stop()


class ExecuteProcess(ExecuteLocal):
    """Runs a command line given as a list of words.

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

    @staticmethod
    def _parse_cmdline(cmd: str, parser: Any) -> list[Any]:
        """Return the words of a command line, for extensions that parse tags."""
        return [parser.parse_substitution(word) for word in split_words(cmd)]

    @property
    def cmd(self) -> list[Any]:
        return self.process_description.cmd

    @property
    def cwd(self) -> Any:
        return self.process_description.cwd

    @property
    def env(self) -> Any:
        return self.process_description.env

    @property
    def additional_env(self) -> Any:
        return self.process_description.additional_env
