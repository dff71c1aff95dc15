# SPDX-License-Identifier: Apache-2.0
"""SDF poses: `pose` elements and the graph of their frames."""

import math
from dataclasses import dataclass

from navette.geometry import Quaternion, Transform3, quaternion_from_rpy
from navette.sim.xml_tree import XmlNode


@dataclass(frozen=True)
class RawPose:
    """A pose as written: relative to a named frame ("" = the element's default)."""

    relative_to: str
    transform: Transform3
    node: XmlNode


def read_pose(owner: XmlNode) -> RawPose:
    """Read the ``<pose>`` of an element; identity without one.

    The attribute ``frame`` is the name of ``relative_to`` up to SDF 1.6.
    """
    node = owner.find("pose")
    if node is None:
        return RawPose("", Transform3.identity(), owner)
    attributes = node.attributes
    relative_to = attributes.get("relative_to") or attributes.get("frame") or ""
    return RawPose(relative_to.strip(), _transform(node), node)


def _transform(node: XmlNode) -> Transform3:
    if not node.text.strip():
        return Transform3.identity()
    if node.attributes.get("rotation_format", "euler_rpy") == "quat_xyzw":
        values = node.numbers(7)
        x, y, z, *quaternion = values
        return Transform3((x, y, z), _normalised(node, quaternion))
    x, y, z, *angles = node.numbers(6)
    if node.attributes.get("degrees", "false") in ("true", "1"):
        angles = [math.radians(angle) for angle in angles]
    return Transform3((x, y, z), quaternion_from_rpy(*angles))


def _normalised(node: XmlNode, values: list[float]) -> Quaternion:
    norm = math.sqrt(sum(value * value for value in values))
    if norm < 1e-6:
        raise node.error("a quaternion of length 0")
    x, y, z, w = (value / norm for value in values)
    return (x, y, z, w)


class PoseGraph:
    """Named frames of one scope, each relative to another; resolved lazily."""

    def __init__(self, root: str) -> None:
        self._root = root
        self._raw: dict[str, tuple[str, Transform3, XmlNode]] = {}
        self._resolved: dict[str, Transform3] = {root: Transform3.identity()}
        self._resolving: list[str] = []

    def add(self, name: str, pose: RawPose, default: str = "") -> None:
        """Add frame ``name``; ``default`` replaces an empty relative_to."""
        if name in self._raw:
            raise pose.node.error(f"the name {name!r} is used twice")
        parent = pose.relative_to or default or self._root
        self._raw[name] = (parent, pose.transform, pose.node)

    def add_fixed(
        self, name: str, parent: str, transform: Transform3, node: XmlNode
    ) -> None:
        self._raw[name] = (parent, transform, node)

    def resolve(self, pose: RawPose) -> Transform3:
        """``root_T_here`` of an unnamed pose."""
        parent = pose.relative_to or self._root
        return self.pose_of(parent, pose.node) @ pose.transform

    def resolve_in(self, frame: str, pose: RawPose) -> Transform3:
        """``frame_T_here``; exact if the pose is relative to ``frame`` itself."""
        if pose.relative_to in ("", frame):
            return pose.transform
        root_T_frame = self.pose_of(frame, pose.node)
        return root_T_frame.inverse() @ self.resolve(pose)

    def pose_of(self, name: str, asked_by: XmlNode) -> Transform3:
        """``root_T_name``.

        Raises:
            FileFormatError: the name is unknown or the frames form a cycle.
        """
        if name in self._resolved:
            return self._resolved[name]
        if name not in self._raw:
            known = ", ".join(list(self._raw)[:20])
            raise asked_by.error(f"unknown frame {name!r}; known: {known}")
        if name in self._resolving:
            circle = " → ".join([*self._resolving, name])
            raise asked_by.error(f"frames form a cycle: {circle}")
        parent, transform, node = self._raw[name]
        self._resolving.append(name)
        resolved = self.pose_of(parent, node) @ transform
        self._resolving.pop()
        self._resolved[name] = resolved
        return resolved
