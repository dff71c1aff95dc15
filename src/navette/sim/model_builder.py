# SPDX-License-Identifier: Apache-2.0
"""Adds the models of a scene to a MuJoCo specification."""

from dataclasses import replace

import mujoco

from navette.errors import InvalidValueError
from navette.geometry import Transform3
from navette.sim.bodies import add_cameras, add_joint, set_inertia, tyre_of, wxyz
from navette.sim.drive_geometry import rolling_links
from navette.sim.masks import FREE, GROUND, OBSTACLE, ROBOT_GROUP, SOLID, group_of
from navette.sim.scene import (
    Geometry,
    JointKind,
    Link,
    MecanumDrive,
    Model,
    Plane,
    Scene,
)
from navette.sim.shape_geoms import add_geom, friction_of
from navette.sim.surface import Surface

_SERVO_TIME_S = 0.002  # time constant of the wheel speed servo; a longer one droops


class ModelBuilder:
    def __init__(
        self, spec: mujoco.MjSpec, scene: Scene, tyre_solimp: tuple[float, ...]
    ) -> None:
        self.spec = spec
        self.tyre_solimp = tyre_solimp
        self.scene = scene
        self.owner: dict[str, str] = {}
        self.ground: set[str] = set()
        self.surfaces: dict[str, Surface] = {}
        self.bodies: dict[tuple[str, str], str] = {}
        planes = [
            geometry.friction
            for model in scene.models
            for link in model.links
            for geometry in link.geometries
            if isinstance(geometry.shape, Plane) and geometry.friction is not None
        ]
        # Gazebo uses the smaller friction of a pair, MuJoCo the larger: the
        # wheels get the smaller one and the higher priority.
        self.ground_friction = min(planes, default=1.0)

    def add_ground_if_missing(self) -> None:
        for model in self.scene.models:
            for link in model.links:
                for geometry in link.geometries:
                    if isinstance(geometry.shape, Plane) and geometry.collides:
                        return
        if self.scene.mjcf is None:
            plane = Geometry(name="plane", shape=Plane())
            link = Link(name="link", geometries=(plane,))
            self.add_model(
                Model(name="ground", static=True, links=(link,)), is_robot=False
            )

    def add_model(self, model: Model, *, is_robot: bool) -> None:
        if model.motion is not None:
            self._add_actor(model)
            return
        if model.static:
            for link in model.links:
                self._add_static(self.spec.worldbody, model, link, model.world_T_model)
            return
        for link in root_links(model):
            pinned = any(
                j.child == link.name and j.parent == "world" for j in model.joints
            )
            body = self._add_body(
                self.spec.worldbody,
                model,
                link,
                model.world_T_model @ link.model_T_link,
                is_robot=is_robot,
                moves=not pinned,
            )
            if not pinned:
                body.add_freejoint(name=f"{model.name}/{link.name}/free")

    def _add_actor(self, model: Model) -> None:
        """Add a body whose pose is set, not simulated."""
        body = self.spec.worldbody.add_body(name=actor_name(model), mocap=True)
        for link in model.links:
            self._add_static(body, model, link, Transform3.identity())

    def _add_static(
        self,
        body: mujoco.MjsBody,
        model: Model,
        link: Link,
        body_T_model: Transform3,
    ) -> None:
        body_T_link = body_T_model @ link.model_T_link
        for geometry in link.geometries:
            ground = isinstance(geometry.shape, Plane) or geometry.is_ground
            name = self._name(model, link, geometry)
            add_geom(
                body,
                name,
                geometry,
                body_T_link @ geometry.link_T_shape,
                group=group_of(geometry),
                contype=(GROUND if ground else OBSTACLE) if geometry.collides else 0,
                conaffinity=0,
            )
            if ground:
                self.ground.add(name)

    def _name(self, model: Model, link: Link, geometry: Geometry) -> str:
        name = f"{model.name}/{link.name}/{geometry.name}#{len(self.owner)}"
        only = len(model.links) == 1
        self.owner[name] = model.name if only else f"{model.name}/{link.name}"
        if geometry.surface is not None:
            self.surfaces[name] = geometry.surface
        return name

    def _add_body(
        self,
        parent: mujoco.MjsBody,
        model: Model,
        link: Link,
        pose: Transform3,
        *,
        is_robot: bool,
        moves: bool,
    ) -> mujoco.MjsBody:
        name = f"{model.name}/{link.name}"
        body = parent.add_body(name=name, pos=pose.translation, quat=wxyz(pose))
        self.bodies[model.name, link.name] = name
        set_inertia(body, link, moves=moves)
        self._add_geometries(body, model, link, is_robot=is_robot)
        if is_robot:
            add_cameras(body, model, link)
        for joint in model.joints:
            if joint.parent != link.name:
                continue
            child = model.link(joint.child)
            link_T_child = link.model_T_link.inverse() @ child.model_T_link
            inner = self._add_body(
                body,
                model,
                child,
                link_T_child,
                is_robot=is_robot,
                moves=joint.kind is not JointKind.FIXED,
            )
            add_joint(
                inner, model, joint.name, child, degrees=self.spec.compiler.degree
            )
        return body

    def _add_geometries(
        self, body: mujoco.MjsBody, model: Model, link: Link, *, is_robot: bool
    ) -> None:
        wheels = rolling_links(model) if is_robot else set()
        slides = isinstance(model.drive, MecanumDrive)
        for geometry in link.geometries:
            affinity = GROUND | OBSTACLE | FREE if geometry.collides else 0
            tyre = tyre_of(geometry) if link.name in wheels else None
            if tyre is not None:
                affinity = OBSTACLE | FREE
                # The rollers of a mecanum wheel roll: servos.py adds their traction.
                tyre = replace(tyre, friction=0.0) if slides else tyre
                self._add_tyre(body, model, link, tyre)
            friction = friction_of(geometry.friction)
            add_geom(
                body,
                self._name(model, link, geometry),
                geometry,
                geometry.link_T_shape,
                group=group_of(geometry) + (ROBOT_GROUP if is_robot else 0),
                contype=0 if is_robot or not geometry.collides else FREE,
                conaffinity=affinity,
                friction=min(friction, self.ground_friction) if is_robot else None,
                priority=1 if is_robot else 0,
            )

    def _add_tyre(
        self, body: mujoco.MjsBody, model: Model, link: Link, tyre: Geometry
    ) -> None:
        add_geom(
            body,
            self._name(model, link, tyre),
            tyre,
            tyre.link_T_shape,
            group=SOLID + ROBOT_GROUP,
            contype=0,
            conaffinity=GROUND,
            friction=min(friction_of(tyre.friction), self.ground_friction),
            priority=1,
            solimp=self.tyre_solimp,
        )


def actor_name(model: Model) -> str:
    """Return MuJoCo's name of the body of a model with a scripted motion."""
    return f"{model.name}/scripted"


def root_links(model: Model) -> list[Link]:
    """Return the links without a parent.

    Raises:
        InvalidValueError: a link has two parents, or the joints form a cycle.
    """
    carried = [joint.child for joint in model.joints if joint.parent != "world"]
    twice = {name for name in carried if carried.count(name) > 1}
    roots = [link for link in model.links if link.name not in carried]
    reached = {link.name for link in roots}
    while True:
        more = {j.child for j in model.joints if j.parent in reached} - reached
        if not more:
            break
        reached |= more
    lost = {link.name for link in model.links} - reached
    if twice or lost:
        raise InvalidValueError(
            f"model {model.name!r}: joints must form a tree; "
            f"check links {', '.join(sorted(twice | lost))}"
        )
    return roots


def carrier_of(model: Model, link: str) -> Link:
    """Return the root link above ``link``."""
    parents = {j.child: j.parent for j in model.joints if j.parent != "world"}
    while link in parents:
        link = parents[link]
    return model.link(link)
