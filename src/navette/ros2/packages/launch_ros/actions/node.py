"""The action that starts a node's program."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from navette.ros2.packages.launch.actions import ExecuteProcess
from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.running import Command, PythonProgram
from navette.ros2.packages.launch.substitution import (
    describe_parts,
    normalize_to_list_of_substitutions,
    optional_parts,
    perform_substitutions,
)
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
    """Starts an executable of a package with a node's name, parameters and so on.

    Args:
        executable: its name, or without ``package`` its path.
        package: where it is from.
        name: the node's name; else the program's own.
        namespace: relative to the one that PushRosNamespace set.
        exec_name: how the output is labelled; else by the executable.
        parameters: dicts, parameter files, Parameter items; the last wins.
        remappings: (from, to) pairs.
        ros_arguments: more words behind ``--ros-args``.
        arguments: words for the program itself.
        kwargs: as of ExecuteProcess.
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
                    f"Node: {what} {given!r}: wanted a list, as in {what}=[…]"
                )
        super().__init__(cmd=[executable], name=exec_name, **kwargs)
        self._executable = normalize_to_list_of_substitutions(executable)
        self._package = optional_parts(package)
        self._node_name = optional_parts(name)
        self._namespace = optional_parts(namespace)
        self._parameters = list(parameters or ())
        self._remappings = list(remappings or ())
        self._ros_arguments = [
            normalize_to_list_of_substitutions(word) for word in ros_arguments or ()
        ]
        self._arguments = [
            normalize_to_list_of_substitutions(word) for word in arguments or ()
        ]
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
        """Full name, once it was started."""
        return full_node_name(
            self.expanded_node_name, self.expanded_node_namespace or "/"
        )

    def describe(self) -> str:
        words = [describe_parts(self._executable)]
        if self._package is not None:
            words.insert(0, describe_parts(self._package))
        return f"{type(self).__name__}({' '.join(words)})"

    # -- working out ---------------------------------------------------------------

    def make_command(self, context: LaunchContext) -> Command:
        program = self._find(context)
        description = self.process_description
        executable = perform_substitutions(context, self._executable)
        name = (
            perform_substitutions(context, description.name)
            if description.name is not None
            else Path(executable).stem
        )
        prefix = description.prefix_words(context)
        cwd = description.working_folder(context)
        env = description.environment(context)
        is_path = isinstance(program, Path)
        return Command(
            label=context.unique_name(name),
            argv=(str(program) if is_path else executable, *self._words(context)),
            prefix=tuple(prefix),
            cwd=cwd,
            env=env,
            shell=self.shell,
            tty=perform_bool(context, self.emulate_tty),
            program=None if isinstance(program, Path) else program,
            own_process=bool(prefix or cwd or env is not None or self.shell),
        )

    def _find(self, context: LaunchContext) -> PythonProgram | Path:
        executable = perform_substitutions(context, self._executable)
        if self._package is not None:
            return find_program(
                perform_substitutions(context, self._package), executable
            )
        path = Path(executable)
        return program_of(path) if path.is_file() else path

    def _words(self, context: LaunchContext) -> list[str]:
        """The program's own arguments, then the ROS arguments."""
        words = [perform_substitutions(context, word) for word in self._arguments]
        extra = [perform_substitutions(context, word) for word in self._ros_arguments]
        extra += self.node_words(context)
        return [*words, "--ros-args", *extra] if extra else words

    def node_words(self, context: LaunchContext) -> list[str]:
        """Name, namespace, parameters and remappings as ROS arguments."""
        name = None
        if self._node_name is not None:
            name = perform_substitutions(context, self._node_name)
            validate_node_name(name)
            self.expanded_node_name = name
        own = (
            ""
            if self._namespace is None
            else perform_substitutions(context, self._namespace)
        )
        namespace = joined_namespace(pushed_namespace(context), own)
        self.expanded_node_namespace = namespace or "/"
        parameters: Evaluated = evaluate_parameters(context, self._parameters)
        check_later(context, self, parameters)
        self.expanded_remapping_rules = evaluate_remaps(context, self._remappings)
        return ros_arguments(name, namespace, parameters, self.expanded_remapping_rules)
