"""Logging: five levels, to console, file and /rosout; once, throttled, skip first.

Each node has its own level: set it with ``--ros-args --log-level door:=debug`` or in
the program.

Prints::

    INFO [door] open 1
    WARN [door] the hinge squeaks
    INFO [door] open 2
    INFO [door] open 3
    INFO [door] open 4
    ERROR [door] stuck (at most once a second)
    INFO [door] open 5
    FATAL [door] fell off (the first time is skipped)
    DEBUG [door] debug messages are enabled
    lines in the file: 9
"""

import tempfile
from pathlib import Path

import navette
from navette.msgs.rcl_interfaces.msg import Log

LEVELS = {10: "DEBUG", 20: "INFO", 30: "WARN", 40: "ERROR", 50: "FATAL"}


class Door(navette.Node):
    def __init__(self):
        super().__init__("door")
        self.create_timer(0.4, self.swing)
        self.count = 0

    def swing(self):
        log = self.get_logger()
        self.count += 1
        log.debug("not logged: the level is INFO")
        log.info(f"open {self.count}")
        log.warning("the hinge squeaks", once=True)
        if self.count >= 4:
            log.error("stuck (at most once a second)", throttle_duration_sec=1.0)
            log.fatal("fell off (the first time is skipped)", skip_first=True)


def show(entry):
    print(f"{LEVELS[entry.level]} [{entry.name}] {entry.msg}")


with tempfile.TemporaryDirectory() as folder:
    file = Path(folder) / "door.log"
    arguments = ["--ros-args", "--disable-stdout-logs", "--log-file", str(file)]
    with navette.init(args=arguments, clock=navette.VirtualClock()):
        door, listener = Door(), navette.Node("listener")
        listener.create_subscription(Log, "/rosout", show, 10)
        executor = navette.SingleThreadedExecutor()
        executor.add_node(door)
        executor.add_node(listener)
        executor.spin_for(2_100_000_000)
        door.get_logger().set_level(navette.LoggingSeverity.DEBUG)
        door.get_logger().debug("debug messages are enabled")
        executor.spin_for(100_000_000)
    print("lines in the file:", len(file.read_text().splitlines()))
