"""Actions that affect the following nodes of the scope."""

from pathlib import Path
from typing import Any

from navette.ros2.packages.launch import (
    Action,
    SomeSubstitutionsType,
    Substitution,
)
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.substitution import Parts
from navette.ros2.packages.launch.typed import perform_bool
from navette.ros2.packages.launch_ros.ros_adapters import get_ros_adapter
from navette.ros2.packages.launch_ros.scope import (
    add_global_parameter,
    add_global_remap,
    push_namespace,
)
from navette.ros2.packages.launch_ros.utilities.parameters import (
    evaluate_parameter_dict,
    normalize_parameter_dict,
)
from navette.runtime.log_sinks import get_logging_directory


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
        self._parameter = normalize_parameter_dict({tuple(Parts.of(name)): value})

    @property
    def name(self) -> tuple[Substitution, ...]:
        return next(iter(self._parameter))

    @property
    def value(self) -> Any:
        return self._parameter[self.name]

    def execute(self, context: LaunchContext) -> None:
        for item in evaluate_parameter_dict(context, self._parameter).items():
            add_global_parameter(context, item)


class SetUseSimTime(Action):
    """Sets ``use_sim_time`` of the launch's own node, which ROSTimer uses.

    ``SetParameter("use_sim_time", True)`` sets that of the nodes.
    """

    def __init__(self, value: Any, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.value = value

    def execute(self, context: LaunchContext) -> None:
        value = perform_bool(context, self.value)
        get_ros_adapter(context).set_use_sim_time(value)


class SetParametersFromFile(Action):
    """Adds a parameter file to the nodes."""

    def __init__(self, filename: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._file = Parts.of(filename)

    def execute(self, context: LaunchContext) -> None:
        add_global_parameter(context, self._file.perform(context))


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
    """Sets the folder of log files; a relative one is below the present folder."""

    def __init__(self, new_log_dir: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.log_dir = Parts.of(new_log_dir)

    def execute(self, context: LaunchContext) -> None:
        variables = context.environment
        present = variables.get("ROS_LOG_DIR") or get_logging_directory()
        variables["ROS_LOG_DIR"] = str(Path(present) / self.log_dir.perform(context))
