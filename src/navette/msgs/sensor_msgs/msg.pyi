# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from array import array

from typing import ClassVar

import numpy as np

from numpy.typing import ArrayLike, NDArray

from navette.msgs.base import Message
import navette.msgs.builtin_interfaces.msg
import navette.msgs.geometry_msgs.msg
import navette.msgs.std_msgs.msg

class BatteryState(Message):
    POWER_SUPPLY_STATUS_UNKNOWN: ClassVar[int]
    POWER_SUPPLY_STATUS_CHARGING: ClassVar[int]
    POWER_SUPPLY_STATUS_DISCHARGING: ClassVar[int]
    POWER_SUPPLY_STATUS_NOT_CHARGING: ClassVar[int]
    POWER_SUPPLY_STATUS_FULL: ClassVar[int]
    POWER_SUPPLY_HEALTH_UNKNOWN: ClassVar[int]
    POWER_SUPPLY_HEALTH_GOOD: ClassVar[int]
    POWER_SUPPLY_HEALTH_OVERHEAT: ClassVar[int]
    POWER_SUPPLY_HEALTH_DEAD: ClassVar[int]
    POWER_SUPPLY_HEALTH_OVERVOLTAGE: ClassVar[int]
    POWER_SUPPLY_HEALTH_UNSPEC_FAILURE: ClassVar[int]
    POWER_SUPPLY_HEALTH_COLD: ClassVar[int]
    POWER_SUPPLY_HEALTH_WATCHDOG_TIMER_EXPIRE: ClassVar[int]
    POWER_SUPPLY_HEALTH_SAFETY_TIMER_EXPIRE: ClassVar[int]
    POWER_SUPPLY_TECHNOLOGY_UNKNOWN: ClassVar[int]
    POWER_SUPPLY_TECHNOLOGY_NIMH: ClassVar[int]
    POWER_SUPPLY_TECHNOLOGY_LION: ClassVar[int]
    POWER_SUPPLY_TECHNOLOGY_LIPO: ClassVar[int]
    POWER_SUPPLY_TECHNOLOGY_LIFE: ClassVar[int]
    POWER_SUPPLY_TECHNOLOGY_NICD: ClassVar[int]
    POWER_SUPPLY_TECHNOLOGY_LIMN: ClassVar[int]
    POWER_SUPPLY_TECHNOLOGY_TERNARY: ClassVar[int]
    POWER_SUPPLY_TECHNOLOGY_VRLA: ClassVar[int]
    header: navette.msgs.std_msgs.msg.Header
    voltage: float
    temperature: float
    current: float
    charge: float
    capacity: float
    design_capacity: float
    percentage: float
    power_supply_status: int
    power_supply_health: int
    power_supply_technology: int
    present: bool
    @property
    def cell_voltage(self) -> array[float]: ...
    @cell_voltage.setter
    def cell_voltage(self, value: ArrayLike) -> None: ...
    @property
    def cell_temperature(self) -> array[float]: ...
    @cell_temperature.setter
    def cell_temperature(self, value: ArrayLike) -> None: ...
    location: str
    serial_number: str
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        voltage: float = ...,
        temperature: float = ...,
        current: float = ...,
        charge: float = ...,
        capacity: float = ...,
        design_capacity: float = ...,
        percentage: float = ...,
        power_supply_status: int = ...,
        power_supply_health: int = ...,
        power_supply_technology: int = ...,
        present: bool = ...,
        cell_voltage: ArrayLike = ...,
        cell_temperature: ArrayLike = ...,
        location: str = ...,
        serial_number: str = ...,
    ) -> None: ...

