# Written by python -m navette.msgs.generate; do not edit.
# ruff: noqa
# fmt: off

from typing import ClassVar

from navette.msgs.base import Message
import navette.msgs.builtin_interfaces.msg

class MetricsMessage(Message):
    measurement_source_name: str
    metrics_source: str
    unit: str
    window_start: navette.msgs.builtin_interfaces.msg.Time
    window_stop: navette.msgs.builtin_interfaces.msg.Time
    statistics: list[StatisticDataPoint]
    def __init__(
        self,
        *,
        measurement_source_name: str = ...,
        metrics_source: str = ...,
        unit: str = ...,
        window_start: navette.msgs.builtin_interfaces.msg.Time = ...,
        window_stop: navette.msgs.builtin_interfaces.msg.Time = ...,
        statistics: list[StatisticDataPoint] = ...,
    ) -> None: ...

class StatisticDataPoint(Message):
    data_type: int
    data: float
    def __init__(
        self,
        *,
        data_type: int = ...,
        data: float = ...,
    ) -> None: ...

class StatisticDataType(Message):
    STATISTICS_DATA_TYPE_UNINITIALIZED: ClassVar[int]
    STATISTICS_DATA_TYPE_AVERAGE: ClassVar[int]
    STATISTICS_DATA_TYPE_MINIMUM: ClassVar[int]
    STATISTICS_DATA_TYPE_MAXIMUM: ClassVar[int]
    STATISTICS_DATA_TYPE_STDDEV: ClassVar[int]
    STATISTICS_DATA_TYPE_SAMPLE_COUNT: ClassVar[int]
    def __init__(self) -> None: ...
