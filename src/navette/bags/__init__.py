"""Bags: recorded messages in files; read, write, check, edit, compare and play."""

from navette.bags.bag import BagMessage, BagReader, BagTopic, Damage
from navette.bags.opening import open_bag
from navette.bags.params import RecorderParams
from navette.bags.qos import OfferedQos, parse_qos, qos_text
from navette.bags.selection import TopicSelection
from navette.bags.writer import BagWriter

__all__ = [
    "open_bag",
    "BagReader",
    "BagTopic",
    "BagMessage",
    "Damage",
    "BagWriter",
    "OfferedQos",
    "RecorderParams",
    "TopicSelection",
    "qos_text",
    "parse_qos",
]