class CameraInfo(Message):
    header: navette.msgs.std_msgs.msg.Header
    height: int
    width: int
    distortion_model: str
    @property
    def d(self) -> array[float]: ...
    @d.setter
    def d(self, value: ArrayLike) -> None: ...
    @property
    def k(self) -> NDArray[np.float64]: ...
    @k.setter
    def k(self, value: ArrayLike) -> None: ...
    @property
    def r(self) -> NDArray[np.float64]: ...
    @r.setter
    def r(self, value: ArrayLike) -> None: ...
    @property
    def p(self) -> NDArray[np.float64]: ...
    @p.setter
    def p(self, value: ArrayLike) -> None: ...
    binning_x: int
    binning_y: int
    roi: RegionOfInterest
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        height: int = ...,
        width: int = ...,
        distortion_model: str = ...,
        d: ArrayLike = ...,
        k: ArrayLike = ...,
        r: ArrayLike = ...,
        p: ArrayLike = ...,
        binning_x: int = ...,
        binning_y: int = ...,
        roi: RegionOfInterest = ...,
    ) -> None: ...

class ChannelFloat32(Message):
    name: str
    @property
    def values(self) -> array[float]: ...
    @values.setter
    def values(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        name: str = ...,
        values: ArrayLike = ...,
    ) -> None: ...

class CompressedImage(Message):
    header: navette.msgs.std_msgs.msg.Header
    format: str
    @property
    def data(self) -> array[int]: ...
    @data.setter
    def data(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        format: str = ...,
        data: ArrayLike = ...,
    ) -> None: ...

class FluidPressure(Message):
    header: navette.msgs.std_msgs.msg.Header
    fluid_pressure: float
    variance: float
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        fluid_pressure: float = ...,
        variance: float = ...,
    ) -> None: ...

class Illuminance(Message):
    header: navette.msgs.std_msgs.msg.Header
    illuminance: float
    variance: float
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        illuminance: float = ...,
        variance: float = ...,
    ) -> None: ...

class Image(Message):
    header: navette.msgs.std_msgs.msg.Header
    height: int
    width: int
    encoding: str
    is_bigendian: int
    step: int
    @property
    def data(self) -> array[int]: ...
    @data.setter
    def data(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        height: int = ...,
        width: int = ...,
        encoding: str = ...,
        is_bigendian: int = ...,
        step: int = ...,
        data: ArrayLike = ...,
    ) -> None: ...

class Imu(Message):
    header: navette.msgs.std_msgs.msg.Header
    orientation: navette.msgs.geometry_msgs.msg.Quaternion
    @property
    def orientation_covariance(self) -> NDArray[np.float64]: ...
    @orientation_covariance.setter
    def orientation_covariance(self, value: ArrayLike) -> None: ...
    angular_velocity: navette.msgs.geometry_msgs.msg.Vector3
    @property
    def angular_velocity_covariance(self) -> NDArray[np.float64]: ...
    @angular_velocity_covariance.setter
    def angular_velocity_covariance(self, value: ArrayLike) -> None: ...
    linear_acceleration: navette.msgs.geometry_msgs.msg.Vector3
    @property
    def linear_acceleration_covariance(self) -> NDArray[np.float64]: ...
    @linear_acceleration_covariance.setter
    def linear_acceleration_covariance(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        orientation: navette.msgs.geometry_msgs.msg.Quaternion = ...,
        orientation_covariance: ArrayLike = ...,
        angular_velocity: navette.msgs.geometry_msgs.msg.Vector3 = ...,
        angular_velocity_covariance: ArrayLike = ...,
        linear_acceleration: navette.msgs.geometry_msgs.msg.Vector3 = ...,
        linear_acceleration_covariance: ArrayLike = ...,
    ) -> None: ...

class JointState(Message):
    header: navette.msgs.std_msgs.msg.Header
    name: list[str]
    @property
    def position(self) -> array[float]: ...
    @position.setter
    def position(self, value: ArrayLike) -> None: ...
    @property
    def velocity(self) -> array[float]: ...
    @velocity.setter
    def velocity(self, value: ArrayLike) -> None: ...
    @property
    def effort(self) -> array[float]: ...
    @effort.setter
    def effort(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        name: list[str] = ...,
        position: ArrayLike = ...,
        velocity: ArrayLike = ...,
        effort: ArrayLike = ...,
    ) -> None: ...

class Joy(Message):
    header: navette.msgs.std_msgs.msg.Header
    @property
    def axes(self) -> array[float]: ...
    @axes.setter
    def axes(self, value: ArrayLike) -> None: ...
    @property
    def buttons(self) -> array[int]: ...
    @buttons.setter
    def buttons(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        axes: ArrayLike = ...,
        buttons: ArrayLike = ...,
    ) -> None: ...

