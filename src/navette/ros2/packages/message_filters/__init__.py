"""message_filters: caches and synchronizers of messages, connected by callbacks."""

from navette.ros2.packages.message_filters.cache import Cache
from navette.ros2.packages.message_filters.simple_filter import SimpleFilter, Subscriber
from navette.ros2.packages.message_filters.synchronizers import (
    ApproximateTimeSynchronizer,
    TimeSynchronizer,
)
