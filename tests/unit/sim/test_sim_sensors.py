"""Depth camera, lidars, sonar, bumper, GNSS: measurements, noise, surfaces."""

import math
from pathlib import Path

import numpy as np
import pytest

from navette.errors import FileFormatError, ParameterError, UnknownNameError
from navette.geometry import Pose2, Transform3, quaternion_from_rpy
from navette.geometry.geodesy import GeoPoint, LocalPlane
from navette.sim import Scene, SimParams, Simulator, World, load_robot, load_world
from navette.sim.depth_camera import points_of_depths
from navette.sim.mounting import mount_of, mounts_of, with_sensors
from navette.sim.ring_lidar import level_scan
from navette.sim.scene import GeoOrigin
from navette.sim.sensor_catalogue import BUMPER_SECTORS, CATALOGUE
from navette.sim.sensor_specs import (
    CameraSensor,
    ContactSensor,
    DepthCameraSensor,
    GnssSensor,
    LidarSensor,
    RingLidarSensor,
    Sensor,
    SonarSensor,
)
from navette.sim.sensor_topics import topics_of
from navette.sim.surface import BLACK, GLASS, Surface

HERE = Pose2(0.0, 0.0, 0.0)


def simulator(
    world: World | Scene, *sensors: str, start: Pose2 = HERE, seed: int = 0
) -> Simulator:
    """A Jackal with sensors of the catalogue."""
    model = with_sensors(load_robot("jackal").model, map(mount_of, sensors))
    scene = world if isinstance(world, Scene) else world.scene()
    params = SimParams(seed=seed, lidar_noise_m=-1.0)
    return Simulator(scene.with_robot(model), params, start=start)


def sensor_of(sim: Simulator, kind: type[Sensor]) -> Sensor:
    sensor: Sensor = sim.devices[kind][0].sensor
    return sensor


def place(sim: Simulator, kind: type[Sensor], index: int = 0) -> np.ndarray:
    """Position of a sensor in the world."""
    sim.clearance()
    return sim.devices[kind][index].mount.world(sim._data)[0]


# Depth camera


def test_depth_is_along_the_optical_axis_of_a_wall_and_the_floor() -> None:
    sim = simulator(World().add_box((3.0, 0.0), (0.2, 10.0), height=3.0), "d435")
    sensor = sensor_of(sim, DepthCameraSensor)
    depths = sim.read(DepthCameraSensor).depths
    points = points_of_depths(depths, sensor)
    position, rotation = sim.devices[DepthCameraSensor][0].mount.world(sim._data)
    # From the optical frame (z ahead, x right, y down) to the sensor's, to the world.
    body = np.stack([points[..., 2], -points[..., 0], -points[..., 1]], axis=-1)
    world = body @ rotation.T + position
    seen = np.isfinite(depths)
    assert seen.mean() > 0.95
    on_floor = np.abs(world[..., 2]) < 0.1
    on_wall = np.abs(world[..., 0] - 2.9) < 0.15
    assert (on_floor | on_wall)[seen].mean() > 0.99
    assert on_floor[seen].any()
    assert on_wall[seen].any()


def test_depth_noise_grows_with_the_square_of_the_distance() -> None:
    stddevs = {}
    for distance in (1.5, 3.0, 6.0):
        wall = World().add_box((distance + 1.0, 0.0), (2.0, 20.0), height=8.0)
        sim = simulator(wall, "d435")
        row = np.stack([sim.read(DepthCameraSensor).depths[10] for _ in range(60)])
        stddevs[row[:, 106].mean()] = row.std(axis=0).mean()
    for depth, stddev in stddevs.items():
        assert stddev == pytest.approx(0.08 / (447 * 0.05) * depth**2, rel=0.1)


def test_depths_out_of_range_are_infinite() -> None:
    near = simulator(World().add_box((0.55, 0.0), (0.2, 4.0), height=3.0), "d435")
    depths = near.read(DepthCameraSensor).depths
    assert np.isneginf(depths).any()
    far = simulator(World(), "d435").read(DepthCameraSensor).depths
    assert np.isposinf(far[0]).all()
    points = points_of_depths(far, sensor_of(near, DepthCameraSensor))
    assert np.isnan(points[0]).all()