class JoyFeedback(Message):
    TYPE_LED: ClassVar[int]
    TYPE_RUMBLE: ClassVar[int]
    TYPE_BUZZER: ClassVar[int]
    type: int
    id: int
    intensity: float
    def __init__(
        self,
        *,
        type: int = ...,
        id: int = ...,
        intensity: float = ...,
    ) -> None: ...

class JoyFeedbackArray(Message):
    array: list[JoyFeedback]
    def __init__(
        self,
        *,
        array: list[JoyFeedback] = ...,
    ) -> None: ...

class LaserEcho(Message):
    @property
    def echoes(self) -> array[float]: ...
    @echoes.setter
    def echoes(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        echoes: ArrayLike = ...,
    ) -> None: ...

class LaserScan(Message):
    header: navette.msgs.std_msgs.msg.Header
    angle_min: float
    angle_max: float
    angle_increment: float
    time_increment: float
    scan_time: float
    range_min: float
    range_max: float
    @property
    def ranges(self) -> array[float]: ...
    @ranges.setter
    def ranges(self, value: ArrayLike) -> None: ...
    @property
    def intensities(self) -> array[float]: ...
    @intensities.setter
    def intensities(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        angle_min: float = ...,
        angle_max: float = ...,
        angle_increment: float = ...,
        time_increment: float = ...,
        scan_time: float = ...,
        range_min: float = ...,
        range_max: float = ...,
        ranges: ArrayLike = ...,
        intensities: ArrayLike = ...,
    ) -> None: ...

class MagneticField(Message):
    header: navette.msgs.std_msgs.msg.Header
    magnetic_field: navette.msgs.geometry_msgs.msg.Vector3
    @property
    def magnetic_field_covariance(self) -> NDArray[np.float64]: ...
    @magnetic_field_covariance.setter
    def magnetic_field_covariance(self, value: ArrayLike) -> None: ...
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        magnetic_field: navette.msgs.geometry_msgs.msg.Vector3 = ...,
        magnetic_field_covariance: ArrayLike = ...,
    ) -> None: ...

class MultiDOFJointState(Message):
    header: navette.msgs.std_msgs.msg.Header
    joint_names: list[str]
    transforms: list[navette.msgs.geometry_msgs.msg.Transform]
    twist: list[navette.msgs.geometry_msgs.msg.Twist]
    wrench: list[navette.msgs.geometry_msgs.msg.Wrench]
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        joint_names: list[str] = ...,
        transforms: list[navette.msgs.geometry_msgs.msg.Transform] = ...,
        twist: list[navette.msgs.geometry_msgs.msg.Twist] = ...,
        wrench: list[navette.msgs.geometry_msgs.msg.Wrench] = ...,
    ) -> None: ...

class MultiEchoLaserScan(Message):
    header: navette.msgs.std_msgs.msg.Header
    angle_min: float
    angle_max: float
    angle_increment: float
    time_increment: float
    scan_time: float
    range_min: float
    range_max: float
    ranges: list[LaserEcho]
    intensities: list[LaserEcho]
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        angle_min: float = ...,
        angle_max: float = ...,
        angle_increment: float = ...,
        time_increment: float = ...,
        scan_time: float = ...,
        range_min: float = ...,
        range_max: float = ...,
        ranges: list[LaserEcho] = ...,
        intensities: list[LaserEcho] = ...,
    ) -> None: ...

class NavSatFix(Message):
    COVARIANCE_TYPE_UNKNOWN: ClassVar[int]
    COVARIANCE_TYPE_APPROXIMATED: ClassVar[int]
    COVARIANCE_TYPE_DIAGONAL_KNOWN: ClassVar[int]
    COVARIANCE_TYPE_KNOWN: ClassVar[int]
    header: navette.msgs.std_msgs.msg.Header
    status: NavSatStatus
    latitude: float
    longitude: float
    altitude: float
    @property
    def position_covariance(self) -> NDArray[np.float64]: ...
    @position_covariance.setter
    def position_covariance(self, value: ArrayLike) -> None: ...
    position_covariance_type: int
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        status: NavSatStatus = ...,
        latitude: float = ...,
        longitude: float = ...,
        altitude: float = ...,
        position_covariance: ArrayLike = ...,
        position_covariance_type: int = ...,
    ) -> None: ...

