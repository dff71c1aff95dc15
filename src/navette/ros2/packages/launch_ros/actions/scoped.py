"""Actions that affect the following nodes of the scope."""

from pathlib import Path
from typing import Any

from navette.ros2.packages.launch import Action, SomeSubstitutionsType
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.substitution import Parts
from navette.ros2.packages.launch.typed import perform_bool
from navette.ros2.packages.launch_ros.parameter_descriptions import (
    Parameter,
    ParameterFile,
)
from navette.ros2.packages.launch_ros.scope import (
    add_global_parameter,
    add_global_remap,
    push_namespace,
)


class PushRosNamespace(Action):
    """Adds a namespace to the nodes of the scope."""

    def __init__(self, namespace: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.namespace = Parts.of(namespace)

    def execute(self, context: LaunchContext) -> None:
        push_namespace(context, self.namespace.perform(context))


PushROSNamespace = PushRosNamespace


class SetParameter(Action):
    """Sets a parameter of the nodes; their own values override it."""

    def __init__(self, name: SomeSubstitutionsType, value: Any, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.name = Parts.of(name)
        self.value = value
        self._parameter = Parameter(self.name, value)

    def execute(self, context: LaunchContext) -> None:
        add_global_parameter(context, self._parameter.evaluate(context))


class SetUseSimTime(SetParameter):
    """Sets ``use_sim_time`` of the nodes."""

    def __init__(self, value: Any, **kwargs: Any) -> None:
        super().__init__("use_sim_time", value, **kwargs)

    def execute(self, context: LaunchContext) -> None:
        value = perform_bool(context, self.value)
        add_global_parameter(context, ("use_sim_time", value))


class SetParametersFromFile(Action):
    """Adds a parameter file to the nodes."""

    def __init__(self, filename: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._file = ParameterFile(filename)

    def execute(self, context: LaunchContext) -> None:
        add_global_parameter(context, Path(self._file.evaluate(context)))


class SetRemap(Action):
    """Adds a remapping to the nodes."""

    def __init__(
        self, src: SomeSubstitutionsType, dst: SomeSubstitutionsType, **kwargs: Any
    ) -> None:
        super().__init__(**kwargs)
        self.src = Parts.of(src)
        self.dst = Parts.of(dst)

    def describe(self) -> str:
        return f"SetRemap({self.src.describe()}, {self.dst.describe()})"

    def execute(self, context: LaunchContext) -> None:
        add_global_remap(
            context,
            self.src.perform(context),
            self.dst.perform(context),
        )


class SetROSLogDir(Action):
    """Sets the folder of log files."""

    def __init__(self, new_log_dir: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.log_dir = Parts.of(new_log_dir)

    def execute(self, context: LaunchContext) -> None:
        context.environment["ROS_LOG_DIR"] = self.log_dir.perform(context)