# Lidar with rings


def test_rings_hit_the_floor_where_their_elevation_points() -> None:
    sim = simulator(World(), "os1_32")
    scan = sim.read(RingLidarSensor)
    height = place(sim, RingLidarSensor)[2]
    elevations = np.linspace(math.radians(-22.5), math.radians(22.5), 32)
    for ring in range(12):
        expected = height / -math.sin(elevations[ring])
        assert scan.ranges[ring].mean() == pytest.approx(expected, rel=0.05)
    assert np.isposinf(scan.ranges[20:]).all()
    assert np.all(scan.intensities[np.isposinf(scan.ranges)] == 0.0)
    assert np.nanmax(np.abs(scan.points[:12, :, 2] + height)) < 0.3


def test_the_level_ring_is_a_planar_scan() -> None:
    sim = simulator(World().add_walls((8.0, 8.0), height=2.0), "vlp16")
    sensor = sensor_of(sim, RingLidarSensor)
    assert isinstance(sensor, RingLidarSensor)
    scan = level_scan(sim.read(RingLidarSensor), sensor)
    ahead = scan.ranges[900]
    assert ahead == pytest.approx(4.0 - place(sim, RingLidarSensor)[0], abs=0.1)
    assert len(scan.ranges) == 1800


# Sonar


def test_a_sonar_measures_the_nearest_surface_within_its_cone() -> None:
    free = simulator(World(), "hc_sr04").read(SonarSensor)
    assert math.isinf(free.range)
    assert free.range > 0
    # A thin post 5° aside is within the cone of ±7.5°; at 12° it is not.
    for bearing_deg, is_seen in ((5.0, True), (12.0, False)):
        sim = simulator(World(), "hc_sr04")
        x, y, _ = place(sim, SonarSensor)
        at = math.radians(bearing_deg)
        post = World().add_cylinder(
            (x + 2.0 * math.cos(at), y + 2.0 * math.sin(at)), 0.02
        )
        echo = simulator(post, "hc_sr04").read(SonarSensor)
        assert math.isfinite(echo.range) == is_seen
        if is_seen:
            assert echo.range == pytest.approx(1.98, abs=0.02)
    # An oblique wall reflects the sound away.
    oblique = World().add_box((2.0, 0.0), (0.1, 4.0), yaw=math.radians(60.0))
    assert math.isinf(simulator(oblique, "hc_sr04").read(SonarSensor).range)
    near = simulator(World().add_box((0.32, 0.0), (0.1, 1.0)), "hc_sr04")
    assert near.read(SonarSensor).range < 0.3


# Bumper


def bumped(start: Pose2, speed: float) -> tuple[Simulator, list[str]]:
    """Drive against a wall; return the frames of the bumpers that are pressed."""
    sim = simulator(World().add_box((1.0, 0.0), (0.2, 6.0)), "bumper", start=start)
    for _ in range(300):
        sim.command(speed, 0.0)
        sim.advance_to(sim.now_ns + 10_000_000)
    pressed = [
        bumper.sensor.frame
        for index, bumper in enumerate(sim.devices[ContactSensor])
        if sim.read(ContactSensor, index).is_pressed
    ]
    return sim, pressed


def test_a_bumper_is_pressed_on_the_side_of_the_contact() -> None:
    _, ahead = bumped(HERE, 0.5)
    assert ahead
    assert set(ahead) <= {"bump_front_left", "bump_front_center", "bump_front_right"}
    sim, behind = bumped(Pose2(0.0, 0.0, math.pi), -0.5)
    assert behind == ["bump_rear"]
    assert sim.contacts.count > 0
    free = simulator(World(), "bumper")
    free.advance_to(10**9)
    assert len(free.devices[ContactSensor]) == len(BUMPER_SECTORS)
    for index in range(len(BUMPER_SECTORS)):
        assert not free.read(ContactSensor, index).is_pressed


def test_a_bumper_is_released_after_backing_off() -> None:
    sim, pressed = bumped(HERE, 0.5)
    assert pressed
    for _ in range(100):
        sim.command(-0.3, 0.0)
        sim.advance_to(sim.now_ns + 10_000_000)
    for index in range(len(BUMPER_SECTORS)):
        assert not sim.read(ContactSensor, index).is_pressed


