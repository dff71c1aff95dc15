# SPDX-License-Identifier: Apache-2.0
"""A pinhole camera drawn by OpenGL, where the machine has it."""

import functools
import importlib
import logging
import os
import subprocess
import sys

import mujoco
import numpy as np

from navette.errors import ParameterError
from navette.sim.camera import Image
from navette.sim.masks import SEEN, SEEN_SOLID
from navette.sim.scene import CameraSensor

_log = logging.getLogger(__name__)

_PROBE = """
import mujoco
model = mujoco.MjModel.from_xml_string("<mujoco/>")
mujoco.Renderer(model, 8, 8).render()
"""
_PROBE_TIMEOUT_S = 30.0


@functools.cache
def probe() -> str | None:
    """The OpenGL backend that works here, as ``MUJOCO_GL`` names it; None: none.

    Tried in another process: a missing library fails the import of MuJoCo's context,
    a broken driver may end the process.
    """
    chosen = os.environ.get("MUJOCO_GL")
    candidates = [chosen] if chosen else ["egl", "osmesa", ""]
    for backend in candidates:
        environment = {**os.environ, "MUJOCO_GL": backend}
        try:
            result = subprocess.run(
                [sys.executable, "-c", _PROBE],
                env=environment,
                capture_output=True,
                timeout=_PROBE_TIMEOUT_S,
                check=False,
            )
        except subprocess.TimeoutExpired:
            continue
        if result.returncode == 0:
            return backend
    return None


def wants_gl(renderer: str) -> bool:
    """Whether cameras shall use OpenGL, by the parameter ``camera_renderer``.

    Raises:
        ParameterError: OpenGL is demanded and does not work here.
    """
    if renderer == "raycast":
        return False
    found = probe() is not None
    if renderer == "gl" and not found:
        raise ParameterError(
            "parameter 'camera_renderer': 'gl' does not work here (it needs PyOpenGL "
            "and EGL, OSMesa or a display); wanted raycast, or auto"
        )
    if not found:
        _log.info("no OpenGL here: cameras are drawn by ray casting")
    return found


class GlCamera:
    """MuJoCo's own renderer; as the ray-cast camera, it does not see the robot."""

    def __init__(
        self, sensor: CameraSensor, camera: str, model: mujoco.MjModel
    ) -> None:
        self.sensor = sensor
        self._camera = camera
        _use_backend(probe() or "")
        width, height = sensor.width, sensor.height
        model.vis.global_.offwidth = max(model.vis.global_.offwidth, width)
        model.vis.global_.offheight = max(model.vis.global_.offheight, height)
        self._renderer = mujoco.Renderer(model, height, width)
        self._option = mujoco.MjvOption()
        self._option.geomgroup[:] = 0
        self._option.geomgroup[[SEEN_SOLID, SEEN]] = 1

    def render(self, model: mujoco.MjModel, data: mujoco.MjData) -> Image:
        """The image now (kinematics must be fresh)."""
        mujoco.mj_camlight(model, data)
        self._renderer.update_scene(data, self._camera, self._option)
        return np.asarray(self._renderer.render(), dtype=np.uint8)


def _use_backend(backend: str) -> None:
    """MuJoCo picks its OpenGL context when it is imported; let it pick again."""
    from mujoco.rendering.classic import gl_context

    if os.environ.get("MUJOCO_GL") != backend:
        os.environ["MUJOCO_GL"] = backend
        importlib.reload(gl_context)
