# SPDX-License-Identifier: Apache-2.0
"""SDF actors: models that follow a script (http://sdformat.org/spec?elem=actor).

The skin, an animated mesh, is replaced by an upright cylinder of a person's size; an
actor with links of its own has their shapes instead. Poses of waypoints are in the
world frame; roll and pitch, and without own links the height, are ignored.
"""

from navette.errors import InvalidValueError
from navette.geometry import Transform3, quaternion_from_yaw
from navette.sim.scene import Cylinder, Geometry, Link, Model
from navette.sim.sdf_poses import read_pose
from navette.sim.trajectory import Trajectory, Waypoint
from navette.sim.xml_tree import Unsupported, XmlNode

PERSON_RADIUS_M, PERSON_HEIGHT_M = 0.25, 1.7
MAX_ACTORS = 500
MAX_WAYPOINTS = 10_000

_KNOWN = {"pose", "skin", "animation", "script", "link", "static", "joint", "plugin"}
_LEVEL_RAD = 1e-3


def read_actor(
    node: XmlNode, links: tuple[Link, ...], unsupported: Unsupported
) -> Model:
    """Read an actor with its links, which are read already.

    Raises:
        FileFormatError: no script, no waypoint, or times that do not increase.
    """
    for child in node.children:
        if child.tag not in _KNOWN:
            unsupported.note(f"<{child.tag}> in <actor>", child)
    initial = read_pose(node).transform.to_pose2()
    script = node.need("script")
    waypoints = [Waypoint(0.0, initial.x, initial.y, 0.0, initial.yaw)]
    tensions = set()
    for trajectory in script.all("trajectory"):
        _append(waypoints, trajectory, unsupported)
        tensions.add(_tension(trajectory))
    if len(tensions) > 1:
        unsupported.note("different tensions of the trajectories of an actor", script)
    if not script.flag("auto_start", default=True):
        del waypoints[1:]
    delay = script.number("delay_start", 0.0)
    if delay < 0:
        raise script.need("delay_start").error(f"{delay:g} s; must be >= 0")
    if not links:
        links = (_person(),)
        waypoints = [each._replace(z=0.0) for each in waypoints]
    try:
        motion = Trajectory(
            waypoints=tuple(waypoints),
            loop=script.flag("loop", default=True),
            delay_s=delay,
            tension=min(tensions, default=0.0),
        )
    except InvalidValueError as error:
        raise script.error(str(error)) from error
    name = node.name()
    start = Transform3((*waypoints[0][1:4],), quaternion_from_yaw(waypoints[0].yaw))
    return Model(name=name, world_T_model=start, links=links, motion=motion)


def _append(
    waypoints: list[Waypoint], trajectory: XmlNode, unsupported: Unsupported
) -> None:
    """Add the waypoints of a trajectory; its times begin at the end of the last one.

    A waypoint at 0 s replaces the pose at which the last one ended.
    """
    begin_s = waypoints[-1].time_s
    before_s = -1.0
    nodes = list(trajectory.all("waypoint"))
    if not nodes:
        raise trajectory.error("no <waypoint>; expected one or more with time and pose")
    if len(waypoints) + len(nodes) > MAX_WAYPOINTS:
        raise trajectory.error(f"more than {MAX_WAYPOINTS} waypoints")
    for node in nodes:
        time_s = node.number("time")
        if time_s < 0:
            raise node.error(f"<time> is {time_s:g} s; must be >= 0")
        if time_s <= before_s:
            raise node.error(
                f"<time> is {time_s:g} s after {before_s:g} s; times must increase"
            )
        before_s = time_s
        node.need("pose")
        pose = read_pose(node).transform
        flat = pose.to_pose2()
        if _tilt(pose) > _LEVEL_RAD:
            unsupported.note("roll and pitch of a <waypoint>", node)
        waypoint = Waypoint(
            begin_s + time_s, flat.x, flat.y, pose.translation[2], flat.yaw
        )
        if time_s == 0:
            waypoints[-1] = waypoint
        else:
            waypoints.append(waypoint)


def _tilt(pose: Transform3) -> float:
    x, y, _, _ = pose.rotation
    return 2 * (x * x + y * y)


def _tension(trajectory: XmlNode) -> float:
    text = trajectory.attributes.get("tension", "0")
    (tension,) = trajectory.parse_numbers(text, 1)
    if not 0 <= tension <= 1:
        raise trajectory.error(f"tension {tension:g}; must be within [0, 1]")
    return tension


def _person() -> Link:
    body = Geometry(
        name="person",
        shape=Cylinder(PERSON_RADIUS_M, PERSON_HEIGHT_M),
        link_T_shape=Transform3((0.0, 0.0, PERSON_HEIGHT_M / 2), (0.0, 0.0, 0.0, 1.0)),
        colour=(0.85, 0.35, 0.30, 1.0),
    )
    return Link(name="person", geometries=(body,))
