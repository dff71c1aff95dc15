"""SDF: poses, joints, shapes, sensors, drives; ignored and refused content."""

import logging
import math
from pathlib import Path

import pytest

from navette.errors import FileFormatError, InvalidValueError
from navette.sim.scene import Box, Cylinder, JointKind, Scene
from navette.sim.sdf import read_sdf
from navette.sim.sensor_specs import (
    CameraSensor,
    ContactSensor,
    GnssSensor,
    ImuSensor,
    LidarSensor,
)


def _read(tmp_path: Path, body: str, version: str = "1.8") -> Scene:
    path = tmp_path / "w.world"
    path.write_text(
        f"<sdf version='{version}'>\n<world name='w'>\n{body}</world></sdf>"
    )
    return read_sdf(path)


def _model(links: str, attributes: str = "name='m'") -> str:
    return f"<model {attributes}>{links}</model>"


BOX = "<geometry><box><size>1 2 3</size></box></geometry>"


def test_poses_are_relative_to_their_frames(tmp_path: Path) -> None:
    scene = _read(
        tmp_path,
        """<model name='m'><pose>10 0 0 0 0 0</pose>
        <link name='a'><pose>1 0 0 0 0 1.5707963267948966</pose></link>
        <frame name='f' attached_to='a'><pose>1 0 0 0 0 0</pose></frame>
        <link name='b'><pose relative_to='f'>0 1 0 0 0 0</pose></link>
        <link name='c'><pose frame='a'>2 0 0 0 0 0</pose></link>
        <link name='d'><pose relative_to='j'>0 0 1 0 0 0</pose></link>
        <joint name='j' type='fixed'><pose>0 0 1 0 0 0</pose>
          <parent>a</parent><child>b</child></joint>
        </model>""",
    )
    model = scene.models[0]
    assert model.world_T_model.translation == (10, 0, 0)
    where = {link.name: link.model_T_link.translation for link in model.links}
    assert where["b"] == pytest.approx((0, 1, 0))
    assert where["c"] == pytest.approx((1, 2, 0))
    assert where["d"] == pytest.approx((0, 1, 2))


def test_degrees_and_quaternions(tmp_path: Path) -> None:
    scene = _read(
        tmp_path,
        """<model name='m'>
        <link name='a'><pose degrees='true'>0 0 0 0 0 90</pose></link>
        <link name='b'><pose rotation_format='quat_xyzw'>0 0 0 0 0 2 2</pose></link>
        </model>""",
    )
    half = math.sqrt(0.5)
    for link in scene.models[0].links:
        assert link.model_T_link.rotation == pytest.approx((0, 0, half, half))


def test_frame_cycles_and_unknown_frames_are_errors(tmp_path: Path) -> None:
    with pytest.raises(FileFormatError, match="cycle"):
        _read(
            tmp_path,
            "<model name='m'><link name='a'><pose relative_to='b'/></link>"
            "<link name='b'><pose relative_to='a'/></link></model>",
        )
    with pytest.raises(
        FileFormatError, match=r"w\.world:4: <pose>: unknown frame 'no'"
    ):
        _read(
            tmp_path,
            "<model name='m'>\n<link name='a'><pose relative_to='no'/></link></model>",
        )


def test_nested_models_are_flattened(tmp_path: Path) -> None:
    scene = _read(
        tmp_path,
        """<model name='out'><link name='root'/>
        <model name='in'><pose>0 0 1 0 0 0</pose><link name='x'>
          <pose>1 0 0 0 0 0</pose></link><link name='y'/>
          <joint name='k' type='revolute'><parent>x</parent><child>y</child>
          <axis><xyz>0 0 1</xyz></axis></joint></model>
        <joint name='j' type='fixed'><parent>root</parent><child>in::x</child></joint>
        </model>""",
    )
    model = scene.models[0]
    assert [link.name for link in model.links] == ["root", "in::x", "in::y"]
    assert model.link("in::x").model_T_link.translation == pytest.approx((1, 0, 1))
    assert model.joint("in::k").parent == "in::x"


