# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from navette.msgs.base import Message
import navette.msgs.sensor_msgs.msg
import navette.msgs.std_msgs.msg

class DisparityImage(Message):
    header: navette.msgs.std_msgs.msg.Header
    image: navette.msgs.sensor_msgs.msg.Image
    f: float
    t: float
    valid_window: navette.msgs.sensor_msgs.msg.RegionOfInterest
    min_disparity: float
    max_disparity: float
    delta_d: float
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        image: navette.msgs.sensor_msgs.msg.Image = ...,
        f: float = ...,
        t: float = ...,
        valid_window: navette.msgs.sensor_msgs.msg.RegionOfInterest = ...,
        min_disparity: float = ...,
        max_disparity: float = ...,
        delta_d: float = ...,
    ) -> None: ...
