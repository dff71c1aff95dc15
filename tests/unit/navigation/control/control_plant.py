"""A robot for closed-loop tests: unicycle, lagging drive, weak turning."""

import itertools
import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2, wrap_angle
from navette.navigation.control import (
    ControlParams,
    FollowerInputs,
    FollowerOutput,
    PathFollower,
)
from navette.navigation.control.followers import Follower

SUBSTEPS = 10


@dataclass
class Plant:
    """First-order response to commands; turns at ``turning`` of the commanded rate."""

    pose: Pose2
    lag_s: float = 0.12
    turning: float = 0.85
    speed: float = 0.0
    turn_rate: float = 0.0

    def drive(self, speed: float, turn_rate: float, dt: float) -> None:
        step = dt / SUBSTEPS
        for _ in range(SUBSTEPS):
            share = step / self.lag_s
            self.speed += (speed - self.speed) * share
            self.turn_rate += (turn_rate * self.turning - self.turn_rate) * share
            x, y, yaw = self.pose
            self.pose = Pose2(
                x + self.speed * math.cos(yaw) * step,
                y + self.speed * math.sin(yaw) * step,
                wrap_angle(yaw + self.turn_rate * step),
            )


@dataclass
class Run:
    """What happened in a closed loop, a row per tick."""

    outputs: list[FollowerOutput] = field(default_factory=list)
    poses: list[Pose2] = field(default_factory=list)
    speeds: list[float] = field(default_factory=list)
    dt: float = 0.05

    @property
    def time_s(self) -> float:
        return len(self.outputs) * self.dt

    @property
    def final(self) -> FollowerOutput:
        return self.outputs[-1]

    def states(self) -> list[str]:
        """The states in order, repeats dropped."""
        names = [str(o.state) for o in self.outputs]
        return [b for a, b in zip(["", *names], names, strict=False) if a != b]

    def off(self, line: NDArray[np.float64]) -> float:
        """Largest distance (m) of a driven position to a polyline (M, 2)."""
        p = np.array([(q.x, q.y) for q in self.poses])
        a, d = line[:-1], np.diff(line, axis=0)
        t = np.einsum("nmk,mk->nm", p[:, None] - a, d) / np.sum(d * d, axis=1)
        near = a + np.clip(t, 0, 1)[..., None] * d
        return float(np.linalg.norm(p[:, None] - near, axis=2).min(axis=1).max())


def run(follower: Follower, plant: Plant, seconds: float, dt: float = 0.05) -> Run:
    """Close the loop until the follower rests or the time is over."""
    record = Run(dt=dt)
    while record.time_s < seconds:
        inputs = FollowerInputs(plant.pose, plant.speed, plant.turn_rate)
        output = follower.step(inputs, dt)
        plant.drive(output.command.speed, output.command.turn_rate, dt)
        record.outputs.append(output)
        record.poses.append(plant.pose)
        record.speeds.append(plant.speed)
        if output.state.rests:
            break
    return record


def drive_path(
    poses: NDArray[np.float64], params: ControlParams, seconds: float = 60.0
) -> tuple[Run, Plant]:
    """Follow one path from its first pose."""
    plant = Plant(Pose2(*map(float, poses[0])))
    follower = PathFollower(params)
    follower.set_path(poses)
    return run(follower, plant, seconds), plant


def tangent_path(
    points: NDArray[np.float64], *, reverse: bool = False, spacing: float = 0.1
) -> NDArray[np.float64]:
    """Polyline (M, 2) → dense poses (N, 3) that face along (or against) the travel."""
    rows: list[tuple[float, float, float]] = []
    for a, b in itertools.pairwise(points):
        yaw = math.atan2(b[1] - a[1], b[0] - a[0]) + (math.pi if reverse else 0.0)
        count = max(1, math.ceil(math.dist(a, b) / spacing))
        for t in np.arange(count) / count:
            rows.append((*(a + t * (b - a)), yaw))
    rows.append((*points[-1], rows[-1][2]))
    return np.array(rows, np.float64)


def big_robot(**changes: object) -> ControlParams:
    """The course robot: 2 m long, axle at the rear third, cruise 1.5 m/s."""
    values: dict[str, object] = {
        "cruise_speed_mps": 1.5,
        "reverse_speed_mps": 0.5,
        "footprint_m": (
            1.5, 0.5, 0.4, 0.5, 0.4, 0.7, -0.4, 0.7, -0.4, 0.5, -0.5, 0.5,
            -0.5, -0.5, -0.4, -0.5, -0.4, -0.7, 0.4, -0.7, 0.4, -0.5, 1.5, -0.5,
        ),
    }  # fmt: skip
    return ControlParams(**(values | changes))