# GNSS


def test_a_fix_is_the_position_on_the_earth_with_the_noise_of_the_data_sheet() -> None:
    origin = GeoOrigin(47.0, 8.0, 400.0, heading_deg=90.0)
    flat = World().scene()
    scene = Scene(name="e", models=flat.models, origin=origin)
    sim = simulator(scene, "neo_m8n", start=Pose2(30.0, 0.0, 0.0))
    plane = LocalPlane(GeoPoint(47.0, 8.0))
    fixes = [sim.read(GnssSensor, 1).point for _ in range(400)]  # 0: the Jackal's
    places = np.array([plane.east_north(each) for each in fixes])
    antenna = place(sim, GnssSensor, 1)
    # The world's x axis points 90° from east: north.
    assert places.mean(axis=0) == pytest.approx((-antenna[1], antenna[0]), abs=0.4)
    away = np.linalg.norm(places - places.mean(axis=0), axis=1)
    assert np.median(away) == pytest.approx(2.5, rel=0.1)  # CEP
    heights = [each.altitude_m for each in fixes]
    assert np.mean(heights) == pytest.approx(400.0 + antenna[2], abs=0.6)


# Surfaces


def wall(surface: Surface | None, x: float = 4.0) -> World:
    """A wall ahead with another one behind it."""
    world = World().add_box((x, 0.0), (0.1, 30.0), height=2.0, surface=surface)
    return world.add_box((x + 4.0, 0.0), (0.1, 60.0), height=2.0)


def scan_of(world: World) -> tuple[np.ndarray, np.ndarray]:
    """Bearings and ranges of a scan ahead, without noise."""
    scene = world.scene().with_robot(load_robot("jackal").model)
    scan = Simulator(scene, SimParams(lidar_noise_m=0.0), start=HERE).scan()
    angles = scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges))
    ahead = np.abs(angles) < 0.6
    return angles[ahead], scan.ranges[ahead]


def test_glass_returns_beams_near_its_normal_only() -> None:
    angles, plain = scan_of(wall(None))
    _, glass = scan_of(wall(GLASS))
    _, behind = scan_of(World().add_box((8.0, 0.0), (0.1, 60.0), height=2.0))
    near_normal = np.abs(angles) <= math.radians(5.0)
    np.testing.assert_allclose(glass[near_normal], plain[near_normal], rtol=1e-6)
    np.testing.assert_allclose(glass[~near_normal], behind[~near_normal], rtol=1e-6)


def test_a_black_surface_is_seen_from_near_only() -> None:
    reach = 30.0 * math.sqrt(0.02 / 0.9)  # the range of the Jackal's scanner: 4.5 m
    for x, is_seen in ((3.0, True), (6.0, False)):
        angles, ranges = scan_of(wall(BLACK, x))
        middle = ranges[np.argmin(np.abs(angles))]
        assert np.isfinite(middle) == is_seen, (x, reach, middle)
        if not is_seen:
            assert np.isposinf(middle)  # no echo, and nothing behind is seen


def test_worlds_with_plain_surfaces_give_the_same_scans() -> None:
    _, plain = scan_of(wall(None))
    _, named = scan_of(wall(Surface()))
    assert np.array_equal(plain, named)


def test_surfaces_of_a_world_file(tmp_path: Path) -> None:
    file = tmp_path / "glass.sdf"
    box = "<geometry><box><size>0.1 4 2</size></box></geometry>"
    file.write_text(
        f"""<sdf version='1.9' xmlns:navette='n'><world name='w'>
        <model name='pane'><static>true</static><pose>3 0 1 0 0 0</pose><link name='l'>
        <collision name='c'>{box}</collision>
        <visual name='v'>{box}<navette:optics>glass</navette:optics></visual></link>
        </model><model name='dark'><static>true</static><pose>0 3 1 0 0 0</pose>
        <link name='l'><collision name='c'>{box}
        <navette:optics reflectivity='0.1' specular_deg='8'/></collision></link>
        </model></world></sdf>""",
        encoding="utf-8",
    )
    pane, dark = load_world(file).models[:2]
    assert pane.links[0].geometries[0].surface == GLASS
    surface = dark.links[0].geometries[0].surface
    assert surface == Surface(reflectivity=0.1, specular_rad=math.radians(8.0))
    bad = file.read_text(encoding="utf-8").replace(">glass<", ">chrome<")
    file.write_text(bad, encoding="utf-8")
    with pytest.raises(FileFormatError, match=r"'chrome'.*glass"):
        load_world(file)


