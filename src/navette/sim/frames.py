# SPDX-License-Identifier: Apache-2.0
"""Names and fixed poses of the robot's frames."""

from dataclasses import dataclass

from navette.errors import ParameterError
from navette.geometry import Transform3, quaternion_from_rpy
from navette.sim.build import RobotIndex
from navette.sim.params import SimParams
from navette.sim.robot_state import moving_links
from navette.sim.scene import Link
from navette.sim.sensor_specs import CameraSensor, Sensor

# Optical frames look along +z, with x to the right (REP 103).
_CAMERA_T_OPTICAL = Transform3(
    (0.0, 0.0, 0.0), quaternion_from_rpy(-1.5707963267948966, 0.0, -1.5707963267948966)
)


@dataclass(frozen=True)
class FixedFrame:
    """A frame fixed to its parent frame."""

    parent: str
    name: str
    parent_T_frame: Transform3


class RobotFrames:
    """Frames of links and sensors: ``<prefix><link>`` and ``<link's>/<sensor>``.

    A link with the name of the base frame is the base frame. A sensor whose model names
    a frame has that frame.
    """

    def __init__(self, robot: RobotIndex, params: SimParams) -> None:
        self.base = params.base_frame
        self._prefix = params.link_frame_prefix
        base_T_model = robot.model_T_base.inverse()
        moving = moving_links(robot.model)
        self.fixed: list[FixedFrame] = []
        self.moving = {name: self.of_link(name) for name in moving}
        self._link_frames = [self.of_link(link.name) for link in robot.model.links]
        self.base_T_frame = {self.base: Transform3.identity()}
        for link in robot.model.links:
            base_T_link = base_T_model @ link.model_T_link
            self._add_link(link, base_T_link, is_fixed=link.name not in moving)

    def of_link(self, link: str) -> str:
        return f"{self._prefix}{link.replace('::', '/')}"

    def of_sensor(self, link: str, sensor: Sensor) -> str:
        """Frame id of the sensor's messages."""
        if sensor.frame:
            return f"{self._prefix}{sensor.frame}"
        frame = f"{self.of_link(link)}/{sensor.name}"
        return f"{frame}/optical" if isinstance(sensor, CameraSensor) else frame

    def fixed_pose(self, frame: str) -> Transform3:
        """``base_T_frame``.

        Raises:
            ParameterError: unknown or moving frame; lists the fixed ones.
        """
        pose = self.base_T_frame.get(frame)
        if pose is None:
            known = ", ".join(self.base_T_frame)
            raise ParameterError(
                f"frame {frame!r} is not fixed to the robot's base; fixed frames: "
                f"{known}"
            )
        return pose

    def _add_link(self, link: Link, base_T_link: Transform3, *, is_fixed: bool) -> None:
        frame = self.of_link(link.name)
        if is_fixed and frame != self.base:
            self._add(self.base, frame, base_T_link, is_fixed=True)
        for sensor in link.sensors:
            if sensor.frame:
                self._add_named(frame, link.name, sensor, is_fixed=is_fixed)
                continue
            name = f"{frame}/{sensor.name}"
            self._add(frame, name, sensor.link_T_sensor, is_fixed=is_fixed)
            if isinstance(sensor, CameraSensor):
                self._add(name, f"{name}/optical", _CAMERA_T_OPTICAL, is_fixed=is_fixed)

    def _add_named(
        self, link_frame: str, link: str, sensor: Sensor, *, is_fixed: bool
    ) -> None:
        """Add the frame that a sensor names, unless it is that of a link or sensor."""
        name, pose = self.of_sensor(link, sensor), sensor.link_T_sensor
        if isinstance(sensor, CameraSensor):
            pose = pose @ _CAMERA_T_OPTICAL
        known = {self.base, *self._link_frames, *(each.name for each in self.fixed)}
        if name not in known:
            self._add(link_frame, name, pose, is_fixed=is_fixed)

    def _add(
        self, parent: str, name: str, parent_T_frame: Transform3, *, is_fixed: bool
    ) -> None:
        self.fixed.append(FixedFrame(parent, name, parent_T_frame))
        if is_fixed:
            base_T_parent = self.base_T_frame[parent]
            self.base_T_frame[name] = base_T_parent @ parent_T_frame
