"""A lidar scan: Navette's ray casting, MuJoCo's ``mj_multiRay`` and ir-sim.

The same sensor at the same place; ir-sim is planar and makes polygons of circles.
"""

import os
import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from harness import Benchmark, optional

from navette.sim import Scene, SimParams, World, load_robot, load_world
from navette.sim.build import compile_scene
from navette.sim.contacts import ContactMonitor
from navette.sim.instant import Instant
from navette.sim.lidar import Lidar
from navette.sim.masks import SEEN, SEEN_SOLID
from navette.sim.robot_state import RobotState
from navette.sim.rolling import RollingTest
from navette.sim.sensors import lidars_of
from navette.sim.shape_table import ShapeTable

os.environ.setdefault("MPLBACKEND", "Agg")
irsim: Any = optional("irsim")

POST_RADIUS_M = 0.15
RANGE_MAX_M = 20.0


def posts(count: int = 100, seed: int = 0) -> np.ndarray:
    """(N, 2) m: posts over 20 m × 20 m, none near the middle."""
    rng = np.random.default_rng(seed)
    found = rng.uniform(-10.0, 10.0, (3 * count, 2))
    return found[np.hypot(*found.T) > 1.5][:count]


def reference_world() -> Scene:
    return load_world("course").with_robot(load_robot("course").model)


def scene_of_posts() -> Scene:
    world = World("posts").add_robot(load_robot("jackal").model)
    for x, y in posts():
        world.add_cylinder((x, y), POST_RADIUS_M)
    return world.scene()


class Sensor:
    """A noise-free lidar with this number of beams on the robot of a scene."""

    def __init__(self, scene: Scene, beams: int) -> None:
        params = SimParams(lidar_noise_m=0.0)
        compiled = compile_scene(scene, timestep_s=0.002)
        self.model, self.data = compiled.model, mujoco.MjData(compiled.model)
        mujoco.mj_kinematics(self.model, self.data)
        own = next(lidars_of(compiled, params))
        sensor = replace(own.sensor, samples=beams, range_max=RANGE_MAX_M)
        self.lidar = Lidar(sensor, own.mount, params, compiled)
        self._shapes = ShapeTable(self.model, (SEEN_SOLID, SEEN))
        state = RobotState(compiled.robot, self.data)
        contacts = ContactMonitor(compiled, RollingTest(compiled, self.data))
        self._now = Instant(self.model, self.data, state, 0, contacts)
        self._rng = np.random.default_rng(0)
        self.angles = np.linspace(sensor.angle_min, sensor.angle_max, beams)

    def with_navette(self) -> np.ndarray:
        return self.lidar.read(self._now, self._rng).ranges

    def with_mujoco(self) -> np.ndarray:
        origin, rotation = self.lidar.mount.world(self.data)
        a = self.angles
        beams = np.stack([np.cos(a), np.sin(a), np.zeros_like(a)], axis=1)
        distance, _ = self._shapes.cast_with_mujoco(
            self.model, self.data, origin, beams @ rotation.T, RANGE_MAX_M
        )
        return np.where(distance <= RANGE_MAX_M, distance, np.inf).astype(np.float32)

    def with_irsim(self) -> Callable[[], np.ndarray]:
        """A planar copy of the posts, from the same position."""
        (x, y, _), _ = self.lidar.mount.world(self.data)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "world.yaml"
            path.write_text(irsim_world(x, y, self.angles))
            env = irsim.make(str(path), disable_all_plot=True, log_level="ERROR")
        state, lidar = env.robot.state, env.robot.lidar

        def scan() -> np.ndarray:
            lidar.step(state)
            return np.asarray(lidar.range_data)

        return scan


def irsim_world(x: float, y: float, angles: np.ndarray) -> str:
    circles = "\n".join(
        f"  - {{shape: {{name: circle, radius: {POST_RADIUS_M}}}, "
        f"state: [{px:.6f}, {py:.6f}, 0]}}"
        for px, py in posts()
    )
    return f"""world: {{height: 24, width: 24, offset: [-12, -12]}}
robot:
  - kinematics: {{name: diff}}
    shape: {{name: circle, radius: 0.2}}
    state: [{x:.6f}, {y:.6f}, 0]
    sensors:
      - {{type: lidar2d, number: {len(angles)}, range_min: 0.0,
         range_max: {RANGE_MAX_M}, angle_range: {angles[-1] - angles[0]:.9f}}}
obstacle:
{circles}
"""


def seen_alike(a: np.ndarray, b: np.ndarray, within_m: float) -> float:
    """Return the share of beams with the same range, or no hit, in both."""
    a, b = np.minimum(a, RANGE_MAX_M), np.minimum(b, RANGE_MAX_M)
    return float((np.abs(a - b) <= within_m).mean())


def main() -> None:
    bench = Benchmark("lidar", __doc__)
    for name, scene, beams, target_ms in (
        ("reference world", reference_world(), 256, 0.1),
        ("100 posts", scene_of_posts(), 256, 0.1),
        ("reference world", reference_world(), 720, 0.28),
        ("100 posts", scene_of_posts(), 720, 0.28),
    ):
        sensor = Sensor(scene, beams)
        ours = sensor.with_navette()
        same = seen_alike(ours, sensor.with_mujoco(), 1e-4)
        assert same == 1.0, same
        contenders = {"navette": sensor.with_navette, "mj_multiRay": sensor.with_mujoco}
        note = "all beams equal mj_multiRay's"
        if irsim is not None and name == "100 posts":
            peer = sensor.with_irsim()
            same = seen_alike(ours, peer(), 0.01)
            assert same > 0.95, same
            contenders["ir-sim"] = peer
            note += f", {100 * same:.1f} % within 1 cm of ir-sim's"
        bench.case(f"{name}, {beams} beams", contenders, note, target_ms=target_ms)
    bench.main()


if __name__ == "__main__":
    main()
