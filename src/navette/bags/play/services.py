"""Services of the player, with rosbag2's names and types (rosbag2_interfaces)."""

import logging
from collections.abc import Callable
from typing import Any, Protocol

from navette.bags.play.player import Player, PlayState
from navette.errors import InvalidValueError
from navette.msgs.rosbag2_interfaces import srv

_log = logging.getLogger(__name__)


class Controls(Protocol):
    """The player operations used by the services."""

    @property
    def player(self) -> Player: ...
    def pause(self) -> None: ...
    def resume(self) -> None: ...
    def toggle_paused(self) -> None: ...
    def step(self) -> bool: ...
    def set_rate(self, rate: float) -> None: ...
    def seek(self, bag_ns: int) -> None: ...
    def stop(self) -> None: ...


Answer = Callable[[Controls, Any, Any], Any]


def _doing(action: Callable[[Controls], object]) -> Answer:
    def answer(controls: Controls, request: Any, response: Any) -> Any:
        action(controls)
        return response

    return answer


def _set_rate(controls: Controls, request: Any, response: Any) -> Any:
    try:
        controls.set_rate(request.rate)
    except InvalidValueError as error:
        _log.warning("rate not changed: %s", error)
        response.success = False
    else:
        response.success = True
    return response


def _get_rate(controls: Controls, request: Any, response: Any) -> Any:
    response.rate = controls.player.rate
    return response


def _is_paused(controls: Controls, request: Any, response: Any) -> Any:
    response.paused = controls.player.state is not PlayState.PLAYING
    return response


def _play_next(controls: Controls, request: Any, response: Any) -> Any:
    """Publish the next message; as in rosbag2, only while paused."""
    paused = controls.player.state is PlayState.PAUSED
    response.success = paused and controls.step()
    return response


def _seek(controls: Controls, request: Any, response: Any) -> Any:
    place_ns = request.time.sec * 1_000_000_000 + request.time.nanosec
    player = controls.player
    response.success = player.begin_ns <= place_ns <= player.end_ns
    if response.success:
        controls.seek(place_ns)
    return response


SERVICES: dict[str, tuple[Any, Answer]] = {
    "pause": (srv.Pause, _doing(lambda c: c.pause())),
    "resume": (srv.Resume, _doing(lambda c: c.resume())),
    "toggle_paused": (srv.TogglePaused, _doing(lambda c: c.toggle_paused())),
    "stop": (srv.Stop, _doing(lambda c: c.stop())),
    "is_paused": (srv.IsPaused, _is_paused),
    "set_rate": (srv.SetRate, _set_rate),
    "get_rate": (srv.GetRate, _get_rate),
    "play_next": (srv.PlayNext, _play_next),
    "seek": (srv.Seek, _seek),
}
"""Service type and handler by name below the node's."""
