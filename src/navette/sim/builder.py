# SPDX-License-Identifier: Apache-2.0
"""Worlds written in Python, for tests and examples::

scene = World("corridor").add_box((2, 0), (0.2, 4)).add_cylinder((4, 1), 0.5).scene()
"""

from collections.abc import Sequence
from typing import Self

from navette.errors import InvalidValueError
from navette.geometry import Transform3, quaternion_from_yaw
from navette.sim.scene import (
    Box,
    Colour,
    Cylinder,
    Geometry,
    Link,
    Model,
    Plane,
    Scene,
    Shape,
)
from navette.sim.surface import Surface
from navette.sim.trajectory import Trajectory, Waypoint


class World:
    """Shapes on a floor at z = 0; every ``add_…`` method returns the world."""

    def __init__(self, name: str = "world") -> None:
        self._name = name
        self._models: list[Model] = []
        self._add("ground", Plane(), Transform3.identity(), (0.86, 0.86, 0.84, 1.0))

    def add_box(
        self,
        centre: tuple[float, float],
        size: tuple[float, float],
        *,
        height: float = 1.0,
        yaw: float = 0.0,
        base: float = 0.0,
        colour: Colour = (0.36, 0.47, 0.58, 1.0),
        surface: Surface | None = None,
    ) -> Self:
        """Add a box on the floor; size along its own x and y (m).

        ``base`` is the height of its underside; ``surface`` its answer to lasers.
        """
        _check_positive("box", (*size, height))
        pose = _standing(centre, height, yaw, base)
        return self._add("box", Box((*size, height)), pose, colour, surface)

    def add_cylinder(
        self,
        centre: tuple[float, float],
        radius: float,
        *,
        height: float = 1.0,
        base: float = 0.0,
        colour: Colour = (0.80, 0.50, 0.33, 1.0),
        surface: Surface | None = None,
    ) -> Self:
        """Add an upright cylinder on the floor, or ``base`` above it (m)."""
        _check_positive("cylinder", (radius, height))
        pose = _standing(centre, height, 0.0, base)
        shape = Cylinder(radius, height)
        return self._add("cylinder", shape, pose, colour, surface)

    def add_walls(
        self,
        size: tuple[float, float],
        *,
        thickness: float = 0.2,
        height: float = 1.0,
        colour: Colour = (0.55, 0.57, 0.60, 1.0),
    ) -> Self:
        """Add four walls around the origin; ``size`` is the free space between them."""
        _check_positive("walls", (*size, thickness, height))
        x, y = (edge / 2 + thickness / 2 for edge in size)
        long_x, long_y = size[0] + 2 * thickness, size[1]
        for sign in (1, -1):
            for centre, edges in (
                ((0.0, sign * y), (long_x, thickness)),
                ((sign * x, 0.0), (thickness, long_y)),
            ):
                self.add_box(centre, edges, height=height, colour=colour)
        return self

    def add_actor(
        self,
        waypoints: Sequence[tuple[float, float, float]],
        radius: float = 0.25,
        *,
        height: float = 1.7,
        loop: bool = True,
        delay: float = 0.0,
        colour: Colour = (0.85, 0.35, 0.30, 1.0),
    ) -> Self:
        """Add an upright cylinder that moves; waypoints are time (s), x, y (m).

        The first time is 0; between waypoints the cylinder moves straight at constant
        speed.
        """
        _check_positive("actor", (radius, height))
        motion = Trajectory(
            waypoints=tuple(Waypoint(*waypoint) for waypoint in waypoints),
            loop=loop,
            delay_s=delay,
        )
        shape = Cylinder(radius, height)
        body = Geometry(
            name="body",
            shape=shape,
            link_T_shape=_standing((0.0, 0.0), height, 0.0),
            colour=colour,
        )
        self._models.append(
            Model(
                name=f"actor_{len(self._models)}",
                links=(Link(name="link", geometries=(body,)),),
                motion=motion,
            )
        )
        return self

    def add_robot(self, robot: Model) -> Self:
        """Add a robot at its model's pose."""
        self._models.append(robot)
        return self

    def scene(self) -> Scene:
        return Scene(name=self._name, models=tuple(self._models))

    def _add(
        self,
        kind: str,
        shape: Shape,
        pose: Transform3,
        colour: Colour,
        surface: Surface | None = None,
    ) -> Self:
        geometry = Geometry(name=kind, shape=shape, colour=colour, surface=surface)
        self._models.append(
            Model(
                name=f"{kind}_{len(self._models)}",
                world_T_model=pose,
                static=True,
                links=(Link(name="link", geometries=(geometry,)),),
            )
        )
        return self


def _standing(
    centre: tuple[float, float], height: float, yaw: float, base: float = 0.0
) -> Transform3:
    return Transform3((*centre, base + height / 2), quaternion_from_yaw(yaw))


def _check_positive(what: str, values: Sequence[float]) -> None:
    if min(values) <= 0:
        raise InvalidValueError(f"{what} of {tuple(values)} m: expected sizes > 0")
