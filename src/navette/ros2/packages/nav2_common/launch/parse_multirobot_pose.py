"""Poses of several robots in one launch argument."""

import sys
from typing import Any

from navette.files.untrusted.yaml_input import load_yaml

_POSE = ("x", "y", "z", "roll", "pitch", "yaw")


class ParseMultiRobotPose:
    """Robots and poses of ``NAME:="r1={x: 1.0, yaw: 0.5}; r2={…}"``.

    Args:
        target_argument: name of the launch argument, searched on the command line.
    """

    def __init__(self, target_argument: str) -> None:
        start = f"{target_argument}:="
        texts = (a.removeprefix(start) for a in sys.argv if a.startswith(start))
        self._text = next(texts, "")

    def value(self) -> dict[str, dict[str, Any]]:
        """Return the pose of each robot (m, rad); what is not given is 0."""
        robots = {}
        for part in self._text.split(";"):
            name, found, pose = part.partition("=")
            if found:
                given = load_yaml(pose) or {}
                robots[name.strip()] = {**dict.fromkeys(_POSE, 0.0), **given}
        return robots
