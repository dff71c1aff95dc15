"""Small recordings of the same messages in every format."""

import sqlite3
from pathlib import Path

from navette.bags import BagMessage, BagTopic, OfferedQos
from navette.bags.writing import completed, open_writer
from navette.msgs import serialize
from navette.msgs.geometry_msgs.msg import PointStamped
from navette.msgs.std_msgs.msg import String

LATCHED = OfferedQos(depth=1, durability="transient_local")
CHATTER = completed(BagTopic("/chatter", "std_msgs/msg/String", qos=(LATCHED,)))
POINT = completed(BagTopic("/point", "geometry_msgs/msg/PointStamped"))
STEP_NS = 100_000_000
START_NS = 1_700_000_000_000_000_000


def sample(count: int = 6) -> list[BagMessage]:
    """``count`` messages, on two topics in turn, 0.1 s apart."""
    messages = []
    for number in range(count):
        stamp = START_NS + number * STEP_NS
        if number % 2:
            point = PointStamped()
            point.point.x = float(number)
            messages.append(BagMessage(POINT, stamp, serialize(point)))
        else:
            text = serialize(String(data=f"hello {number}"))
            messages.append(BagMessage(CHATTER, stamp, text))
    return messages


def write_sample(path: Path, count: int = 6, *, compression: str = "") -> Path:
    """Write the sample as a recording; the suffix determines the format."""
    writer = open_writer(path, compression=compression)
    for message in sample(count):
        writer.write(message)
    writer.close()
    return path


def shrink_pages(path: Path) -> None:
    """SQLite with its smallest pages: a tenth of the size, all bytes in use."""
    database = sqlite3.connect(path)
    database.execute("PRAGMA page_size = 512")
    database.execute("VACUUM")
    database.close()
