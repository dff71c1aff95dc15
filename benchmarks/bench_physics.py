"""A physics step of 2 ms: a differential drive among 100 static posts.

Navette drives its TurtleBot (two wheels and a caster) at 0.2 m/s with contacts
watched and clearance measured; beside it MuJoCo's bare ``mj_step`` on the same model
and a robot of the same size in PyBullet.
"""

from collections.abc import Callable
from typing import Any

import mujoco
import numpy as np
from bench_lidar import POST_RADIUS_M, posts
from harness import Benchmark, optional

from navette.geometry import Pose2
from navette.sim import Scene, SimParams, Simulator, World, load_robot

pybullet: Any = optional("pybullet")

STEPS = 2000
TIMESTEP_S = 0.002
SPEED_MPS = 0.2
WHEEL_RADIUS_M = 0.033
TARGET_MS = 1e3 / 90e3


def scene() -> Scene:
    world = World("posts").add_robot(load_robot("turtlebot3_burger").model)
    for x, y in posts():
        world.add_cylinder((x, y), POST_RADIUS_M)
    return world.scene()


def navette_steps() -> tuple[Callable[[], object], Callable[[], object]]:
    """Navette's simulator; and MuJoCo alone on a copy of its model."""
    params = SimParams(timestep_s=TIMESTEP_S)
    simulator = Simulator(scene(), params, start=Pose2(0.0, 0.0, 0.0))
    drive(simulator, 1.0)
    before = simulator.pose().translation[0]
    drive(simulator, 2.0)
    gone = simulator.pose().translation[0] - before
    assert abs(gone - 2.0 * SPEED_MPS) < 0.02, gone

    model = simulator.compiled.model
    data = mujoco.MjData(model)
    data.qpos[2] += 0.001
    data.ctrl[:] = SPEED_MPS / WHEEL_RADIUS_M
    start = data.qpos.copy()

    def bare() -> None:
        data.qpos[:] = start
        mujoco.mj_step(model, data, STEPS)

    def ours() -> None:
        simulator.reset()
        drive(simulator, STEPS * TIMESTEP_S)

    return ours, bare


def drive(simulator: Simulator, seconds: float) -> None:
    """Drive straight ahead with a command every 100 ms, as from a controller."""
    for _ in range(round(seconds / 0.1)):
        simulator.command(SPEED_MPS, 0.0)
        simulator.step(round(0.1 / TIMESTEP_S))


def pybullet_steps() -> Callable[[], object]:
    p = pybullet
    p.connect(p.DIRECT)
    p.setGravity(0, 0, -9.81)
    p.setTimeStep(TIMESTEP_S)
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
    post = p.createCollisionShape(p.GEOM_CYLINDER, radius=POST_RADIUS_M, height=1.0)
    for x, y in posts():
        p.createMultiBody(0, post, basePosition=(x, y, 0.5))
    robot = pybullet_robot()

    def run(steps: int = STEPS) -> None:
        p.resetBasePositionAndOrientation(robot, (0, 0, 0.034), (0, 0, 0, 1))
        for wheel in (0, 1):
            p.setJointMotorControl2(
                robot, wheel, p.VELOCITY_CONTROL, force=1.0,
                targetVelocity=SPEED_MPS / WHEEL_RADIUS_M,
            )  # fmt: skip
        for _ in range(steps):
            p.stepSimulation()

    run()
    gone = p.getBasePositionAndOrientation(robot)[0][0]
    assert abs(gone - STEPS * TIMESTEP_S * SPEED_MPS) < 0.1, gone
    return run


def pybullet_robot() -> int:
    """Two wheels, a body and a sliding ball, as on the TurtleBot."""
    p = pybullet
    wheel = p.createCollisionShape(p.GEOM_CYLINDER, radius=WHEEL_RADIUS_M, height=0.018)
    ball = p.createCollisionShape(p.GEOM_SPHERE, radius=0.008)
    upright = p.getQuaternionFromEuler((-np.pi / 2, 0.0, 0.0))
    robot: int = p.createMultiBody(
        0.9,
        p.createCollisionShape(p.GEOM_BOX, halfExtents=(0.06, 0.06, 0.05)),
        basePosition=(0.0, 0.0, 0.034),
        baseInertialFramePosition=(-0.03, 0.0, 0.03),
        linkMasses=[0.03, 0.03, 0.005],
        linkCollisionShapeIndices=[wheel, wheel, ball],
        linkVisualShapeIndices=[-1, -1, -1],
        linkPositions=[(0.03, 0.08, -0.03), (0.03, -0.08, -0.03), (-0.05, 0, -0.055)],
        linkOrientations=[upright, upright, (0, 0, 0, 1)],
        linkInertialFramePositions=[(0, 0, 0)] * 3,
        linkInertialFrameOrientations=[(0, 0, 0, 1)] * 3,
        linkParentIndices=[0, 0, 0],
        linkJointTypes=[p.JOINT_REVOLUTE, p.JOINT_REVOLUTE, p.JOINT_FIXED],
        linkJointAxis=[(0, 0, 1), (0, 0, 1), (0, 0, 1)],
    )
    p.changeDynamics(robot, 2, lateralFriction=0.0)
    return robot


def main() -> None:
    bench = Benchmark("physics", __doc__, budget_s=2.0)
    ours, bare = navette_steps()
    contenders = {"navette": ours, "mj_step alone": bare}
    if pybullet is not None:
        contenders["pybullet"] = pybullet_steps()
    bench.case(
        "a step of 2 ms",
        contenders,
        "all drive the commanded distance; the target is 90 000 steps a second",
        target_ms=TARGET_MS,
        per_run=STEPS,
    )
    bench.main()


if __name__ == "__main__":
    main()
