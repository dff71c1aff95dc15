# SPDX-License-Identifier: Apache-2.0
"""The simulator: physics, drive and sensors of one robot in one world.

Independent of nodes and topics. Time is integer nanoseconds and advances in whole
physics steps, in batches while nothing changes in between. The result does not depend
on how often sensors are read: commands, limits and checks act at fixed multiples of the
physics step, and sensors do not change the state.
"""

import itertools
import math
from dataclasses import replace
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.geometry import Pose2, Transform3
from navette.sim.actors import Actors
from navette.sim.build import compile_scene
from navette.sim.camera import Camera, Image
from navette.sim.camera_gl import GlCamera
from navette.sim.clearance import Clearance, ClearanceProbe
from navette.sim.contacts import ContactMonitor
from navette.sim.drive import CONTROL_PERIOD_NS, SteeringRamp, make_ramp
from navette.sim.drive_outputs import DriveOutputs
from navette.sim.imu import Imu, ImuReading
from navette.sim.instant import Instant
from navette.sim.lidar import Lidar, Scan
from navette.sim.outlines import outlines_of
from navette.sim.params import SimParams
from navette.sim.robot_state import Motion, RobotState
from navette.sim.rolling import RollingTest
from navette.sim.scene import Scene
from navette.sim.sensor_specs import (
    CameraSensor,
    ImuSensor,
    LidarSensor,
    RingLidarSensor,
    Sensor,
)
from navette.sim.sensors import make_devices
from navette.sim.wheel_odometry import WheelErrors, WheelOdometry

_WATCH_PERIOD_NS = 100_000_000  # clearance is measured at 10 Hz
_TOUCHES_M = 0.01  # a world's own robot may touch obstacles, but not overlap them

_BLOWN_UP = [
    int(mujoco.mjtWarning.mjWARN_BADQPOS),
    int(mujoco.mjtWarning.mjWARN_BADQVEL),
    int(mujoco.mjtWarning.mjWARN_BADQACC),
]


