"""Turtles and their lines as markers, which the live view and RViz show."""

import math
from collections.abc import Iterable

from navette.msgs.builtin_interfaces.msg import Time
from navette.msgs.geometry_msgs.msg import Point, Pose, Quaternion, Vector3
from navette.msgs.std_msgs.msg import ColorRGBA, Header
from navette.msgs.visualization_msgs.msg import Marker, MarkerArray
from navette.ros2.turtlesim.turtle import SIDE_M, Rgb, Stroke, Turtle

FRAME = "map"
_GREEN, _SHELL = (0x3C, 0x9D, 0x4B), (0x2E, 0x6B, 0x3A)
_EYE = (0xF4, 0xF4, 0xF4)
#: Parts of a turtle: x, y, length, width (m), colour.
_PARTS = (
    (0.0, 0.0, 0.50, 0.42, _SHELL),
    (0.29, 0.0, 0.20, 0.18, _GREEN),
    (0.17, 0.19, 0.20, 0.11, _GREEN),
    (0.17, -0.19, 0.20, 0.11, _GREEN),
    (-0.19, 0.17, 0.16, 0.10, _GREEN),
    (-0.19, -0.17, 0.16, 0.10, _GREEN),
    (0.35, 0.04, 0.04, 0.04, _EYE),
    (0.35, -0.04, 0.04, 0.04, _EYE),
)


def canvas_markers(
    background: Rgb, strokes: Iterable[Stroke], stamp: Time
) -> MarkerArray:
    """Return the background and all lines; they replace those shown before."""
    sheet = _marker("canvas", 0, Marker.CUBE, background, stamp)
    sheet.pose.position = Point(x=SIDE_M / 2, y=SIDE_M / 2, z=-0.02)
    sheet.scale = Vector3(x=SIDE_M, y=SIDE_M, z=0.02)
    lines = []
    for number, stroke in enumerate(strokes):
        line = _marker("lines", number, Marker.LINE_STRIP, stroke.colour, stamp)
        line.scale = Vector3(x=stroke.width_m)
        line.points = [Point(x=x, y=y) for x, y in stroke.points]
        lines.append(line)
    return MarkerArray(markers=[_delete_all(stamp), sheet, *lines])


def turtle_markers(turtles: Iterable[Turtle], stamp: Time) -> MarkerArray:
    """Return the turtles; they replace those shown before."""
    markers = [_delete_all(stamp)]
    for turtle in turtles:
        c, s = math.cos(turtle.theta), math.sin(turtle.theta)
        half = turtle.theta / 2.0
        turned = Quaternion(z=math.sin(half), w=math.cos(half))
        for number, (x, y, length, width, colour) in enumerate(_PARTS):
            part = _marker(turtle.name, number, Marker.SPHERE, colour, stamp)
            at = Point(x=turtle.x + c * x - s * y, y=turtle.y + s * x + c * y, z=0.05)
            part.pose = Pose(position=at, orientation=turned)
            part.scale = Vector3(x=length, y=width, z=0.1)
            markers.append(part)
    return MarkerArray(markers=markers)


def _delete_all(stamp: Time) -> Marker:
    return Marker(header=Header(stamp=stamp, frame_id=FRAME), action=Marker.DELETEALL)


def _marker(ns: str, number: int, kind: int, colour: Rgb, stamp: Time) -> Marker:
    marker = Marker(
        header=Header(stamp=stamp, frame_id=FRAME),
        ns=ns,
        id=number,
        type=kind,
        action=Marker.ADD,
    )
    r, g, b = colour
    marker.color = ColorRGBA(r=r / 255, g=g / 255, b=b / 255, a=1.0)
    return marker
