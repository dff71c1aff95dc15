"""The layout for the Foxglove app: 3D view with goal tool, teleop, camera, state.

Panel ids and settings follow the app's layout files (``configById`` and a tree of
splits). Robot and world models come from latched URDF topics: they need no network
address and work for every robot.
"""

from typing import Any

from navette.msgs import topics

_BLUE = "#4c8dff"
_PATH = ("#ff8a3dff", "#ffc46bff")


def build_layout(map_frame: str, base_frame: str) -> dict[str, Any]:
    """Return the layout file; the 3D panel shows ``map_frame`` from above."""
    return {
        "configById": {
            "3D!drive": _drive_view(map_frame),
            "Image!camera": _camera_view(),
            "Teleop!wheels": _teleop(),
            "StateTransitions!states": _state_lines(),
            "RawMessages!planner": _message(topics.PLANNER_STATUS.name),
            "RawMessages!control": _message(topics.CONTROL_STATUS.name),
            "Parameters!all": {"title": "Parameters"},
            "RosOut!log": {
                "searchTerms": [],
                "minLogLevel": 1,
                "topicToRender": "/rosout",
            },
            "Plot!speed": _speed_plot(),
            "Tab!state": _tabs(),
            "3D!follow": _follow_view(map_frame, base_frame),
        },
        "globalVariables": {},
        "userNodes": {},
        "playbackConfig": {"speed": 1},
        "layout": {
            "direction": "row",
            "splitPercentage": 66,
            "first": "3D!drive",
            "second": {
                "direction": "column",
                "splitPercentage": 34,
                "first": "Image!camera",
                "second": {
                    "direction": "column",
                    "splitPercentage": 40,
                    "first": "Teleop!wheels",
                    "second": "Tab!state",
                },
            },
        },
    }


def _tabs() -> dict[str, Any]:
    states = {
        "direction": "column",
        "splitPercentage": 40,
        "first": "StateTransitions!states",
        "second": {
            "direction": "row",
            "first": "RawMessages!planner",
            "second": "RawMessages!control",
        },
    }
    return {
        "activeTabIdx": 0,
        "tabs": [
            {"title": "State", "layout": states},
            {"title": "Parameters", "layout": "Parameters!all"},
            {"title": "Speed", "layout": "Plot!speed"},
            {"title": "Follow", "layout": "3D!follow"},
            {"title": "Log", "layout": "RosOut!log"},
        ],
    }


def _drive_view(map_frame: str) -> dict[str, Any]:
    """View from above; a click with the publish tool sets the goal."""
    return {
        "title": "Drive: click a goal with the publish tool",
        "followMode": "follow-none",
        "followTf": map_frame,
        "fixedFrame": map_frame,
        "cameraState": _camera(distance=38.0, phi=0.01, perspective=False),
        "scene": {
            "backgroundColor": "#14171c",
            "enableStats": False,
            "transforms": {"visible": False, "showLabel": False},
        },
        "transforms": {},
        "topics": _topics(),
        "layers": _layers(map_frame),
        "publish": {
            "type": "point",
            "pointTopic": topics.GOAL_POINT.name,
            "poseTopic": topics.GOAL_POSE.name,
            "poseEstimateTopic": topics.INITIAL_POSE.name,
            "poseEstimateXDeviation": 0.5,
            "poseEstimateYDeviation": 0.5,
            "poseEstimateThetaDeviation": 0.26179939,
        },
        "imageMode": {},
    }


def _follow_view(map_frame: str, base_frame: str) -> dict[str, Any]:
    """View from behind the robot, in its direction of travel."""
    view = _drive_view(map_frame)
    view.update(
        title="Follow the robot",
        followMode="follow-pose",
        followTf=base_frame,
        cameraState=_camera(distance=9.0, phi=62.0, perspective=True),
    )
    return view


def _camera(*, distance: float, phi: float, perspective: bool) -> dict[str, Any]:
    return {
        "perspective": perspective,
        "distance": distance,
        "phi": phi,
        "thetaOffset": 90.0,
        "target": [0.0, 0.0, 0.0],
        "targetOffset": [0.0, 0.0, 0.0],
        "targetOrientation": [0.0, 0.0, 0.0, 1.0],
        "fovy": 45.0,
        "near": 0.1,
        "far": 1000.0,
    }