class NavSatStatus(Message):
    STATUS_UNKNOWN: ClassVar[int]
    STATUS_NO_FIX: ClassVar[int]
    STATUS_FIX: ClassVar[int]
    STATUS_SBAS_FIX: ClassVar[int]
    STATUS_GBAS_FIX: ClassVar[int]
    SERVICE_UNKNOWN: ClassVar[int]
    SERVICE_GPS: ClassVar[int]
    SERVICE_GLONASS: ClassVar[int]
    SERVICE_COMPASS: ClassVar[int]
    SERVICE_GALILEO: ClassVar[int]
    status: int
    service: int
    def __init__(
        self,
        *,
        status: int = ...,
        service: int = ...,
    ) -> None: ...

class PointCloud(Message):
    header: navette.msgs.std_msgs.msg.Header
    points: list[navette.msgs.geometry_msgs.msg.Point32]
    channels: list[ChannelFloat32]
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        points: list[navette.msgs.geometry_msgs.msg.Point32] = ...,
        channels: list[ChannelFloat32] = ...,
    ) -> None: ...

class PointCloud2(Message):
    header: navette.msgs.std_msgs.msg.Header
    height: int
    width: int
    fields: list[PointField]
    is_bigendian: bool
    point_step: int
    row_step: int
    @property
    def data(self) -> array[int]: ...
    @data.setter
    def data(self, value: ArrayLike) -> None: ...
    is_dense: bool
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        height: int = ...,
        width: int = ...,
        fields: list[PointField] = ...,
        is_bigendian: bool = ...,
        point_step: int = ...,
        row_step: int = ...,
        data: ArrayLike = ...,
        is_dense: bool = ...,
    ) -> None: ...

class PointField(Message):
    INT8: ClassVar[int]
    UINT8: ClassVar[int]
    INT16: ClassVar[int]
    UINT16: ClassVar[int]
    INT32: ClassVar[int]
    UINT32: ClassVar[int]
    FLOAT32: ClassVar[int]
    FLOAT64: ClassVar[int]
    name: str
    offset: int
    datatype: int
    count: int
    def __init__(
        self,
        *,
        name: str = ...,
        offset: int = ...,
        datatype: int = ...,
        count: int = ...,
    ) -> None: ...

class Range(Message):
    ULTRASOUND: ClassVar[int]
    INFRARED: ClassVar[int]
    header: navette.msgs.std_msgs.msg.Header
    radiation_type: int
    field_of_view: float
    min_range: float
    max_range: float
    range: float
    variance: float
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        radiation_type: int = ...,
        field_of_view: float = ...,
        min_range: float = ...,
        max_range: float = ...,
        range: float = ...,
        variance: float = ...,
    ) -> None: ...

class RegionOfInterest(Message):
    x_offset: int
    y_offset: int
    height: int
    width: int
    do_rectify: bool
    def __init__(
        self,
        *,
        x_offset: int = ...,
        y_offset: int = ...,
        height: int = ...,
        width: int = ...,
        do_rectify: bool = ...,
    ) -> None: ...

class RelativeHumidity(Message):
    header: navette.msgs.std_msgs.msg.Header
    relative_humidity: float
    variance: float
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        relative_humidity: float = ...,
        variance: float = ...,
    ) -> None: ...

class Temperature(Message):
    header: navette.msgs.std_msgs.msg.Header
    temperature: float
    variance: float
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        temperature: float = ...,
        variance: float = ...,
    ) -> None: ...

class TimeReference(Message):
    header: navette.msgs.std_msgs.msg.Header
    time_ref: navette.msgs.builtin_interfaces.msg.Time
    source: str
    def __init__(
        self,
        *,
        header: navette.msgs.std_msgs.msg.Header = ...,
        time_ref: navette.msgs.builtin_interfaces.msg.Time = ...,
        source: str = ...,
    ) -> None: ...
