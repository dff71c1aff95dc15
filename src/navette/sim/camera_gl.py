# SPDX-License-Identifier: Apache-2.0
"""A pinhole camera rendered by OpenGL, if available."""

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
from navette.sim.instant import Instant
from navette.sim.masks import SEEN, SEEN_SOLID
from navette.sim.sensor_specs import CameraSensor

_log = logging.getLogger(__name__)

_PROBE = """
import mujoco
model = mujoco.MjModel.from_xml_string("<mujoco/>")
mujoco.Renderer(model, 8, 8).render()
"""
_PROBE_TIMEOUT_S = 30.0


@functools.cache
def probe() -> str | None:
    """Return the OpenGL backend that works, as a value of ``MUJOCO_GL``, or None.

    Probed in another process: a missing library breaks the import of MuJoCo's context,
    and a broken driver may crash the process.
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
    """Whether cameras use OpenGL, by the parameter ``camera_renderer``.

    Raises:
        ParameterError: OpenGL is required but not available.
    """
    if renderer == "raycast":
        return False
    found = probe() is not None
    if renderer == "gl" and not found:
        raise ParameterError(
            "parameter 'camera_renderer': 'gl' is not available (it needs PyOpenGL "
            "and EGL, OSMesa or a display); use raycast or auto"
        )
    if not found:
        _log.info("OpenGL is not available: cameras are rendered by ray casting")
    return found


class GlCamera:
    """MuJoCo's renderer; the robot is invisible to it, as to the ray-cast camera."""

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

    def read(self, instant: Instant, rng: np.random.Generator) -> Image:
        """Render the image of an instant."""
        mujoco.mj_camlight(instant.model, instant.data)
        self._renderer.update_scene(instant.data, self._camera, self._option)
        return np.asarray(self._renderer.render(), dtype=np.uint8)


def _use_backend(backend: str) -> None:
    """Reload MuJoCo's OpenGL context, which is chosen at import."""
    from mujoco.rendering.classic import gl_context

    if os.environ.get("MUJOCO_GL") != backend:
        os.environ["MUJOCO_GL"] = backend
        importlib.reload(gl_context)