def _topics() -> dict[str, Any]:
    return {
        topics.MAP.name: {
            "visible": True,
            "colorMode": "custom",
            "minColor": "#f4f6f8ff",
            "maxColor": "#39424eff",
            "unknownColor": "#262c34ff",
            "invalidColor": "#ff00ffff",
            "frameLocked": True,
            "alpha": 0.85,
        },
        topics.COSTMAP.name: {
            "visible": True,
            "colorMode": "costmap",
            "frameLocked": True,
            "alpha": 0.35,
        },
        topics.PATH.name: {
            "visible": True,
            "type": "line",
            "lineWidth": 0.12,
            "gradient": list(_PATH),
        },
        topics.LIDAR.name: {
            "visible": True,
            "pointSize": 4,
            "pointShape": "circle",
            "colorMode": "flat",
            "flatColor": "#ff3d6eff",
            "decayTime": 0,
        },
        topics.GOAL_POINT.name: {
            "visible": True,
            "type": "point",
            "color": "#ffb020ff",
        },
        topics.ODOMETRY.name: {"visible": False},
    }


def _layers(map_frame: str) -> dict[str, Any]:
    return {
        "grid": {
            "layerId": "foxglove.Grid",
            "instanceId": "grid",
            "label": "Grid, 1 m",
            "visible": True,
            "frameLocked": True,
            "frameId": map_frame,
            "size": 40,
            "divisions": 40,
            "lineWidth": 0.5,
            "color": "#ffffff1a",
            "position": [0, 0, 0],
            "rotation": [0, 0, 0],
            "order": 1,
        },
        "robot": _urdf("robot", "Robot", topics.ROBOT_DESCRIPTION.name, _BLUE, order=2),
        "world": _urdf(
            "world", "World", topics.WORLD_DESCRIPTION.name, "#8b95a1", order=3
        ),
    }


def _urdf(
    name: str, label: str, topic: str, color: str, *, order: int
) -> dict[str, Any]:
    return {
        "layerId": "foxglove.Urdf",
        "instanceId": name,
        "label": label,
        "visible": True,
        "frameLocked": True,
        "sourceType": "topic",
        "topic": topic,
        "url": "",
        "filePath": "",
        "parameter": "",
        "framePrefix": "",
        "displayMode": "auto",
        "fallbackColor": color,
        "order": order,
    }


def _camera_view() -> dict[str, Any]:
    return {
        "title": "Camera",
        "imageMode": {
            "imageTopic": topics.CAMERA.name,
            "calibrationTopic": topics.CAMERA_INFO.name,
        },
        "cameraState": _camera(distance=20.0, phi=60.0, perspective=True),
        "followMode": "follow-pose",
        "scene": {},
        "transforms": {},
        "topics": {},
        "layers": {},
    }


def _teleop() -> dict[str, Any]:
    """Publish at 10 Hz; the robot stops soon after the button is released."""
    return {
        "title": "Teleop",
        "topic": topics.CMD_VEL_TELEOP.name,
        "publishRate": 10,
        "upButton": {"field": "linear-x", "value": 0.5},
        "downButton": {"field": "linear-x", "value": -0.3},
        "leftButton": {"field": "angular-z", "value": 0.6},
        "rightButton": {"field": "angular-z", "value": -0.6},
    }


def _state_lines() -> dict[str, Any]:
    """Status of planner and controller as coloured bars over time."""
    return {
        "title": "States",
        "paths": [
            {
                "value": f"/{node}/status.message",
                "label": node,
                "timestampMethod": "receiveTime",
            }
            for node in ("planner", "control")
        ],
        "isSynced": True,
    }


def _message(topic: str) -> dict[str, Any]:
    return {
        "title": topic,
        "topicPath": topic,
        "diffEnabled": False,
        "showFullMessageForDiff": False,
    }


def _speed_plot() -> dict[str, Any]:
    lines = (
        ("/cmd_vel.linear.x", "commanded", "#ffb020"),
        ("/odom/filtered.twist.twist.linear.x", "driven", _BLUE),
    )
    return {
        "title": "Speed (m/s)",
        "paths": [
            {
                "value": path,
                "label": label,
                "color": color,
                "enabled": True,
                "timestampMethod": "receiveTime",
            }
            for path, label, color in lines
        ],
        "showLegend": True,
        "legendDisplay": "top",
        "isSynced": True,
        "xAxisVal": "timestamp",
        "followingViewWidth": 30,
    }
