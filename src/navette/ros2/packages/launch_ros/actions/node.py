"""Action that starts the program of a node."""

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any

from navette.errors import FileFormatError
from navette.ros2.packages.launch import LaunchDescriptionEntity
from navette.ros2.packages.launch.actions import ExecuteProcess
from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.logging import get_logger
from navette.ros2.packages.launch.running import LaunchCommand, PythonProgram
from navette.ros2.packages.launch.substitution import Parts, Substitution
from navette.ros2.packages.launch.typed import perform_bool
from navette.ros2.packages.launch_ros.parameter_checks import check_later
from navette.ros2.packages.launch_ros.parameter_descriptions import (
    Parameter,
    write_parameter_file,
)
from navette.ros2.packages.launch_ros.programs import find_program, program_of
from navette.ros2.packages.launch_ros.scope import (
    global_parameters,
    global_remaps,
    scoped_namespace,
)
from navette.ros2.packages.launch_ros.substitutions import ExecutableInPackage
from navette.ros2.packages.launch_ros.utilities.node_names import (
    add_node_name,
    repeated_name_warning,
)
from navette.ros2.packages.launch_ros.utilities.parameters import (
    Normalized,
    evaluate_parameters,
    normalize_parameters,
)
from navette.ros2.packages.launch_ros.utilities.remap_rules import (
    evaluate_remap_rules,
    normalize_remap_rules,
)
from navette.runtime.names import full_node_name, validate_node_name
from navette.runtime.parameter_files import (
    format_parameters,
    format_value,
    parse_value,
)