def test_joint_axis_limits_and_kinds(tmp_path: Path) -> None:
    scene = _read(
        tmp_path,
        """<model name='m'><link name='a'/>
        <link name='w'><pose>0 1 0 -1.5707963267948966 0 0</pose></link>
        <link name='s'/>
        <joint name='wheel' type='revolute'><parent>a</parent><child>w</child>
         <axis><xyz expressed_in='__model__'>0 1 0</xyz>
         <limit><lower>-1.79769e+308</lower><upper>1.79769e+308</upper></limit></axis>
        </joint>
        <joint name='slide' type='prismatic'><parent>a</parent><child>s</child>
         <axis><xyz>1 0 0</xyz><limit><lower>-1</lower><upper>2</upper></limit>
         <dynamics><damping>3</damping></dynamics></axis></joint></model>""",
    )
    wheel, slide = scene.models[0].joints
    assert wheel.axis == pytest.approx((0, 0, 1))
    assert wheel.limits is None
    assert (slide.kind, slide.limits, slide.damping) == (
        JointKind.PRISMATIC,
        (-1, 2),
        3,
    )


def test_equal_collision_and_visual_become_one_shape(tmp_path: Path) -> None:
    scene = _read(
        tmp_path,
        _model(
            f"""<link name='a'><collision name='c'>{BOX}<surface><friction><ode>
            <mu>0.4</mu></ode></friction></surface></collision>
            <visual name='v'>{BOX}<material><diffuse>1 0 0 1</diffuse></material>
            </visual>
            <visual name='top'><pose>0 0 2 0 0 0</pose>{BOX}<material><script>
            <name>Gazebo/Blue</name></script></material></visual></link>"""
        ),
    )
    solid, seen = scene.models[0].links[0].geometries
    assert solid.shape == Box((1, 2, 3))
    assert (solid.collides, solid.visible, solid.friction) == (True, True, 0.4)
    assert solid.colour == (1, 0, 0, 1)
    assert (seen.collides, seen.visible) == (False, True)
    assert seen.colour is not None
    assert seen.colour[2] > seen.colour[0]


@pytest.mark.parametrize(
    ("links", "visible", "is_reported"),
    [
        (f"<link name='a'><collision name='c'>{BOX}</collision></link>", [True], True),
        (
            f"<link name='a'><collision name='c'>{BOX}</collision></link>"
            f"<link name='b'><visual name='v'>{BOX}</visual></link>",
            [False, True],
            False,
        ),
        (
            f"<link name='a'><collision name='c'>{BOX}</collision><visual name='v'>"
            "<geometry><mesh><uri>x.dae</uri></mesh></geometry></visual></link>"
            f"<link name='b'><visual name='v'>{BOX}</visual></link>",
            [True, True],
            False,
        ),
    ],
    ids=["no visual", "another link has one", "the visual is a mesh"],
)
def test_collisions_are_visible_if_no_visual_stands_for_them(
    tmp_path: Path,
    caplog: pytest.LogCaptureFixture,
    links: str,
    visible: list[bool],
    is_reported: bool,
) -> None:
    """Otherwise the robot would drive into what its lidar cannot detect."""
    with caplog.at_level(logging.WARNING):
        scene = _read(tmp_path, _model(links))
    shapes = [shape for link in scene.models[0].links for shape in link.geometries]
    assert [shape.visible for shape in shapes] == visible
    assert ("sensors detect <collision>" in caplog.text) is is_reported


