"""Base class of the nodes that read the map: whole, and then the parts that changed."""

from collections.abc import Callable
from typing import Any, Protocol

from navette.errors import InvalidInputError
from navette.msgs import topics
from navette.msgs.map_msgs.msg import OccupancyGridUpdate
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.msgs.nav_msgs.srv import GetMap
from navette.navigation.grids import MapPart, MapReader
from navette.runtime import Future, MessageInfo
from navette.runtime.client import Client
from navette.runtime.input_check import input_check
from navette.runtime.stage.stage_node import Input, StageNode
from navette.runtime.timer import Timer

# A map that is behind for two periods is requested: a whole map follows many updates at
# once, and a new subscription within a second. One period may be a jump of the clock.
_PERIOD_S = 0.75

MAP_UPDATES_INPUT = Input.of(
    topics.MAP_UPDATES,
    "the part of the map that changed",
    callback="on_map_update",
)


OnMap = Callable[[OccupancyGrid], None]
"""Receives a whole map."""


class _Params(Protocol):
    """The parameters of a node that reads the map."""

    @property
    def map_frame(self) -> str:
        """Frame of the map."""


class MapReaderNode(StageNode):
    """Node that reads the map.

    A derived class subscribes to the map with the callback ``on_map``, and to
    MAP_UPDATES_INPUT.
    """

    params: _Params

    def __init__(self, node_name: str, **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        self._maps = MapReader()
        self._requests = WholeMapRequests(self, self._maps, receive=self.on_map)

    def on_map(self, msg: OccupancyGrid) -> None:
        """Use a whole map, unless the updates have led to it already."""
        if self._maps.receive_map(msg, self.params.map_frame):
            self.on_new_map(None)
        self._apply_updates()
        self._requests.update()

    def on_map_update(self, msg: OccupancyGridUpdate, info: MessageInfo) -> None:
        """Use a part of the map that changed, unless one before it is missing."""
        self._receive_update(msg, info)
        self._apply_updates()

    def on_new_map(self, part: MapPart | None) -> None:
        """Override to update ``self._maps.map`` with a part, and to use it.

        None: the whole map is new.
        """

    def _receive_update(self, msg: OccupancyGridUpdate, info: MessageInfo) -> None:
        number = info["publication_sequence_number"]
        self._maps.receive_update(msg, number, self.params.map_frame)
        self._requests.update()

    def _apply_updates(self) -> None:
        while (part := self._maps.next_part()) is not None:
            self.on_new_map(part)


class WholeMapRequests:
    """Requests the whole map as long as a reader is behind its updates.

    Args:
        node: reads the map.
        maps: the reader.
        receive: called with the map.
    """

    def __init__(
        self,
        node: StageNode,
        maps: MapReader,
        *,
        receive: OnMap,
    ) -> None:
        self._node, self._maps, self._receive = node, maps, receive
        self._check = input_check(topics.MAP.type)
        self._timer: Timer | None = None  # runs while the reader is behind
        self._has_waited = False
        self._client: Client | None = None
        self._response: Future[Any] | None = None

    def update(self) -> None:
        """Note that a map or an update arrived."""
        if self._maps.is_behind == (self._timer is not None):
            return
        if self._timer is None:
            self._timer = self._node.create_timer(_PERIOD_S, self._request)
            self._has_waited = False
        else:
            self._node.destroy_timer(self._timer)
            self._timer = None

    def _request(self) -> None:
        if not self._has_waited:
            self._has_waited = True
            return
        if self._client is None:
            self._client = self._node.create_client(GetMap, "map_server/map")
        is_waiting = self._response is not None and not self._response.done()
        if is_waiting or not self._client.service_is_ready():
            return
        self._node.get_logger().info(
            "updates of the map are missing: the whole map is requested"
        )
        self._response = self._client.call_async(GetMap.Request())
        self._response.add_done_callback(self._on_response)

    def _on_response(self, response: Future[Any]) -> None:
        if response.cancelled() or response.exception() is not None:
            return  # the server ended; the timer requests the map again
        result: Any = response.result()
        try:
            self._check(result.map)
            self._receive(result.map)
        except InvalidInputError as error:
            self._node.drop_input(topics.MAP.name, error)
