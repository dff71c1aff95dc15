"""Robot and world files that exhaust memory or time: valid, but too large.

Each function writes one file and returns its path; ``HOSTILE`` lists them.
"""

from collections.abc import Callable
from pathlib import Path

_BOX = "<box><size>0.1 0.1 0.1</size></box>"
_DRIVE = (
    '<plugin name="diff" filename="libgazebo_ros_diff_drive.so">'
    "<left_joint>left</left_joint><right_joint>right</right_joint>"
    "<wheel_separation>0.4</wheel_separation><wheel_diameter>0.2</wheel_diameter>"
    "</plugin>"
)


def sdf_world_with_many_models(folder: Path, count: int = 20_000) -> Path:
    models = "".join(
        f'<model name="m{i}"><static>true</static><pose>{i % 200} {i // 200} 0 0 0 0'
        f'</pose><link name="l"><collision name="c"><geometry>{_BOX}</geometry>'
        "</collision></link></model>"
        for i in range(count)
    )
    return _write(
        folder / "models.sdf",
        f'<sdf version="1.8"><world name="w">{models}</world></sdf>',
    )


def sdf_robot_with_many_bodies(folder: Path, count: int = 20_000) -> Path:
    links = "".join(
        f'<link name="l{i}"><pose>{i * 0.001} 0 0.2 0 0 0</pose>'
        f'<collision name="c"><geometry>{_BOX}</geometry></collision></link>'
        f'<joint name="j{i}" type="revolute"><parent>base</parent><child>l{i}</child>'
        "<axis><xyz>0 0 1</xyz></axis></joint>"
        for i in range(count)
    )
    return _write(
        folder / "bodies.sdf",
        f'<sdf version="1.8"><model name="r">{_sdf_base()}{links}{_DRIVE}'
        "</model></sdf>",
    )


def urdf_robot_with_many_bodies(folder: Path, count: int = 20_000) -> Path:
    links = "".join(
        f'<link name="l{i}"><collision><geometry><sphere radius="0.1"/></geometry>'
        f'</collision></link><joint name="j{i}" type="fixed"><parent link="base"/>'
        f'<child link="l{i}"/><origin xyz="{i * 0.001} 0 0.3"/></joint>'
        for i in range(count)
    )
    return _write(
        folder / "bodies.urdf",
        f'<robot name="r">{_urdf_base()}{links}<gazebo>{_DRIVE}</gazebo></robot>',
    )


def urdf_robot_with_a_long_chain(folder: Path, count: int = 20_000) -> Path:
    links = "".join(
        f'<link name="l{i}"/><joint name="j{i}" type="continuous"><parent link='
        f'"{f"l{i - 1}" if i else "base"}"/><child link="l{i}"/></joint>'
        for i in range(count)
    )
    return _write(
        folder / "chain.urdf",
        f'<robot name="r">{_urdf_base()}{links}<gazebo>{_DRIVE}</gazebo></robot>',
    )


def mjcf_world_with_many_bodies(folder: Path, count: int = 20_000) -> Path:
    bodies = "".join(
        f'<body pos="{i % 200} {i // 200} 1"><freejoint/><geom size=".1"/></body>'
        for i in range(count)
    )
    return _write(
        folder / "bodies.xml",
        f"<mujoco><worldbody>{bodies}</worldbody></mujoco>",
    )


def mjcf_world_with_replicas(folder: Path) -> Path:
    inner = '<geom size=".1"/>'
    for _ in range(4):
        inner = f'<replicate count="200" offset="1 0 0">{inner}</replicate>'
    return _write(
        folder / "replicas.xml",
        f"<mujoco><worldbody>{inner}</worldbody></mujoco>",
    )


def mjcf_world_with_a_large_grid(folder: Path) -> Path:
    return _write(
        folder / "grid.xml",
        "<mujoco><worldbody><body><composite type='grid' count='3000 3000 1' "
        "spacing='.1' offset='0 0 1'><geom size='.02'/></composite></body>"
        "</worldbody></mujoco>",
    )


def mjcf_world_with_a_large_height_field(folder: Path) -> Path:
    return _write(
        folder / "height.xml",
        "<mujoco><asset><hfield name='h' nrow='60000' ncol='60000' size='1 1 1 1'/>"
        "</asset><worldbody><geom type='hfield' hfield='h'/></worldbody></mujoco>",
    )


def mjcf_world_with_a_large_texture(folder: Path) -> Path:
    return _write(
        folder / "texture.xml",
        "<mujoco><asset><texture name='t' type='2d' builtin='flat' width='60000' "
        "height='60000'/></asset><worldbody><geom size='.1'/></worldbody></mujoco>",
    )