def test_sensors(tmp_path: Path) -> None:
    scene = _read(
        tmp_path,
        _model(
            """<link name='a'>
            <sensor name='front' type='gpu_lidar'><pose>0 0 1 0 0 0</pose>
             <update_rate>25</update_rate><topic>/scan</topic>
             <lidar><scan><horizontal><samples>90</samples><min_angle>-1</min_angle>
             <max_angle>1</max_angle></horizontal></scan>
             <range><min>0.2</min><max>9</max></range>
             <noise><type>gaussian</type><stddev>0.01</stddev></noise></lidar></sensor>
            <sensor name='eye' type='camera'><camera>
             <horizontal_fov>1.2</horizontal_fov><image><width>64</width><height>48</height></image></camera></sensor>
            <sensor name='imu' type='imu'><update_rate>200</update_rate></sensor>
            <sensor name='bump' type='contact'><contact>
             <collision>c</collision></contact></sensor>
            <sensor name='gps' type='gps'/></link>"""
        ),
    )
    lidar, camera, imu, contact, gnss = scene.models[0].links[0].sensors
    assert isinstance(lidar, LidarSensor)
    assert (lidar.samples, lidar.rate_hz) == (90, 25)
    assert (lidar.range_min, lidar.range_max, lidar.noise_stddev) == (0.2, 9, 0.01)
    assert isinstance(camera, CameraSensor)
    assert (camera.width, camera.height, camera.horizontal_fov) == (64, 48, 1.2)
    assert isinstance(imu, ImuSensor)
    assert imu.rate_hz == 200
    assert isinstance(contact, ContactSensor)
    assert contact.collisions == ("c",)
    assert isinstance(gnss, GnssSensor)


@pytest.mark.parametrize(
    ("plugin", "separation", "radius"),
    [
        (
            "filename='libgazebo_ros_diff_drive.so' name='d'>"
            "<leftJoint>l</leftJoint><rightJoint>r</rightJoint>"
            "<wheelSeparation>0.5</wheelSeparation><wheelDiameter>0.2</wheelDiameter>",
            0.5,
            0.1,
        ),
        (
            "filename='x' name='ignition::gazebo::systems::DiffDrive'>"
            "<left_joint>l</left_joint><right_joint>r</right_joint>"
            "<wheel_separation>0.6</wheel_separation><wheel_radius>0.2</wheel_radius>",
            0.6,
            0.2,
        ),
        (
            "filename='libgazebo_ros_skid_steer_drive.so' name='s'>"
            "<leftFrontJoint>l</leftFrontJoint><rightFrontJoint>r</rightFrontJoint>"
            "<leftRearJoint>l</leftRearJoint><rightRearJoint>r</rightRearJoint>"
            "<wheelSeparation>0.4</wheelSeparation><wheelDiameter>0.2</wheelDiameter>",
            0.4,
            0.1,
        ),
    ],
)
def test_drive_plugins(
    tmp_path: Path, plugin: str, separation: float, radius: float
) -> None:
    scene = _read(tmp_path, _model(f"<link name='a'/><plugin {plugin}</plugin>"))
    assert scene.robot is not None
    drive = scene.robot.drive
    assert drive is not None
    assert (drive.wheel_separation, drive.wheel_radius) == (separation, radius)
    assert drive.left_joints[0] == "l"


