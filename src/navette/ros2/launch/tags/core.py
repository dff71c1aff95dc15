"""Tags of ``launch``."""

from collections.abc import Callable
from typing import Any

from navette.ros2.packages.launch.action import Action, reads_arguments
from navette.ros2.packages.launch.actions import (
    AppendEnvironmentVariable,
    DeclareLaunchArgument,
    ExecuteProcess,
    GroupAction,
    IncludeLaunchDescription,
    Log,
    LogInfo,
    ResetEnvironment,
    ResetLaunchConfigurations,
    SetEnvironmentVariable,
    SetLaunchConfiguration,
    Shutdown,
    TimerAction,
    UnsetEnvironmentVariable,
    UnsetLaunchConfiguration,
)
from navette.ros2.packages.launch.conditions import condition_of
from navette.ros2.packages.launch.frontend import (
    Element,
    makes,
    parse_elements,
    parse_substitution,
)
from navette.ros2.packages.launch.frontend.grammar import split_words
from navette.ros2.packages.launch.launch_description_entity import (
    LaunchDescriptionEntity,
)


def makes_simple_action(
    tag: str, action: Callable[..., Action], *attributes: str
) -> None:
    """Register an action whose arguments are required attributes, in order."""

    @makes(tag)
    def make(element: Element) -> LaunchDescriptionEntity:
        values = [element.need_parts(name) for name in attributes]
        return action(*values, **condition_of(element))


makes_simple_action("let", SetLaunchConfiguration, "name", "value")
makes_simple_action("unset", UnsetLaunchConfiguration, "name")
makes_simple_action("set_env", SetEnvironmentVariable, "name", "value")
makes_simple_action("unset_env", UnsetEnvironmentVariable, "name")
makes_simple_action("reset_env", ResetEnvironment)


@makes("arg")
def argument(element: Element) -> LaunchDescriptionEntity:
    choices = [choice.need("value") for choice in element.elements("choice")]
    return DeclareLaunchArgument(
        element.need("name"),
        default_value=element.parts("default"),
        description=element.text("description"),
        choices=choices or None,
        **condition_of(element),
    )


@makes("append_env")
def append_environment(element: Element) -> LaunchDescriptionEntity:
    options: dict[str, Any] = {}
    for name, read in (
        ("prepend", element.bool_or_parts),
        ("separator", element.parts),
    ):
        value = read(name)
        if value is not None:
            options[name] = value
    return AppendEnvironmentVariable(
        element.need_parts("name"),
        element.need_parts("value"),
        **options,
        **condition_of(element),
    )


@makes("reset")
def reset(element: Element) -> LaunchDescriptionEntity:
    kept = {
        keep.need("name"): keep.need_parts("value") for keep in element.elements("keep")
    }
    return ResetLaunchConfigurations(kept, **condition_of(element))


@makes("group")
def group(element: Element) -> LaunchDescriptionEntity:
    return GroupAction(**group_arguments(element))


@reads_arguments(GroupAction)
def group_arguments(element: Element) -> dict[str, Any]:
    scoped, forwarding = element.flag("scoped"), element.flag("forwarding")
    kept = {
        keep.need("name"): keep.need_parts("value") for keep in element.elements("keep")
    }
    return {
        "actions": parse_elements(element.rest()),
        "scoped": True if scoped is None else scoped,
        "forwarding": True if forwarding is None else forwarding,
        "launch_configurations": kept,
        **condition_of(element),
    }


@makes("include")
def include(element: Element) -> LaunchDescriptionEntity:
    arguments = []
    for tag in ("arg", "let"):
        for each in element.elements(tag):
            arguments.append((each.need_parts("name"), each.need_parts("value")))
            each.finish()
    return IncludeLaunchDescription(
        element.need_parts("file"), launch_arguments=arguments, **condition_of(element)
    )


@makes("log")
def log(element: Element) -> LaunchDescriptionEntity:
    level = element.parts("level")
    if level is not None:
        return Log(
            msg=element.need_parts("message"), level=level, **condition_of(element)
        )
    return LogInfo(msg=element.need_parts("message"), **condition_of(element))


@makes("shutdown")
def shutdown(element: Element) -> LaunchDescriptionEntity:
    reason = element.parts("reason") or parse_substitution("reason not given")
    return Shutdown(reason=reason, **condition_of(element))


@makes("timer")
def timer(element: Element) -> LaunchDescriptionEntity:
    return TimerAction(
        period=element.number_or_parts("period"),
        actions=parse_elements(element.rest()),
        **condition_of(element),
    )


@makes("executable")
def executable(element: Element) -> LaunchDescriptionEntity:
    return ExecuteProcess(**executable_arguments(element))


@reads_arguments(ExecuteProcess)
def executable_arguments(element: Element) -> dict[str, Any]:
    words = element.need("cmd")
    arguments = element.text("args")
    text = words if arguments is None else f"{words} {arguments}"
    return {"cmd": parse_words(element, text), **execution_options(element)}


def parse_words(element: Element, text: str) -> list[Any]:
    """Return the words of a command line, each with its substitutions."""
    return [element.parse(word) for word in split_words(text)]


def execution_options(element: Element) -> dict[str, Any]:
    """Return the options shared by ``executable`` and ``node``."""
    options: dict[str, Any] = dict(condition_of(element))
    for tag, keyword in (
        ("cwd", "cwd"),
        ("launch-prefix", "prefix"),
        ("output", "output"),
        ("sigterm_timeout", "sigterm_timeout"),
        ("sigkill_timeout", "sigkill_timeout"),
    ):
        parts = element.parts(tag)
        if parts is not None:
            options[keyword] = parts
    for tag in ("emulate_tty", "respawn"):
        choice = element.bool_or_parts(tag)
        if choice is not None:
            options[tag] = choice
    for tag in ("shell", "required"):
        flag = element.flag(tag)
        if flag is not None:
            options[tag] = flag
    _add_numbers(element, options)
    name = element.parts("name") if element.tag == "executable" else None
    if name is not None:
        options["name"] = name
    variables = {}
    for each in element.elements("env"):
        variables[tuple(each.need_parts("name"))] = each.need_parts("value")
        each.finish()
    if variables:
        options["additional_env"] = variables
    return options


def _add_numbers(element: Element, options: dict[str, Any]) -> None:
    for tag, kind in (("respawn_delay", float), ("respawn_max_retries", int)):
        text = element.text(tag)
        if text is not None:
            try:
                options[tag] = kind(text)
            except ValueError:
                raise element.error(f"{tag} {text!r}: expected a number") from None
    ending = element.text("on_exit")
    if ending is not None:
        if ending != "shutdown":
            raise element.error(f"on_exit {ending!r}: expected shutdown")
        options["on_exit"] = Shutdown(reason=f"<{element.tag}> ended")
