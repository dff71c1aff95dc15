"""What is compared: trials with different methods, robots or parameters."""

import dataclasses
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from navette.errors import InvalidValueError
from navette.navigation.bench.trial import Trial, TrialResult
from navette.navigation.stack.methods import METHOD_PARAMETERS
from navette.params.plugins.registry import is_place

BASELINE, MINE = "baseline", "mine"
"""The stack's own methods, and those of the options."""

_FORMS = (
    f"{BASELINE} (the robot's own methods), {MINE} (those of the options), a file of "
    "--results, or settings as controller=mppi,control.cruise_speed_mps=1.5"
)


def with_variant(trials: Sequence[Trial], text: str) -> list[Trial]:
    """Return the trials of a variant.

    Args:
        trials: with the methods and parameters of the options.
        text: ``baseline``, ``mine``, or settings NAME=VALUE,… on top of the options.

    Raises:
        InvalidValueError: another text.
    """
    if text == MINE:
        changes: dict[str, Any] = {}
    elif text == BASELINE:
        changes = {"methods": {}, "replacements": {}, "parameters": {}}
    else:
        return [_changed(trial, text) for trial in trials]
    return [dataclasses.replace(each, variant=text, **changes) for each in trials]


def _changed(trial: Trial, text: str) -> Trial:
    from navette.runtime.parameter_files import parse_value

    methods = dict(trial.methods)
    parameters = {node: dict(values) for node, values in trial.parameters.items()}
    robot = trial.robot
    for setting in text.split(","):
        name, equals, value = setting.partition("=")
        node, dot, parameter = name.partition(".")
        if not equals or not value:
            raise InvalidValueError(f"--compare {text!r}: expected {_FORMS}")
        if name in METHOD_PARAMETERS:
            methods[name] = absolute_place(value)
        elif name == "robot":
            robot = absolute_place(value)
        elif dot and parameter:
            parameters.setdefault(node, {})[parameter] = parse_value(value)
        else:
            known = ", ".join([*METHOD_PARAMETERS, "robot", "NODE.PARAMETER"])
            raise InvalidValueError(
                f"--compare {text!r}: unknown setting {name!r}; known: {known}"
            )
    return dataclasses.replace(
        trial, methods=methods, parameters=parameters, robot=robot, variant=text
    )


def absolute_place(text: str) -> str:
    """Return the place of a file, or of a method in a file, with an absolute path.

    Other processes and machines may have another working folder.
    """
    file, colon, name = text.rpartition(":")
    path = Path(file if colon and is_place(text) else text)
    if not path.is_file():
        return text
    return f"{path.resolve()}{colon}{name}" if colon else str(path.resolve())


def is_results_file(text: str) -> bool:
    """Whether the text names a file of results."""
    return Path(text).is_file() and not is_place(text)


def renamed(results: Sequence[TrialResult], variant: str) -> list[TrialResult]:
    """Return the results under the name of a variant."""
    return [dataclasses.replace(each, variant=variant) for each in results]
