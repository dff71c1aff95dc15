"""Parameters of the live view."""

from dataclasses import dataclass

from navette.params import Params, param

# The Foxglove app in a browser.
_FOXGLOVE = ("https://app.foxglove.dev",)


@dataclass(frozen=True, kw_only=True)
class ViewerParams(Params):
    """Address of the live view, and its access rules."""

    host: str = param(
        "127.0.0.1",
        "address to listen on; 0.0.0.0 listens on all networks, which requires "
        "NAVETTE_SECURITY or allow_unencrypted",
    )
    port: int = param(
        8765, "TCP port to listen on; 0 takes a free one", at_least=0, at_most=65535
    )
    map_frame: str = param(
        "", "fixed frame of the bundled layout; empty takes the other nodes' parameter"
    )
    base_frame: str = param(
        "", "frame that the layout follows; empty takes the other nodes' parameter"
    )
    max_clients: int = param(32, "maximum number of connected clients", at_least=1)
    time_rate_hz: float = param(
        20.0, "rate at which clients receive the time", at_least=0.01, at_most=100.0
    )
    image_rate_hz: float = param(
        10.0,
        "most images per second of a camera that clients receive compressed",
        at_least=0.1,
        at_most=100.0,
    )
    allowed_origins: tuple[str, ...] = param(
        _FOXGLOVE,
        "web origins that may open the socket, besides the live view's own page; "
        "'*' allows all",
    )
    allowed_hosts: tuple[str, ...] = param(
        (), "host names under which the server may be addressed, besides local ones"
    )
    allow_unencrypted: bool = param(
        False,
        "other machines may connect without TLS; tokens can be read on the network",
    )
    allow_anyone: bool = param(
        False, "other machines may connect without a token and drive the robot"
    )