class Simulator:
    """One robot in one world.

    Args:
        scene: the world, with a robot in it.
        params: limits, noise and physics step.
        start: initial pose (x, y, yaw) on the floor; None takes the pose in the scene,
            from which the robot may fall.

    Raises:
        InvalidValueError: the scene has no robot, or it starts in an obstacle.
    """

    def __init__(
        self,
        scene: Scene,
        params: SimParams | None = None,
        *,
        start: Pose2 | None = None,
    ) -> None:
        self.params = params or SimParams()
        self.compiled = compile_scene(scene, timestep_s=self.params.timestep_s)
        self._step_ns = round(self.params.timestep_s * 1e9)
        # Steps from one update of the drive, or check of the state, to the next.
        self._control_steps = max(1, CONTROL_PERIOD_NS // self._step_ns)
        self._watch_steps = max(1, _WATCH_PERIOD_NS // self._step_ns)
        self._data = mujoco.MjData(self.compiled.model)
        self._drive = DriveOutputs(self.compiled.robot, self._data)
        self.actors = Actors(self.compiled)
        self.actors.place(self._data, 0)
        self._start = start
        self._ramp = make_ramp(self.params, self.compiled.robot.drive)
        self.state = RobotState(self.compiled.robot, self._data)
        mujoco.mj_kinematics(self.compiled.model, self._data)
        rolling = RollingTest(self.compiled, self._data)
        self._probe = ClearanceProbe(self.compiled, self._data, rolling)
        self.contacts = ContactMonitor(self.compiled, rolling)
        #: What measures, by the kind of sensor; in the order of the model.
        self.devices = make_devices(self.compiled, self.params)
        self._wheel_odometry = WheelOdometry(
            self.compiled.robot.drive, _wheel_errors(self.params)
        )
        self.reset()

    def reset(self, *, start: Pose2 | None = None, seed: int | None = None) -> None:
        """Reset state, time, noise and records.

        Args:
            start: new initial pose of this and later resets; None keeps the pose.
            seed: new seed of all noise; None keeps the seed.

        Raises:
            InvalidValueError: the robot would start in an obstacle.
        """
        self._start = start or self._start
        if seed is not None:
            self.change_params(replace(self.params, seed=seed))
        mujoco.mj_resetData(self.compiled.model, self._data)
        self.actors.place(self._data, 0)
        self._seed_noise()
        self._steps = 0
        self._fresh_at = -1
        self._free_until = 0  # the step from which contact is possible
        self._ramp.reset()
        self.contacts.reset()
        self.min_clearance = Clearance(math.inf, "")
        if self._start is not None:
            # Slightly above the floor: no contact to resolve yet.
            floor = self._floor(self._start) + 1e-3
            self.state.place(Transform3.from_pose2(self._start, z=floor))
        for imu in self.imus:
            imu.reset(self._imu_rng)
        self._wheel_odometry.draw_scales(self._wheel_rng)
        self._wheel_odometry.reset(
            self.pose().to_pose2(), self.state.wheel_travel(), self.state.wheel_slide()
        )
        self._check_start()

    def _check_start(self) -> None:
        first = self.clearance()
        if first.distance >= (0.0 if self._start is not None else -_TOUCHES_M):
            return
        start = self._start or self.pose().to_pose2()
        whose = (
            "" if self._start is not None else " (from the world; pass another start)"
        )
        raise InvalidValueError(
            f"start ({start.x:g}, {start.y:g}, {math.degrees(start.yaw):g}°){whose}: "
            f"the robot would be {-first.distance:.2f} m inside {first.obstacle!r}"
        )

    def _seed_noise(self) -> None:
        """Create one random stream per sensor, so that readings are independent.

        A further sensor leaves the streams of the others as they are: those of its kind
        come after them.
        """
        own = [kind for kind in self.devices if kind is not ImuSensor]
        count = 2 + sum(len(self.devices[kind]) for kind in own)
        seeds = np.random.SeedSequence(self.params.seed).spawn(count)
        streams = iter(map(np.random.default_rng, seeds))
        self._imu_rng, self._wheel_rng = next(streams), next(streams)
        self._rngs = {
            kind: list(itertools.islice(streams, len(self.devices[kind])))
            for kind in own
        }
        # The IMUs share one, as ever.
        self._rngs[ImuSensor] = [self._imu_rng] * len(self.imus)

    def _floor(self, start: Pose2) -> float:
        """Height of the floor at a pose: the first plane, or a box above it."""
        model, data = self.compiled.model, self._data
        mujoco.mj_kinematics(model, data)
        height: float | None = None
        for geom in np.flatnonzero(self.compiled.is_ground):
            z = float(data.geom_xpos[geom, 2])
            if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_BOX:
                place = np.array([start.x, start.y, z]) - data.geom_xpos[geom]
                away = np.abs(place @ data.geom_xmat[geom].reshape(3, 3))
                half = model.geom_size[geom]
                if away[0] <= half[0] and away[1] <= half[1]:
                    top = z + float(half[2])
                    height = top if height is None else max(height, top)
            elif height is None:
                height = z
        return height or 0.0

    def change_params(self, params: SimParams) -> None:
        """Apply new limits, timeout and lidar noise; other parameters are fixed."""
        self.params = self._ramp.params = params
        for kind in (LidarSensor, RingLidarSensor):
            for lidar in self.devices[kind]:
                lidar.set_noise(params)

    @property
    def now_ns(self) -> int:
        return self._steps * self._step_ns

    def command(self, linear: float, angular: float, side: float = 0.0) -> bool:
        """Set the commanded velocity (m/s, rad/s, m/s); False if it is not finite.

        ``side`` is the speed to the left, for a drive that moves sideways.
        """
        return self._ramp.command(linear, angular, self.now_ns, side=side)

    @property
    def has_steering(self) -> bool:
        """Whether :meth:`steer` is possible."""
        return isinstance(self._ramp, SteeringRamp)

    def steer(self, speed: float, steering: float) -> bool:
        """Set speed (m/s) and steering angle (rad); False if not finite.

        Raises:
            InvalidValueError: the drive is not an Ackermann drive.
        """
        if not isinstance(self._ramp, SteeringRamp):
            raise InvalidValueError("steer: the robot's wheels are not steered")
        return self._ramp.steer(speed, steering, self.now_ns)

    def step(self, count: int = 1) -> None:
        end = self._steps + count
        while self._steps < end:
            if self._steps % self._control_steps == 0:
                self._drive.set(self._ramp.advance(self.now_ns))
            if self._steps % self._watch_steps == 0:
                self._watch()
            until = min(end, self._next_event())
            if self._steps < self._free_until:
                batch = min(until, self._free_until) - self._steps
                mujoco.mj_step(self.compiled.model, self._data, batch)
                self._steps += batch
            else:
                self._step_checking_contacts(until - self._steps)

    def advance_to(self, now_ns: int) -> None:
        """Advance to the last physics step at or before ``now_ns``."""
        count = now_ns // self._step_ns - self._steps
        if count > 0:
            self.step(count)

    def _next_event(self) -> int:
        """Return the step at which the drive or the contact check acts next."""
        control, watch = self._control_steps, self._watch_steps
        next_watch = (self._steps // watch + 1) * watch
        constant_until = self._ramp.constant_until_ns() / self._step_ns
        if constant_until >= next_watch:
            return next_watch
        tick = max(self._steps + 1, math.ceil(constant_until))
        return min(next_watch, -(-tick // control) * control)

    def _step_checking_contacts(self, count: int) -> None:
        """Step singly, so that no short contact is missed."""
        model, data, has_actors = self.compiled.model, self._data, bool(self.actors)
        for _ in range(count):
            if has_actors:
                self.actors.place(data, self.now_ns)
            mujoco.mj_step(model, data)
            self._steps += 1
            if data.ncon:
                self.contacts.observe(data, self.now_ns)

    def _watch(self) -> None:
        """Measure clearance; decide when contact is possible before the next."""
        self._check_physics()
        clearance = self.clearance()
        if clearance.distance < self.min_clearance.distance:
            self.min_clearance = clearance
        self.contacts.observe(self._data, self.now_ns)
        motion = self.motion()
        reach = self._probe.reach
        fastest = math.hypot(*motion.linear) + math.hypot(*motion.angular) * reach
        linear_growth = max(self.params.max_accel_mps2, self.params.max_decel_mps2)
        growth = linear_growth + self.params.max_yaw_accel_radps2 * reach
        fastest += self.actors.fastest_mps + growth * _WATCH_PERIOD_NS * 1e-9
        free_s = (clearance.distance - 0.01) / (1.5 * fastest + 1e-9)
        if self.actors.jump_within(self.now_ns, _WATCH_PERIOD_NS):
            free_s = 0.0
        free_ns = min(max(0.0, free_s * 1e9), _WATCH_PERIOD_NS)
        self._free_until = self._steps + int(free_ns) // self._step_ns

    def _check_physics(self) -> None:
        """Raise if the state diverged; MuJoCo itself would reset it silently."""
        number = self._data.warning.number.tolist()
        if any(number[warning] for warning in _BLOWN_UP):
            raise InvalidValueError(
                "physics became unstable: check for extreme masses, sizes or speeds in "
                f"the robot's model ({self.now_ns / 1e9:.3f} s)"
            )

    def _refresh(self) -> None:
        """Update body and geom poses to the current state."""
        if self._fresh_at != self._steps:
            self.actors.place(self._data, self.now_ns)
            mujoco.mj_kinematics(self.compiled.model, self._data)
            self._fresh_at = self._steps

    def pose(self) -> Transform3:
        """``world_T_base`` of the axle midpoint on the floor."""
        return self.state.pose()

    def motion(self) -> Motion:
        return self.state.motion()

    def link_in_base(self, name: str) -> Transform3:
        self._refresh()
        return self.state.link_in_base(name)

    def clearance(self) -> Clearance:
        """Current distance from the robot's body to the nearest obstacle."""
        self._refresh()
        return self._probe.measure(self._data)

    @property
    def lidars(self) -> tuple[Lidar, ...]:
        """The planar laser scanners."""
        return self.devices[LidarSensor]

    @property
    def imus(self) -> tuple[Imu, ...]:
        """The inertial measurement units."""
        return self.devices[ImuSensor]

    @property
    def cameras(self) -> tuple[Camera | GlCamera, ...]:
        """The colour cameras."""
        return self.devices[CameraSensor]

    def read(self, kind: type[Sensor], index: int = 0) -> Any:
        """Return the reading of a sensor, as its device defines it."""
        self._refresh()
        instant = Instant(
            self.compiled.model, self._data, self.state, self.now_ns, self.contacts
        )
        return self.devices[kind][index].read(instant, self._rngs[kind][index])

    def skip_scan(self, index: int) -> None:
        """Continue as after :meth:`scan`, at the stamp of a scan without readers."""
        self.lidars[index].skip(self._rngs[LidarSensor][index])

    def scan(self, index: int = 0) -> Scan:
        """Return a scan of planar lidar ``index``."""
        scan: Scan = self.read(LidarSensor, index)
        return scan

    def imu(self, index: int = 0) -> ImuReading:
        """Return a reading of IMU ``index``."""
        reading: ImuReading = self.read(ImuSensor, index)
        return reading

    def image(self, index: int = 0) -> Image:
        """Current image (height, width, 3) of camera ``index``."""
        image: Image = self.read(CameraSensor, index)
        return image

    def outlines(self, *, actors: bool = False) -> list[NDArray[np.float64]]:
        """Outlines (N, 2) from above of the actors, or else of the other obstacles."""
        self._refresh()
        return outlines_of(self.compiled, self._data, actors=actors)

    def wheel_odometry(self) -> WheelOdometry:
        """Dead reckoning up to now; starts at the true pose."""
        wheels = self.state.wheel_travel()
        slide = self.state.wheel_slide()
        self._wheel_odometry.update(wheels, self.now_ns, self._wheel_rng, slide=slide)
        return self._wheel_odometry


def _wheel_errors(params: SimParams) -> WheelErrors:
    return WheelErrors(
        params.wheel_stddev_m,
        params.wheel_scale_error,
        params.wheel_slip_interval_m,
        params.wheel_slip_m,
    )
