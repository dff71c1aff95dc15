"""Make the gallery's moving pictures: ``python docs/gallery.py [NAME…]``.

Each picture is a run of the whole stack, read back from its bag and drawn frame by
frame. The same seed gives the same picture.
"""

import math
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from canvas import FREE, INK, LASER, QUIET, THREAD, Canvas, Points, View
from picture import beam_ends, planar, rest_of
from PIL import Image

from navette.bags import open_bag
from navette.geometry import Footprint, Pose2
from navette.msgs import deserialize, get_interface
from navette.navigation.stack import RunOptions
from navette.navigation.stack.simulation import Simulation
from navette.runtime.tf import Buffer
from navette.sim import Scene, World

FOLDER = Path(__file__).parent / "gallery"
FRAME_MS = 80
TOPICS = (
    "/tf_static",
    "/tf",
    "/map",
    "/path",
    "/lidar",
    "/ground_truth",
    "/planner/status",
    "/control/status",
)


NEEDED = {"/map", "/lidar", "/ground_truth", "/planner/status"}


@dataclass(frozen=True)
class Run:
    """A picture: what to drive and what to show of it.

    Attributes:
        options: arguments of :class:`RunOptions`.
        view: part of the map to show.
        speed: times real time that the picture plays at.
        world: a world built in Python instead of a built-in one.
    """

    options: dict[str, Any]
    view: View
    speed: float = 5.0
    world: World | None = None


@dataclass
class Moment:
    """The newest message of every topic, and the path driven so far."""

    now_ns: int = 0
    latest: dict[str, Any] = field(default_factory=dict)
    trace: list[tuple[float, float]] = field(default_factory=list)
    frames: Buffer = field(default_factory=Buffer)

    def take(self, topic: str, stamp_ns: int, message: Any) -> None:
        self.now_ns = stamp_ns
        if topic in ("/tf", "/tf_static"):
            for transform in message.transforms:
                if topic == "/tf":
                    self.frames.set_transform(transform, "bag")
                else:
                    self.frames.set_transform_static(transform, "bag")
            return
        self.latest[topic] = message
        if topic == "/ground_truth":
            self.trace.append(planar(message.pose.pose)[:2])

    def status(self, topic: str) -> str:
        return self.latest[topic].message if topic in self.latest else ""


def clutter(seed: int) -> World:
    """A field of posts, as dense as the BARN challenge's medium worlds."""
    rng = np.random.default_rng(seed)
    world = World("clutter").add_walls((15.0, 8.0))
    placed: list[Points] = []
    while len(placed) < 55:
        place = rng.uniform((-5.0, -3.8), (5.0, 3.8))
        if all(math.dist(place, other) > 0.95 for other in placed):
            placed.append(place)
            world.add_cylinder((place[0], place[1]), rng.uniform(0.08, 0.16))
    return world


RUNS = {
    "arena": Run(
        {"robot": "jackal", "goals": ((6.2, -3.4), (8.2, 7.8), (-5.0, 8.3)), "seed": 1},
        View(size=(640, 640), origin=(320, 320), scale=31),
        speed=10,
    ),
    "course": Run(
        {"world": "course", "goals": ((-6, -12), (6, -12), (12, 0))},
        View(size=(640, 640), origin=(320, 320), scale=20.5),
        speed=10,
    ),
    "clutter": Run(
        {"robot": "jackal", "start": Pose2(-6.5, 0.0, 0.0), "goals": ((6.5, 1.0),)},
        View(size=(640, 352), origin=(320, 176), scale=40.5),
        speed=6,
        world=clutter(3),
    ),
    "table": Run(
        {"world": "table", "sensors": ("d435",), "goals": ((4.0, 0.0),)},
        View(size=(640, 448), origin=(320, 224), scale=60),
        speed=4,
    ),
    "corner": Run(
        {
            "world": "course",
            "start": Pose2(-13.2, -13.2, math.radians(-135)),
            "goals": ((-12.0, -9.0),),
        },
        View(size=(480, 480), origin=(726, -216), scale=42),
        speed=2.5,
    ),
}


