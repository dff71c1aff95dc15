"""Build hook: what a wheel contains beside the sources.

Type stubs of messages and rclpy, and the kernels, compiled for a generic processor.
"""

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

STUBS = ("navette.msgs.generate", "navette.ros2.names.stubs")
KERNELS = "navette.navigation.stack.kernel_build"


class GeneratedFilesHook(BuildHookInterface):  # type: ignore[type-arg]
    """Write the generated files into the source tree, from which wheels take them.

    Editable installs (``pip install -e .``) run the hook too, so that mypy finds the
    stubs in a checkout. ``NAVETTE_BUILD_KERNELS=0`` omits the kernels, and
    ``NAVETTE_WHEEL_TAG`` is the tag of a wheel with those of one platform.
    """

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Run the generators; without kernels, the first start compiles them."""
        for generator in STUBS:
            self._run(generator, stdout=subprocess.DEVNULL).check_returncode()
        if os.environ.get("NAVETTE_BUILD_KERNELS") != "0":
            self.app.display_info("compiling kernels, about a minute")
            if self._run(KERNELS).returncode != 0:
                self.app.display_warning("the wheel has no compiled kernels")
        if tag := os.environ.get("NAVETTE_WHEEL_TAG"):
            build_data["tag"] = tag

    def _run(
        self, module: str, stdout: int | None = None
    ) -> "subprocess.CompletedProcess[bytes]":
        # pip's build environment is named by PYTHONPATH.
        paths = [str(Path(self.root, "src")), os.environ.get("PYTHONPATH", "")]
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, paths))}
        command = [sys.executable, "-B", "-m", module]
        return subprocess.run(command, env=environment, stdout=stdout)