# Mounting and files


def test_every_sensor_of_the_catalogue_is_mounted_outside_the_floor() -> None:
    sim = simulator(World(), *CATALOGUE)
    for kind, devices in sim.devices.items():
        for device in devices:
            if kind is not CameraSensor:
                position, _ = device.mount.world(sim._data)
                assert position[2] > 0.05


def test_sensors_of_a_robot_file(tmp_path: Path) -> None:
    file = tmp_path / "cart.yaml"
    file.write_text(
        """
        length_m: 0.6
        sensors:
          d435: {pitch_deg: 30, z_m: 0.5}
          left_sonar: {type: hc_sr04, place: left}
          right_sonar: {type: hc_sr04, place: right, topic: /sonar_right}
          rear_lidar: {type: urg04lx, place: rear, frame: rear_laser}
          bumper: bumper
        """,
        encoding="utf-8",
    )
    model = load_robot(file).model
    names = {topic.name for topic in topics_of(model)}
    assert names == {
        *("/lidar", "/lidar/rear_lidar", "/sonar", "/sonar_right"),
        *("/depth/image", "/depth/camera_info", "/depth/points"),
    }
    scene = World().scene().with_robot(model)
    sim = Simulator(scene, start=HERE)
    sim.clearance()
    position, rotation = sim.devices[SonarSensor][0].mount.world(sim._data)
    assert position[1] > 0.15
    assert rotation[:, 0] == pytest.approx((0.0, 1.0, 0.0), abs=1e-6)
    position, rotation = sim.devices[DepthCameraSensor][0].mount.world(sim._data)
    assert position[2] == pytest.approx(0.5, abs=0.01)
    assert rotation[2, 0] == pytest.approx(-0.5, abs=1e-3)  # 30° downward
    rear = sim.devices[LidarSensor][1].mount.world(sim._data)
    assert rear[0][0] < -0.2


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("{camera9000: {}}", "camera9000"),
        ("{d435: {place: below}}", "below"),
        ("{d435: {heigth: 2}}", "heigth"),
        ("{d435: {z_m: high}}", "'high'"),
        ("{d435: 3}", "3"),
        ("{a: {type: d435, rate_hz: -1}}", "-1"),
        ("[d435]", "sensors"),
    ],
)
def test_invalid_sensors_are_named(tmp_path: Path, text: str, reason: str) -> None:
    file = tmp_path / "cart.yaml"
    file.write_text(f"sensors: {text}\n", encoding="utf-8")
    with pytest.raises(FileFormatError, match=reason):
        load_robot(file)


def test_names_of_sensors_on_the_command_line() -> None:
    assert mount_of("hc_sr04@left")[0] == "hc_sr04_left"
    with pytest.raises(UnknownNameError, match="d435"):
        mount_of("kinect")
    with pytest.raises(UnknownNameError, match="rear"):
        mount_of("d435@below")
    model = load_robot("jackal").model
    with pytest.raises(ParameterError, match="d435"):
        with_sensors(model, [mount_of("d435"), mount_of("d435")])
    assert mounts_of({"d435": "d435"})["d435"].type == "d435"


