"""Which middleware carries the messages, under the names of rclpy's functions."""

#: Navette's own transports; on a network they speak rmw_zenoh's wire format.
IDENTIFIER = "rmw_navette"


def get_rmw_implementation_identifier() -> str:
    return IDENTIFIER


def get_available_rmw_implementations() -> set[str]:
    return {IDENTIFIER}
