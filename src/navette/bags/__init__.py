"""Bags: what was said on the topics, in a file."""

from navette.bags.params import RecorderParams
from navette.bags.qos import OfferedQos, qos_text
from navette.bags.selection import TopicSelection
from navette.bags.writer import BagWriter

__all__ = ["BagWriter", "OfferedQos", "RecorderParams", "TopicSelection", "qos_text"]