def test_sdf_sensors_of_all_kinds(tmp_path: Path) -> None:
    text = (load_robot_file("jackal")).replace(
        "<sensor ",
        """<sensor name='rings' type='gpu_lidar'><lidar><scan>
         <horizontal><samples>90</samples><min_angle>-3</min_angle>
          <max_angle>3</max_angle></horizontal>
         <vertical><samples>8</samples><min_angle>-0.2</min_angle>
          <max_angle>0.3</max_angle></vertical></scan>
         <range><min>0.2</min><max>50</max></range></lidar></sensor>
        <sensor name='eye' type='rgbd_camera'><camera name='c'>
         <horizontal_fov>1.2</horizontal_fov>
         <image><width>64</width><height>48</height></image>
         <clip><near>0.3</near><far>8</far></clip>
         <navette:noise_per_m>0.002</navette:noise_per_m></camera></sensor>
        <sensor name='sonar' type='sonar'><sonar><min>0.1</min><max>3</max>
         <radius>0.5</radius></sonar></sensor>
        <sensor name='gps' type='navsat'><navsat><position_sensing><horizontal>
         <noise type='gaussian'><stddev>1.5</stddev></noise></horizontal>
         </position_sensing></navsat></sensor>
        <sensor name='bump' type='contact'>
         <navette:bearings>-0.5 0.5</navette:bearings></sensor>
        <sensor """,
        1,
    )
    file = tmp_path / "robot.sdf"
    file.write_text(
        text.replace("<sdf ", "<sdf xmlns:navette='n' ", 1), encoding="utf-8"
    )
    model = load_robot(file).model
    sensors = [s for link in model.links for s in link.sensors]
    found = {type(s): s for s in reversed(sensors)}  # the first of each kind
    rings = found[RingLidarSensor]
    assert isinstance(rings, RingLidarSensor)
    assert (rings.rings, rings.elevation_min, rings.elevation_max) == (8, -0.2, 0.3)
    depth = found[DepthCameraSensor]
    assert isinstance(depth, DepthCameraSensor)
    assert (depth.width, depth.near, depth.noise_per_m) == (64, 0.3, 0.002)
    sonar = found[SonarSensor]
    assert isinstance(sonar, SonarSensor)
    assert sonar.half_angle == pytest.approx(math.atan2(0.5, 3.0))
    gnss = found[GnssSensor]
    assert isinstance(gnss, GnssSensor)
    assert gnss.horizontal_stddev == 1.5
    bumper = found[ContactSensor]
    assert isinstance(bumper, ContactSensor)
    assert bumper.bearings == (-0.5, 0.5)


def load_robot_file(name: str) -> str:
    """Return the text of a built-in robot's model."""
    from navette.sim import library

    path = Path(library.__file__).parent / "data" / "robots" / name / "model.sdf"
    return path.read_text(encoding="utf-8")


# Determinism


def test_the_same_seed_gives_the_same_measurements() -> None:
    def measured(seed: int, *sensors: str) -> list[bytes]:
        sim = simulator(World().add_walls((6.0, 6.0)), *sensors, seed=seed)
        sim.advance_to(200_000_000)
        found = [sim.scan().ranges.tobytes()]
        if "d435" in sensors:
            found.append(sim.read(DepthCameraSensor).depths.tobytes())
            found.append(sim.read(RingLidarSensor).ranges.tobytes())
            found.append(repr(sim.read(SonarSensor)).encode())
            found.append(repr(sim.read(GnssSensor)).encode())
        return found

    kinds = ("d435", "vlp16", "hc_sr04", "neo_m8n")
    assert measured(3, *kinds) == measured(3, *kinds)
    others = zip(measured(3, *kinds)[1:], measured(4, *kinds)[1:], strict=True)
    assert all(a != b for a, b in others)
    # Further sensors leave the noise of the robot's own as it is.
    assert measured(3)[0] == measured(3, *kinds)[0]


def test_a_sensor_is_at_its_pose_also_on_a_tilted_mount() -> None:
    mounts = mounts_of({"d435": {"x_m": 0.1, "y_m": 0.2, "z_m": 0.6, "roll_deg": 10}})
    model = with_sensors(load_robot("jackal").model, mounts.items())
    sim = Simulator(World().scene().with_robot(model), start=Pose2(1.0, 2.0, 0.5))
    sim.clearance()
    position, rotation = sim.devices[DepthCameraSensor][0].mount.world(sim._data)
    base = sim.pose()
    turn = quaternion_from_rpy(math.radians(10), math.radians(20), 0.0)
    expected = base @ Transform3((0.1, 0.2, 0.6), turn)
    assert position == pytest.approx(expected.translation, abs=1e-6)
    ahead = np.subtract(expected.apply((1.0, 0.0, 0.0)), expected.translation)
    assert rotation[:, 0] == pytest.approx(ahead, abs=1e-6)
