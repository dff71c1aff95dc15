# SPDX-License-Identifier: Apache-2.0
"""Mount sensors of the catalogue on a robot's model."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields, replace
from typing import Any

from navette.errors import ParameterError, UnknownNameError
from navette.geometry import Transform3, quaternion_from_rpy
from navette.sim.drive_geometry import base_of
from navette.sim.profile import extent_of, footprint_of
from navette.sim.scene import Link, Model
from navette.sim.sensor_catalogue import BUMPER_SECTORS, CATALOGUE, PLACES
from navette.sim.sensor_specs import ContactSensor, Sensor

_LARGEST = 1e3  # m, deg or Hz

Point2 = tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class SensorMount:
    """A sensor of the catalogue on a robot.

    Lengths (m) are in the base frame, above the floor; ``pitch_deg`` is downward,
    ``yaw_deg`` to the left. What is None comes from the place, and that from the
    catalogue; so do a rate of 0 and an empty place.
    """

    type: str
    place: str = ""
    x_m: float | None = None
    y_m: float | None = None
    z_m: float | None = None
    roll_deg: float = 0.0
    pitch_deg: float | None = None
    yaw_deg: float | None = None
    rate_hz: float = 0.0
    topic: str = ""
    frame: str = ""

    def __post_init__(self) -> None:
        if self.type not in CATALOGUE:
            raise UnknownNameError.of("sensor", self.type, list(CATALOGUE))
        if self.place and self.place not in PLACES:
            raise UnknownNameError.of("place of a sensor", self.place, list(PLACES))
        if not 0.0 <= self.rate_hz <= 1000.0:
            raise ParameterError(f"rate_hz is {self.rate_hz:g}; expected 0 to 1000")


_TEXTS = ("type", "place", "topic", "frame")


def mounts_of(sensors: Mapping[str, Any]) -> dict[str, SensorMount]:
    """Return the mounts of a file: name → type, or name → values.

    Raises:
        ParameterError: an unknown key or name, or a value that is not allowed.
    """
    found = {}
    for name, given in sensors.items():
        values = {"type": given} if isinstance(given, str) else given
        if not isinstance(values, dict):
            raise ParameterError(
                f"sensors: {name}: {given!r}; expected a name of the catalogue, or "
                "'type: NAME' and its pose"
            )
        try:
            checked = {str(k): _checked(str(k), v) for k, v in values.items()}
            found[str(name)] = SensorMount(**{"type": str(name), **checked})
        except (ParameterError, UnknownNameError) as error:
            raise ParameterError(f"sensors: {name}: {error}") from None
    return found


def _checked(key: str, value: Any) -> Any:
    known = [field.name for field in fields(SensorMount)]
    if key not in known:
        raise UnknownNameError.of("key", key, known)
    if key in _TEXTS:
        if not isinstance(value, str):
            raise ParameterError(f"{key} is {value!r}; expected a text")
        return value
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    if not is_number or not abs(value) <= _LARGEST:
        raise ParameterError(
            f"{key} is {value!r}; expected a number within ±{_LARGEST:g}"
        )
    return float(value)


def mount_of(text: str) -> tuple[str, SensorMount]:
    """Return name and mount of ``TYPE`` or ``TYPE@PLACE``, as ``--sensor`` takes them.

    Raises:
        UnknownNameError: unknown type or place; lists the known ones.
    """
    kind, _, place = text.partition("@")
    name = f"{kind}_{place}" if place else kind
    return name, SensorMount(type=kind, place=place)


def with_sensors(model: Model, mounts: Iterable[tuple[str, SensorMount]]) -> Model:
    """Return a robot with further sensors, on its first link.

    Raises:
        ParameterError: two sensors have the same name.
    """
    children = {joint.child for joint in model.joints}
    root = next(link for link in model.links if link.name not in children)
    link_T_base = root.model_T_link.inverse() @ base_of(model)
    taken = {sensor.name for sensor in root.sensors}
    added: list[Sensor] = []
    for name, mount in mounts:
        if name in taken:
            raise ParameterError(f"sensor {name!r}: the robot has one of this name")
        taken.add(name)
        added += _made(model, name, mount, link_T_base)
    links = tuple(
        _extended(link, added) if link is root else link for link in model.links
    )
    return replace(model, links=links)


def _extended(link: Link, sensors: list[Sensor]) -> Link:
    return replace(link, sensors=(*link.sensors, *sensors))


def _made(
    model: Model, name: str, mount: SensorMount, link_T_base: Transform3
) -> list[Sensor]:
    product = CATALOGUE[mount.type].sensor
    rate_hz = mount.rate_hz or product.rate_hz
    if isinstance(product, ContactSensor):
        return _bumpers(model, replace(product, rate_hz=rate_hz), link_T_base)
    pose = link_T_base @ _pose(model, mount)
    return [
        replace(
            product,
            name=name,
            link_T_sensor=pose,
            rate_hz=rate_hz,
            topic=mount.topic,
            frame=mount.frame,
        )
    ]


def _pose(model: Model, mount: SensorMount) -> Transform3:
    """``base_T_sensor``; what the mount does not give is that of its place."""
    product = CATALOGUE[mount.type]
    place = mount.place or product.place
    low, high = extent_of(model)
    middle = (low[0] + high[0]) / 2, (low[1] + high[1]) / 2
    across = (high[0] - low[0]) / 2, (high[1] - low[1]) / 2
    side = math.radians(PLACES[place])
    out = (0.0, 0.0) if place == "top" else (math.cos(side), math.sin(side))
    usual = (
        middle[0] + round(out[0]) * across[0],
        middle[1] + round(out[1]) * across[1],
        product.height * high[2],
    )
    given = mount.x_m, mount.y_m, mount.z_m
    x, y, z = (u if g is None else g for g, u in zip(given, usual, strict=True))
    pitch = product.pitch_deg if mount.pitch_deg is None else mount.pitch_deg
    yaw = PLACES[place] if mount.yaw_deg is None else mount.yaw_deg
    turn = (math.radians(angle) for angle in (mount.roll_deg, pitch, yaw))
    return Transform3((x, y, z), quaternion_from_rpy(*turn))


def _bumpers(
    model: Model, product: ContactSensor, link_T_base: Transform3
) -> list[Sensor]:
    """Return one switch for each sector, with its frame on the outline."""
    low, high = extent_of(model)
    centre = (low[0] + high[0]) / 2, (low[1] + high[1]) / 2
    centre_link = link_T_base.apply((*centre, 0.0))
    link_yaw = link_T_base.to_pose2().yaw
    outline = footprint_of(model)
    made: list[Sensor] = []
    for name, (middle_deg, half_deg) in BUMPER_SECTORS.items():
        middle, half = math.radians(middle_deg), math.radians(half_deg)
        reach = _to_outline(outline, centre, middle)
        x = centre[0] + reach * math.cos(middle)
        y = centre[1] + reach * math.sin(middle)
        turn = quaternion_from_rpy(0.0, 0.0, middle)
        base_T_sensor = Transform3((x, y, high[2] / 2), turn)
        made.append(
            replace(
                product,
                name=name,
                frame=name,
                link_T_sensor=link_T_base @ base_T_sensor,
                centre=centre_link[:2],
                bearings=(link_yaw + middle - half, link_yaw + middle + half),
            )
        )
    return made


def _to_outline(outline: tuple[Point2, ...], centre: Point2, bearing: float) -> float:
    """Return the distance (m) from a point inside a convex outline to its edge."""
    dx, dy = math.cos(bearing), math.sin(bearing)
    nearest = math.inf
    for (ax, ay), (bx, by) in zip(outline, (*outline[1:], outline[0]), strict=True):
        # The outward normal of an edge of a counter-clockwise polygon.
        nx, ny = by - ay, ax - bx
        towards = nx * dx + ny * dy
        if towards > 1e-12:
            away = nx * (ax - centre[0]) + ny * (ay - centre[1])
            nearest = min(nearest, away / towards)
    return nearest
