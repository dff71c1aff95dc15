"""Build hook: generate the type stubs of messages and rclpy before a wheel is built."""

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class StubHook(BuildHookInterface):  # type: ignore[type-arg]
    """Write the stubs into the source tree, from which wheels take them.

    Editable installs (``pip install -e .``) run the hook too, so that mypy finds the
    stubs in a checkout.
    """

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Run the generators; they need only the standard library."""
        environment = {**os.environ, "PYTHONPATH": str(Path(self.root, "src"))}
        for generator in ("navette.msgs.generate", "navette.ros2.names.stubs"):
            command = [sys.executable, "-B", "-m", generator]
            subprocess.run(
                command, env=environment, check=True, stdout=subprocess.DEVNULL
            )
