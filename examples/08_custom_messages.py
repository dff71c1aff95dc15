"""Define a message type and load it from a ``.msg`` file at run time.

Prints::

    shop_msgs.msg.Parcel(weight_kg=2.5, stops=[3, 1], fragile=True)
    shop_msgs/msg/Parcel.stops: values from 3 to 300 do not fit uint8 (0 to 255)
"""

import tempfile
from pathlib import Path

import navette
from navette.errors import MessageError
from navette.msgs import get_interface, load_interfaces

DEFINITION = """
float64 weight_kg 1.0   # with a default
uint8[] stops
bool fragile
"""

with tempfile.TemporaryDirectory() as folder:
    file = Path(folder) / "msg" / "Parcel.msg"
    file.parent.mkdir()
    file.write_text(DEFINITION)
    load_interfaces("shop_msgs", folder)
    Parcel = get_interface("shop_msgs/msg/Parcel")

with navette.init(clock=navette.VirtualClock()):
    node = navette.Node("shop")
    publisher = node.create_publisher(Parcel, "parcels", 10)
    node.create_subscription(Parcel, "parcels", print, 10)
    publisher.publish(Parcel(weight_kg=2.5, stops=[3, 1], fragile=True))
    navette.spin_once(node)

try:
    Parcel(stops=[3, 300])
except MessageError as error:
    print(error)