_log = get_logger("launch_ros")


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

    UNSPECIFIED_NODE_NAME = "<node_name_unspecified>"
    UNSPECIFIED_NODE_NAMESPACE = "<node_namespace_unspecified>"

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
        if isinstance(arguments, (str, dict)):
            raise InvalidLaunchValueError(
                f"Node: arguments {arguments!r}: expected a list, as in arguments=[…]"
            )
        words = list(arguments or ())
        ros_words = list(ros_arguments or ())
        first = executable
        if package is not None:
            first = ExecutableInPackage(executable=executable, package=package)
        # As in ROS 2: _perform_substitutions appends name, namespace, parameters.
        marked = ["--ros-args", *ros_words] if ros_words else []
        cmd = [first, *words, *marked, "--ros-args"]
        super().__init__(cmd=cmd, name=exec_name, **kwargs)
        self.__package = Parts.optional(package)
        self.__node_executable = Parts.of(executable)
        self.__node_name = Parts.optional(name)
        self.__node_namespace = Parts.optional(namespace)
        self.__parameters: Normalized = normalize_parameters(
            () if parameters is None else parameters
        )
        self.__remappings = list(normalize_remap_rules(remappings or ()))
        self.__ros_arguments = [Parts.of(word) for word in ros_words]
        self.__arguments = [Parts.of(word) for word in words]
        self.expanded_node_name = self.UNSPECIFIED_NODE_NAME
        self.expanded_node_namespace = self.UNSPECIFIED_NODE_NAMESPACE
        self.__expanded_parameter_arguments: list[tuple[str, bool]] = []
        self.__expanded_remappings: list[tuple[str, str]] = []
        self.__substitutions_performed = False

    @property
    def node_package(self) -> Any:
        return self.__package

    @property
    def node_executable(self) -> Any:
        return self.__node_executable

    @property
    def expanded_remapping_rules(self) -> list[tuple[str, str]]:
        """The (from, to) pairs, after the start."""
        return self.__expanded_remappings

    @property
    def node_name(self) -> str:
        """Full name of the node, after the start.

        Raises:
            RuntimeError: the action was not executed.
        """
        if not self.__substitutions_performed:
            raise RuntimeError("cannot access 'node_name' before executing action")
        return full_node_name(self.expanded_node_name, self.expanded_node_namespace)

    def is_node_name_fully_specified(self) -> bool:
        """Whether both name and namespace are given."""
        return "<" not in self.node_name

    def describe(self) -> str:
        words = [self.__node_executable.describe()]
        if self.__package is not None:
            words.insert(0, self.__package.describe())
        return f"{type(self).__name__}({' '.join(words)})"

    def make_command(self, context: LaunchContext) -> LaunchCommand:
        program = self._find(context)
        executable = self.__node_executable.perform(context)
        first = str(program) if isinstance(program, Path) else executable
        words = [first, *(word.perform(context) for word in self.cmd[1:])]
        description = self.process_description
        description.set_final(context, words, Path(executable).stem)
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
        executable = self.__node_executable.perform(context)
        if self.__package is not None:
            return find_program(self.__package.perform(context), executable)
        path = Path(executable)
        return program_of(path) if path.is_file() else path

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        if context.is_shutdown:
            return None
        self._perform_substitutions(context)
        found = super().execute(context)
        if self.is_node_name_fully_specified():
            add_node_name(context, self.node_name)
            warning = repeated_name_warning(context, self.node_name)
            if warning:
                _log.warning("%s", warning)
        return found

    def _perform_substitutions(self, context: LaunchContext) -> None:
        """Append name, namespace, parameters and remappings to the command line."""
        if self.__substitutions_performed:
            return
        self.__substitutions_performed = True
        if self.__node_name is not None:
            self.expanded_node_name = _perform(context, self.__node_name)
            validate_node_name(self.expanded_node_name)
            self._append("-r", _Rule("__node", self.expanded_node_name))
        own = self.__node_namespace
        namespace = scoped_namespace(
            context, None if own is None else _perform(context, own)
        )
        if namespace is not None:
            self.expanded_node_namespace = namespace
            self._append("-r", _Rule("__ns", namespace))
        self._append_global_parameters(context)
        self._append_parameters(context)
        self.__expanded_remappings = [
            *global_remaps(context),
            *evaluate_remap_rules(context, self.__remappings),
        ]
        for source, target in self.__expanded_remappings:
            self._append("-r", f"{source}:={target}")

    def _append(self, *words: Any) -> None:
        self.cmd.extend(Parts.of(word) for word in words)

    def _append_global_parameters(self, context: LaunchContext) -> None:
        for given in global_parameters(context):
            if isinstance(given, Path):
                self._append_file(_existing(given.absolute()))
            else:
                name, value = given
                self._append("-p", f"{name}:={_rule_of_scope(value)}")

    def _append_parameters(self, context: LaunchContext) -> None:
        files = []
        for given in evaluate_parameters(context, self.__parameters):
            if isinstance(given, Path):
                files.append(given)
                self._append_file(_existing(given))
            elif isinstance(given, Parameter):
                name, value = given.evaluate(context)
                rule = f"{name}:={format_value(value)}"
                self.__expanded_parameter_arguments.append((rule, False))
                self._append("-p", rule)
            else:
                self._append_file(self._file_of(given))
        if files:
            check_later(context, self, files)

    def _append_file(self, path: Path) -> None:
        self.__expanded_parameter_arguments.append((str(path), True))
        self._append("--params-file", str(path))

    def _file_of(self, values: dict[str, Any]) -> Path:
        """Return a file of parameters, for the node's name if it is known."""
        name = self.node_name if self.is_node_name_fully_specified() else "/**"
        return write_parameter_file(format_parameters({name: values}))


class _Rule(Substitution):
    """Rule of the node's name or namespace."""

    def __init__(self, what: str, value: str) -> None:
        self._text = f"{what}:={value}"

    def perform(self, context: LaunchContext) -> str:
        return self._text

    def describe(self) -> str:
        return f"'{self._text}'"


def _perform(context: LaunchContext, parts: Iterable[Substitution]) -> str:
    return "".join(context.perform_substitution(part) for part in parts)


def _existing(path: Path) -> Path:
    if not path.is_file():
        raise FileFormatError(path, "no such parameter file")
    return path


def _rule_of_scope(value: Any) -> str:
    """Format a value of SetParameter; text is read as YAML, as ROS 2 does."""
    if isinstance(value, str) and value.isprintable():
        try:
            parse_value(value)
        except ValueError:
            return format_value(value)
        return value
    return format_value(value)
