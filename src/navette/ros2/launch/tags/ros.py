"""Tags of ``launch_ros``."""

from typing import Any

from navette.ros2.launch.tags.core import (
    execution_options,
    makes_simple_action,
    parse_words,
)
from navette.ros2.packages.launch.action import reads_arguments
from navette.ros2.packages.launch.conditions import condition_of
from navette.ros2.packages.launch.frontend import (
    SUBSTITUTIONS,
    Element,
    makes,
    parse_elements,
)
from navette.ros2.packages.launch.launch_description_entity import (
    LaunchDescriptionEntity,
)
from navette.ros2.packages.launch_ros.actions import (
    ComposableNodeContainer,
    LifecycleNode,
    LoadComposableNodes,
    Node,
    PushRosNamespace,
    RosTimer,
    SetParameter,
    SetParametersFromFile,
    SetRemap,
    SetROSLogDir,
    SetUseSimTime,
)
from navette.ros2.packages.launch_ros.descriptions import (
    ComposableNode,
    ParameterFile,
    ParameterValue,
)
from navette.ros2.packages.launch_ros.substitutions import (
    ExecutableInPackage,
    FindPackagePrefix,
    FindPackageShare,
    Parameter,
)

SUBSTITUTIONS.update(
    {
        "exec-in-pkg": (2, 2, lambda a: ExecutableInPackage(a[0], a[1])),
        "find-pkg-prefix": (1, 1, lambda a: FindPackagePrefix(a[0])),
        "find-pkg-share": (1, 1, lambda a: FindPackageShare(a[0])),
        "param": (
            1,
            2,
            lambda a: Parameter(a[0], default=a[1] if len(a) > 1 else None),
        ),
    }
)
_TYPES: dict[str, Any] = {
    "bool": bool,
    "int": int,
    "float": float,
    "str": str,
    "list_of_bool": list[bool],
    "list_of_int": list[int],
    "list_of_float": list[float],
    "list_of_str": list[str],
}


makes_simple_action("push_ros_namespace", PushRosNamespace, "namespace")
makes_simple_action("push-ros-namespace", PushRosNamespace, "namespace")
makes_simple_action("set_use_sim_time", SetUseSimTime, "value")
makes_simple_action("set_parameters_from_file", SetParametersFromFile, "filename")
makes_simple_action("set_remap", SetRemap, "from", "to")
makes_simple_action("set_ros_log_dir", SetROSLogDir, "new_log_dir")


@makes("node")
def node(element: Element) -> LaunchDescriptionEntity:
    return Node(**node_arguments(element))


@reads_arguments(Node)
def node_arguments(element: Element) -> dict[str, Any]:
    if "type" in element.attributes and "exec" not in element.attributes:
        raise element.error(
            "attribute 'type' belongs to launch files of ROS 1; write "
            f"exec={element.attributes['type']!r} (name= is optional)"
        )
    return {
        "package": element.parts("pkg"),
        "name": element.parts("name"),
        "namespace": _namespace(element),
        "executable": element.need_parts("exec"),
        **_node_options(element),
    }


@makes("lifecycle_node")
def lifecycle_node(element: Element) -> LaunchDescriptionEntity:
    return LifecycleNode(
        package=element.parts("pkg"),
        executable=element.need_parts("exec"),
        name=element.need_parts("name"),
        namespace=_namespace(element) or "",
        autostart=element.parts("autostart") or False,
        **_node_options(element),
    )


@makes("ros_timer")
def ros_timer(element: Element) -> LaunchDescriptionEntity:
    return RosTimer(
        period=element.need_parts("period"),
        actions=parse_elements(element.rest()),
        **condition_of(element),
    )


@makes("node_container")
def node_container(element: Element) -> LaunchDescriptionEntity:
    return ComposableNodeContainer(
        package=element.need_parts("pkg"),
        executable=element.need_parts("exec"),
        name=element.need_parts("name"),
        namespace=_namespace(element) or "",
        composable_node_descriptions=_composable_nodes(element),
        **_node_options(element),
    )


