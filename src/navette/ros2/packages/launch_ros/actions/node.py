"""Action that starts the program of a node."""

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any

from navette.ros2.packages.launch.actions import ExecuteProcess
from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.running import LaunchCommand, PythonProgram
from navette.ros2.packages.launch.substitution import Parts
from navette.ros2.packages.launch.typed import perform_bool
from navette.ros2.packages.launch_ros.node_arguments import (
    Evaluated,
    evaluate_parameters,
    evaluate_remaps,
    ros_arguments,
)
from navette.ros2.packages.launch_ros.parameter_checks import check_later
from navette.ros2.packages.launch_ros.programs import find_program, program_of
from navette.ros2.packages.launch_ros.scope import joined_namespace, pushed_namespace
from navette.runtime.names import full_node_name, validate_node_name


class Node(ExecuteProcess):
    """Starts an executable with the name, namespace, parameters … of a node.

    Args:
        executable: its name, or its path if ``package`` is None.
        package: package of the executable.
        name: name of the node (default: the program's own).
        namespace: relative to that of PushRosNamespace.
        exec_name: label of the output (default: the executable).
        parameters: dicts, parameter files, Parameter items; later ones override.
        remappings: (from, to) pairs.
        ros_arguments: further words after ``--ros-args``.
        arguments: command line arguments of the program.
        kwargs: as for ExecuteProcess.
    """

    def __init__(
        self,
        *,
        executable: Any,
        package: Any = None,
        name: Any = None,
        namespace: Any = None,
        exec_name: Any = None,
        parameters: Iterable[Any] | None = None,
        remappings: Iterable[Any] | None = None,
        ros_arguments: Iterable[Any] | None = None,
        arguments: Iterable[Any] | None = None,
        **kwargs: Any,
    ) -> None:
        for what, given in (("parameters", parameters), ("arguments", arguments)):
            if isinstance(given, (str, dict)):
                raise InvalidLaunchValueError(
                    f"Node: {what} {given!r}: expected a list, as in {what}=[…]"
                )
        super().__init__(cmd=[executable], name=exec_name, **kwargs)
        self._executable = Parts.of(executable)
        self._package = Parts.optional(package)
        self._node_name = Parts.optional(name)
        self._namespace = Parts.optional(namespace)
        self._parameters = list(parameters or ())
        self._remappings = list(remappings or ())
        self._ros_arguments = [Parts.of(word) for word in ros_arguments or ()]
        self._arguments = [Parts.of(word) for word in arguments or ()]
        self.expanded_node_name = "<node_name_unspecified>"
        self.expanded_node_namespace = ""
        self.expanded_remapping_rules: list[tuple[str, str]] = []

    @property
    def node_package(self) -> Any:
        return self._package

    @property
    def node_executable(self) -> Any:
        return self._executable

    @property
    def node_name(self) -> str:
        """Full name of the node, after the start."""
        return full_node_name(
            self.expanded_node_name, self.expanded_node_namespace or "/"
        )

    def describe(self) -> str:
        words = [self._executable.describe()]
        if self._package is not None:
            words.insert(0, self._package.describe())
        return f"{type(self).__name__}({' '.join(words)})"

    def make_command(self, context: LaunchContext) -> LaunchCommand:
        program = self._find(context)
        executable = self._executable.perform(context)
        first = str(program) if isinstance(program, Path) else executable
        description = self.process_description
        description.set_final(
            context, [first, *self._words(context)], Path(executable).stem
        )
        command = description.command(
            shell=self.shell, tty=perform_bool(context, self.emulate_tty)
        )
        if isinstance(program, Path):
            return command
        needs_process = command.prefix or command.cwd or command.env is not None
        return replace(
            command, program=program, own_process=bool(needs_process or self.shell)
        )

    def _find(self, context: LaunchContext) -> PythonProgram | Path:
        executable = self._executable.perform(context)
        if self._package is not None:
            return find_program(self._package.perform(context), executable)
        path = Path(executable)
        return program_of(path) if path.is_file() else path

    def _words(self, context: LaunchContext) -> list[str]:
        """Return the program's arguments, then the ROS arguments."""
        words = [word.perform(context) for word in self._arguments]
        extra = [word.perform(context) for word in self._ros_arguments]
        extra += self.node_words(context)
        return [*words, "--ros-args", *extra] if extra else words

    def node_words(self, context: LaunchContext) -> list[str]:
        """Return name, namespace, parameters and remappings as ROS arguments."""
        name = None
        if self._node_name is not None:
            name = self._node_name.perform(context)
            validate_node_name(name)
            self.expanded_node_name = name
        own = "" if self._namespace is None else self._namespace.perform(context)
        namespace = joined_namespace(pushed_namespace(context), own)
        self.expanded_node_namespace = namespace or "/"
        parameters: Evaluated = evaluate_parameters(context, self._parameters)
        check_later(context, self, parameters)
        self.expanded_remapping_rules = evaluate_remaps(context, self._remappings)
        return ros_arguments(name, namespace, parameters, self.expanded_remapping_rules)
