"""Actions that hold for the nodes behind them in the same scope."""

from pathlib import Path
from typing import Any

from navette.ros2.packages.launch import Action, SomeSubstitutionsType
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.substitution import (
    describe_parts,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
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
    """Nodes are in this namespace, within the one that held so far."""

    def __init__(self, namespace: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.namespace = normalize_to_list_of_substitutions(namespace)

    def describe(self) -> str:
        return f"PushRosNamespace({describe_parts(self.namespace)})"

    def execute(self, context: LaunchContext) -> None:
        push_namespace(context, perform_substitutions(context, self.namespace))


PushROSNamespace = PushRosNamespace


class SetParameter(Action):
    """Nodes get this parameter; what they are given themselves wins."""

    def __init__(self, name: SomeSubstitutionsType, value: Any, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.name = normalize_to_list_of_substitutions(name)
        self.value = value
        self._parameter = Parameter(self.name, value)

    def describe(self) -> str:
        return f"SetParameter({describe_parts(self.name)})"

    def execute(self, context: LaunchContext) -> None:
        add_global_parameter(context, self._parameter.evaluate(context))


class SetUseSimTime(SetParameter):
    """Nodes take their time from ``/clock``, or not."""

    def __init__(self, value: Any, **kwargs: Any) -> None:
        super().__init__("use_sim_time", value, **kwargs)

    def execute(self, context: LaunchContext) -> None:
        value = perform_bool(context, self.value)
        add_global_parameter(context, ("use_sim_time", value))


class SetParametersFromFile(Action):
    """Nodes get what this parameter file has for them."""

    def __init__(self, filename: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._file = ParameterFile(filename)

    def execute(self, context: LaunchContext) -> None:
        add_global_parameter(context, Path(self._file.evaluate(context)))


class SetRemap(Action):
    """Nodes get this remapping."""

    def __init__(
        self, src: SomeSubstitutionsType, dst: SomeSubstitutionsType, **kwargs: Any
    ) -> None:
        super().__init__(**kwargs)
        self.src = normalize_to_list_of_substitutions(src)
        self.dst = normalize_to_list_of_substitutions(dst)

    def describe(self) -> str:
        return f"SetRemap({describe_parts(self.src)}, {describe_parts(self.dst)})"

    def execute(self, context: LaunchContext) -> None:
        add_global_remap(
            context,
            perform_substitutions(context, self.src),
            perform_substitutions(context, self.dst),
        )


class SetROSLogDir(Action):
    """Log files go to this folder."""

    def __init__(self, new_log_dir: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.log_dir = normalize_to_list_of_substitutions(new_log_dir)

    def execute(self, context: LaunchContext) -> None:
        context.environment["ROS_LOG_DIR"] = perform_substitutions(
            context, self.log_dir
        )