@makes("load_composable_node")
def load_composable_node(element: Element) -> LaunchDescriptionEntity:
    return LoadComposableNodes(
        target_container=element.need_parts("target"),
        composable_node_descriptions=_composable_nodes(element),
        **condition_of(element),
    )


@makes("set_parameter")
def set_parameter(element: Element) -> LaunchDescriptionEntity:
    name, raw = element.need_parts("name"), element.value("value")
    is_plain = isinstance(raw, str) and not {"type", "value-sep"} & {
        *element.attributes
    }
    value = element.parse(raw) if is_plain else _value(element)
    return SetParameter(name, value, **condition_of(element))


def _namespace(element: Element) -> Any:
    """Return the attribute ``namespace``, or its short form ``ns``."""
    short = element.parts("ns")
    return element.parts("namespace") if short is None else short


def _node_options(element: Element) -> dict[str, Any]:
    options = execution_options(element)
    options["exec_name"] = element.parts("exec_name")
    for name, keyword in (("args", "arguments"), ("ros_args", "ros_arguments")):
        text = element.text(name)
        if text is not None:
            options[keyword] = parse_words(element, text)
    options["parameters"] = _parameters(element)
    options["remappings"] = _remappings(element)
    return options


def _remappings(element: Element) -> list[Any]:
    rules = []
    for each in element.elements("remap"):
        rules.append((each.need_parts("from"), each.need_parts("to")))
        each.finish()
    return rules


def _parameters(element: Element) -> list[Any]:
    found: list[Any] = []
    for each in element.elements("param"):
        path = each.parts("from")
        if path is not None:
            allow = each.flag("allow_substs") or False
            found.append(ParameterFile(path, allow_substs=allow))
            each.finish()
        else:
            found.append(_parameter(each))
    return found


def _parameter(element: Element) -> dict[Any, Any]:
    """Return ``{name: value}``; nested parameters give nested dicts."""
    name = tuple(element.need_parts("name"))
    inner = element.elements("param")
    value: Any = {}
    if inner:
        for each in inner:
            value.update(_parameter(each))
    else:
        value = _value(element)
    element.finish()
    return {name: value}


def _value(element: Element) -> Any:
    """Return the attribute ``value``, typed by YAML, by ``type``, or as a list."""
    raw = element.value("value")
    separator = element.text("value-sep")
    kind = element.text("type")
    if kind is not None and kind not in _TYPES:
        raise element.error(f"type {kind!r}; expected one of {', '.join(_TYPES)}")
    value_type = None if kind is None else _TYPES[kind]
    if raw is None:
        raise element.error("attribute 'value' is missing")
    if not isinstance(raw, str):  # typed by YAML
        return ParameterValue(raw, value_type=value_type)
    if separator is not None:
        items: list[Any] = [element.parse(part) for part in raw.split(separator)]
        return ParameterValue(items, value_type=value_type)
    is_yaml = element.path.suffix in (".yaml", ".yml")
    if value_type is None and is_yaml and "$(" not in raw:
        return ParameterValue(raw, value_type=str)  # a string in YAML
    return ParameterValue(element.parse(raw), value_type=value_type)


def _composable_nodes(element: Element) -> list[ComposableNode]:
    found = []
    for each in element.elements("composable_node"):
        extra: list[Any] = []
        for argument in each.elements("extra_arg"):
            name = tuple(argument.need_parts("name"))
            extra.append({name: tuple(argument.need_parts("value"))})
            argument.finish()
        found.append(
            ComposableNode(
                package=each.need_parts("pkg"),
                plugin=each.need_parts("plugin"),
                name=each.parts("name"),
                namespace=_namespace(each),
                parameters=_parameters(each),
                remappings=_remappings(each),
                extra_arguments=extra,
                **condition_of(each),
            )
        )
        each.finish()
    return found
