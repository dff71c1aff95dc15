"""The command that repeats a trial with the live view."""

import math
import shlex

from navette.navigation.bench.trial import Trial


def replay_command(trial: Trial) -> str:
    """Return the command; generated worlds are made again from their seed."""
    words = ["navette", "sim", trial.world]
    if trial.robot is not None:
        words += ["--robot", trial.robot]
    if trial.start is not None:
        x, y, yaw = trial.start
        words += ["--start", f"{x:.9g}", f"{y:.9g}", f"{math.degrees(yaw):.12g}"]
    for x, y in trial.goals:
        words += ["--goal", f"{x:.9g},{y:.9g}"]
    if trial.seed:
        words += ["--seed", str(trial.seed)]
    for path in trial.params_files:
        words += ["--params", str(path)]
    for kind, name in trial.methods.items():
        words += [f"--{kind}", name]
    for node, place in trial.replacements.items():
        words += ["--replace", f"{node}={place}"]
    for node, values in trial.parameters.items():
        for name, value in values.items():
            words += ["-p", f"{node}.{name}={_text(value)}"]
    return shlex.join(words)


def _text(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)