def mjcf_world_with_large_memory(folder: Path) -> Path:
    return _write(
        folder / "memory.xml",
        "<mujoco><size memory='200G'/><worldbody><geom size='.1'/></worldbody>"
        "</mujoco>",
    )


def sdf_robot_with_a_dense_lidar(folder: Path) -> Path:
    return _robot_with(folder / "lidar.sdf", _lidar(rate_hz="10", beams=100_000_000))


def sdf_robot_with_a_fast_lidar(folder: Path) -> Path:
    return _robot_with(folder / "fast.sdf", _lidar(rate_hz="1e12", beams=10))


def _lidar(rate_hz: str, beams: int) -> str:
    return (
        f'<sensor name="s" type="ray"><update_rate>{rate_hz}</update_rate><ray><scan>'
        f"<horizontal><samples>{beams}</samples><min_angle>-3</min_angle>"
        "<max_angle>3</max_angle></horizontal></scan><range><min>0.1</min><max>10</max>"
        "</range></ray></sensor>"
    )


def sdf_robot_with_a_large_camera(folder: Path) -> Path:
    sensor = (
        '<sensor name="s" type="camera"><update_rate>30</update_rate><camera>'
        "<horizontal_fov>1</horizontal_fov><image><width>2000000</width>"
        "<height>2000000</height></image></camera></sensor>"
    )
    return _robot_with(folder / "camera.sdf", sensor)


def sdf_robot_with_many_sensors(folder: Path) -> Path:
    sensors = "".join(
        f'<sensor name="s{i}" type="imu"><update_rate>100</update_rate></sensor>'
        for i in range(20_000)
    )
    return _robot_with(folder / "sensors.sdf", sensors)


def map_with_a_large_image(folder: Path) -> Path:
    (folder / "map.pgm").write_bytes(b"P5\n100000 100000\n255\n")
    return _write(
        folder / "map.yaml",
        "image: map.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\n"
        "occupied_thresh: 0.65\nfree_thresh: 0.2\n",
    )


def _robot_with(path: Path, sensors: str) -> Path:
    return _write(
        path,
        f'<sdf version="1.8"><model name="r">{_sdf_base(sensors)}{_DRIVE}'
        "</model></sdf>",
    )


def _sdf_base(sensors: str = "") -> str:
    wheels = "".join(
        f'<link name="{side}_wheel"><pose>0 {y} 0.1 -1.5708 0 0</pose><inertial><mass>1'
        '</mass></inertial><collision name="c"><geometry><cylinder><radius>0.1</radius>'
        f"<length>0.05</length></cylinder></geometry></collision></link>"
        f'<joint name="{side}" type="revolute"><parent>base</parent><child>{side}_wheel'
        "</child><axis><xyz>0 0 1</xyz></axis></joint>"
        for side, y in (("left", 0.2), ("right", -0.2))
    )
    return (
        f'<link name="base"><pose>0 0 0.1 0 0 0</pose><inertial><mass>10</mass>'
        f'</inertial><collision name="c"><geometry>{_BOX}</geometry></collision>'
        f"{sensors}</link>{wheels}"
    )


def _urdf_base() -> str:
    mass = (
        '<inertial><mass value="1"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" '
        'iyz="0" izz="0.1"/></inertial>'
    )
    wheels = "".join(
        f'<link name="{side}_wheel">{mass}<collision><geometry><cylinder radius="0.1" '
        f'length="0.05"/></geometry></collision></link><joint name="{side}" '
        f'type="continuous"><parent link="base"/><child link="{side}_wheel"/><origin '
        f'xyz="0 {y} 0" rpy="-1.5708 0 0"/><axis xyz="0 0 1"/></joint>'
        for side, y in (("left", 0.2), ("right", -0.2))
    )
    body = '<collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>'
    return f'<link name="base">{mass}{body}</link>{wheels}'


def _write(path: Path, text: str) -> Path:
    path.write_text(text, encoding="utf-8")
    return path


WORLDS: tuple[Callable[[Path], Path], ...] = (
    sdf_world_with_many_models,
    mjcf_world_with_many_bodies,
    mjcf_world_with_replicas,
    mjcf_world_with_a_large_grid,
    mjcf_world_with_a_large_height_field,
    mjcf_world_with_a_large_texture,
    mjcf_world_with_large_memory,
    map_with_a_large_image,
)
ROBOTS: tuple[Callable[[Path], Path], ...] = (
    sdf_robot_with_many_bodies,
    urdf_robot_with_many_bodies,
    urdf_robot_with_a_long_chain,
    sdf_robot_with_a_dense_lidar,
    sdf_robot_with_a_fast_lidar,
    sdf_robot_with_a_large_camera,
    sdf_robot_with_many_sensors,
)
