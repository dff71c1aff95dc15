"""Name of the middleware, under the names of rclpy's functions."""

#: Navette's transports; on a network they use rmw_zenoh's wire format.
IDENTIFIER = "rmw_navette"


def get_rmw_implementation_identifier() -> str:
    return IDENTIFIER


def get_available_rmw_implementations() -> set[str]:
    return {IDENTIFIER}
