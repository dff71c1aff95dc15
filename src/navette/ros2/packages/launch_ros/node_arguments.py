"""ROS arguments of a node's program."""

import json
import math
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from navette.errors import ParameterError
from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.substitution import (
    Parts,
    Substitution,
)
from navette.ros2.packages.launch_ros.parameter_descriptions import (
    Parameter,
    ParameterFile,
    evaluate_dict,
)
from navette.ros2.packages.launch_ros.scope import global_parameters, global_remaps

Evaluated = list[Path | tuple[str, Any]]
"""Parameter files and (name, value) pairs; later ones override earlier ones."""


def evaluate_parameters(context: LaunchContext, given: Iterable[Any]) -> Evaluated:
    """Return the parameters of the scope, then those of the node.

    Raises:
        InvalidLaunchValueError: an item is not a path, dict or Parameter.
    """
    found: Evaluated = list(global_parameters(context))
    for item in given:
        if isinstance(item, dict):
            found += evaluate_dict(context, item)
        elif isinstance(item, (Parameter, ParameterFile)):
            found.append(item.evaluate(context))
        elif isinstance(item, (str, Path, Substitution, list, tuple)):
            found.append(ParameterFile(item).evaluate(context))
        else:
            raise InvalidLaunchValueError(
                f"parameters: {item!r} ({type(item).__name__}): expected a dict, the "
                "path of a file, or a Parameter"
            )
    return found


def evaluate_remaps(
    context: LaunchContext, given: Iterable[Any]
) -> list[tuple[str, str]]:
    """Return the remappings of the scope, then those of the node."""
    found = global_remaps(context)
    for rule in given:
        if isinstance(rule, str) or len(tuple(rule)) != 2:
            raise InvalidLaunchValueError(
                f"remappings: {rule!r}: expected a pair, as in ('from', 'to')"
            )
        source, target = rule
        found.append((_text(context, source), _text(context, target)))
    return found


def ros_arguments(
    name: str | None,
    namespace: str,
    parameters: Evaluated,
    remaps: Iterable[tuple[str, str]],
) -> list[str]:
    """Return the words after ``--ros-args``."""
    words: list[str] = []
    if name is not None:
        words += ["-r", f"__node:={name}"]
    if namespace:
        words += ["-r", f"__ns:={namespace}"]
    for item in parameters:
        if isinstance(item, Path):
            words += ["--params-file", str(item)]
        else:
            words += ["-p", f"{item[0]}:={parameter_text(*item)}"]
    for source, target in remaps:
        words += ["-r", f"{source}:={target}"]
    return words


def parameter_text(name: str, value: Any) -> str:
    """Format a value for ``-p``; parsing it returns the same value and type."""
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(parameter_text(name, each) for each in value)}]"
    if isinstance(value, bool) or not isinstance(value, float):
        if not isinstance(value, (bool, int, str)):
            raise ParameterError(
                f"parameter {name!r}: {value!r} ({type(value).__name__}): expected a "
                "bool, int, float, string or a list of one of these"
            )
        return json.dumps(value, ensure_ascii=False)
    if math.isnan(value):
        return ".nan"
    if math.isinf(value):
        return ".inf" if value > 0 else "-.inf"
    return repr(value)


def _text(context: LaunchContext, value: Any) -> str:
    return Parts.of(value).perform(context)