def record(run: Run, bag: Path) -> tuple[Footprint, str, bool]:
    """Drive, with a bag; returns footprint, map frame and whether all were reached."""
    options = RunOptions(
        **run.options, headless=True, speed=math.inf, record=bag, overwrite=True
    )
    scene: Scene | None = run.world.scene() if run.world else None
    simulation = Simulation(options, scene=scene)
    simulation.run()
    params = simulation.stack.control.params
    succeeded = simulation.summary().succeeded
    simulation.close()
    return Footprint.from_flat(params.footprint_m), params.map_frame, succeeded


def moments(bag: Path, period_ns: int) -> Iterator[Moment]:
    """What the topics had published, once per period."""
    moment, due_ns = Moment(), period_ns
    with open_bag(bag) as reader:
        types = {topic.name: get_interface(topic.type_name) for topic in reader.topics}
        for topic, stamp_ns, data in reader.messages(list(TOPICS)):
            while stamp_ns >= due_ns:
                yield moment
                due_ns += period_ns
            moment.take(topic.name, stamp_ns, deserialize(data, types[topic.name]))
    yield moment


def draw(run: Run, moment: Moment, footprint: Footprint, map_frame: str) -> Image.Image:
    """One frame."""
    canvas, latest = Canvas(run.view, finer=2), moment.latest
    pose = planar(latest["/ground_truth"].pose.pose)
    canvas.paint_map(latest["/map"])
    scan = latest["/lidar"]
    map_T_scan = moment.frames.lookup(map_frame, scan.header.frame_id, 0).to_pose2()
    ends = map_T_scan.apply(beam_ends(scan))
    canvas.polygon(np.vstack([map_T_scan[:2], ends]), LASER, opacity=0.10)
    canvas.dots(ends[np.isfinite(scan.ranges)], LASER, 1.2)
    canvas.line(np.array(moment.trace[::5] + moment.trace[-1:]), THREAD, 2.4)
    path = latest.get("/path")
    if path is not None and path.poses:
        points = np.array([planar(each.pose)[:2] for each in path.poses])
        canvas.dashes(rest_of(points, pose), THREAD, 2.4)
    values = {v.key: v.value for v in latest["/planner/status"].values}
    number = int(values.get("goal_id", 0))
    goals = run.options["goals"]
    for index, goal in enumerate(goals, 1):
        done = index < number or (index == number and values.get("result") == "reached")
        state = "reached" if done else "next" if index == number else "later"
        canvas.goal(goal, str(index), state, radius=10)
    canvas.robot(pose, footprint)
    caption(canvas, moment, run)
    return canvas.finished()


def caption(canvas: Canvas, moment: Moment, run: Run) -> None:
    """Time and the controller's status, on a strip at the lower edge."""
    width, height = canvas.view.size
    strip = [(0, -26), (width, -26), (width, 0), (0, 0)]
    canvas.polygon(canvas.pixels(0, height, strip), FREE)
    seconds = f"{moment.now_ns / 1e9:.0f} s"
    canvas.text((14, height - 13), seconds, 13, INK)
    canvas.text((64, height - 13), moment.status("/control/status"), 13, INK)
    canvas.text((width - 118, height - 13), f"{run.speed:g} times real time", 13, QUIET)


def make(name: str) -> None:
    """Record one run and save its picture."""
    run = RUNS[name]
    with tempfile.TemporaryDirectory() as folder:
        bag = Path(folder) / "run.mcap"
        footprint, map_frame, succeeded = record(run, bag)
        if not succeeded:
            sys.exit(f"{name}: not every goal was reached without contact")
        period_ns = round(FRAME_MS * 1_000_000 * run.speed)
        frames = [
            draw(run, moment, footprint, map_frame)
            for moment in moments(bag, period_ns)
            if {"/map", "/lidar", "/ground_truth", "/planner/status"}
            <= set(moment.latest)
        ]
    path = FOLDER / f"{name}.webp"
    durations = [FRAME_MS] * (len(frames) - 1) + [1500]
    frames[0].save(
        path,
        save_all=True,
        append_images=frames[1:],
        duration=durations,
        loop=0,
        quality=45,
        method=3,
    )
    print(f"{path.name}: {len(frames)} frames, {path.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    for each in sys.argv[1:] or RUNS:
        make(each)
