# SPDX-License-Identifier: Apache-2.0
"""Axis-aligned boxes around geoms."""

import mujoco
import numpy as np
from numpy.typing import NDArray


def bounds_of(
    model: mujoco.MjModel, data: mujoco.MjData, geoms: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Corners (N, 3) of axis-aligned boxes around geoms, world frame."""
    rotation = data.geom_xmat[geoms].reshape(-1, 3, 3)
    local = model.geom_aabb[geoms]
    middle = data.geom_xpos[geoms] + np.einsum("nij,nj->ni", rotation, local[:, :3])
    half = np.einsum("nij,nj->ni", np.abs(rotation), local[:, 3:])
    return middle - half, middle + half