def test_unsupported_elements_are_logged_once_per_kind(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    mesh = "<geometry><mesh><uri>x.dae</uri></mesh></geometry>"
    with caplog.at_level(logging.WARNING):
        _read(
            tmp_path,
            _model(
                f"<link name='a'><visual name='v'>{mesh}</visual>"
                f"<collision name='c'>{mesh}</collision></link>"
            )
            + "<road name='x'/><plugin name='p::Keys' filename='k'/>"
            + "<include><uri>model://house</uri></include>",
        )
    text = "\n".join(caplog.messages)
    assert text.count("<mesh> geometry") == 1
    assert "(and 1 more)" in text
    for kind in ("<road>", "plugin 'p::Keys'", "'model://house'"):
        assert kind in text


def test_noise_of_a_camera_is_checked_and_not_supported(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    def read(stddev: float) -> None:
        noise = f"<noise><type>gaussian</type><stddev>{stddev}</stddev></noise>"
        camera = f"<sensor name='c' type='camera'><camera>{noise}</camera></sensor>"
        _read(tmp_path, _model(f"<link name='a'>{camera}</link>"))

    with caplog.at_level(logging.WARNING):
        read(0.0)
        assert not caplog.messages
        read(0.1)
    assert "noise of a camera" in caplog.text
    with pytest.raises(FileFormatError, match="<stddev> is -1; must be >= 0"):
        read(-1.0)


def test_common_includes_are_built_in(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    with caplog.at_level(logging.WARNING):
        scene = _read(
            tmp_path,
            "<include><uri>model://sun</uri></include>"
            "<include><uri>model://ground_plane</uri></include>",
        )
    assert [model.name for model in scene.models] == ["ground_plane"]
    assert not caplog.messages


def test_state_is_ignored(tmp_path: Path) -> None:
    scene = _read(
        tmp_path,
        "<model name='m'><static>1</static><pose frame=''>1 2 0 0 0 0</pose>"
        "<link name='a'><collision name='c'><geometry><cylinder><radius>0.1</radius>"
        "<length>1</length></cylinder></geometry></collision></link></model>"
        "<state world_name='w'><model name='m'><pose>9 9 9 0 0 0</pose></model>"
        "</state>",
        version="1.6",
    )
    (model,) = scene.models
    assert model.static
    assert model.world_T_model.translation == (1, 2, 0)
    assert model.links[0].geometries[0].shape == Cylinder(0.1, 1)


@pytest.mark.parametrize(
    ("body", "reason"),
    [
        ("<model><link name='a'/></model>", "attribute 'name' is missing"),
        (_model("<link name='a'/><link name='a'/>"), "used twice"),
        (_model("<link name='a'/>") * 2, "used twice"),
        (
            _model(
                "<link name='a'><collision name='c'><geometry><box><size>0 1 1</size>"
                "</box></geometry></collision></link>"
            ),
            "expected three numbers > 0",
        ),
        (
            _model(
                "<link name='a'><collision name='c'><geometry><sphere>"
                "<radius>big</radius></sphere></geometry></collision></link>"
            ),
            "not numbers",
        ),
        (
            _model(
                "<link name='a'/><joint name='j' type='fixed'><parent>a</parent>"
                "<child>b</child></joint>"
            ),
            "unknown frame 'b'",
        ),
        (
            _model(
                "<link name='a'><sensor name='s' type='lidar'><lidar><scan><horizontal>"
                "<samples>900000</samples></horizontal></scan></lidar></sensor></link>"
            ),
            "samples",
        ),
        (
            _model(
                "<link name='a'/><plugin name='DiffDrive' filename='d'>"
                "<left_joint>l</left_joint></plugin>"
            ),
            "needs <left_joint> and <right_joint>",
        ),
        ("<gravity>1 2</gravity>", "2 numbers; expected 3"),
    ],
)
def test_broken_files_are_clear_errors(tmp_path: Path, body: str, reason: str) -> None:
    with pytest.raises(FileFormatError, match=reason) as error:
        _read(tmp_path, body)
    assert error.value.line is not None
    assert error.value.path.name == "w.world"


def test_not_an_sdf_file(tmp_path: Path) -> None:
    path = tmp_path / "x.sdf"
    path.write_text("<robot name='r'/>")
    with pytest.raises(FileFormatError, match="must be <sdf>"):
        read_sdf(path)


def test_too_large_sizes_are_refused(tmp_path: Path) -> None:
    for shape in (
        "<box><size>1e30 1 1</size></box>",
        "<cylinder><radius>1</radius><length>1e6</length></cylinder>",
        "<sphere><radius>1e6</radius></sphere>",
    ):
        solid = f"<collision name='c'><geometry>{shape}</geometry></collision>"
        with pytest.raises(InvalidValueError, match=r"'c'.*at most 100000 m"):
            _read(tmp_path, _model(f"<link name='l'>{solid}</link>"))
