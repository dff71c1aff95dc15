# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from navette.msgs.base import Message
import navette.msgs.geometry_msgs.msg

class GeoPoint(Message):
    latitude: float
    longitude: float
    altitude: float
    def __init__(
        self,
        *,
        latitude: float = ...,
        longitude: float = ...,
        altitude: float = ...,
    ) -> None: ...

class GeoPose(Message):
    position: GeoPoint
    orientation: navette.msgs.geometry_msgs.msg.Quaternion
    def __init__(
        self,
        *,
        position: GeoPoint = ...,
        orientation: navette.msgs.geometry_msgs.msg.Quaternion = ...,
    ) -> None: ...
