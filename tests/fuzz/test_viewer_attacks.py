"""Every attack of the benchmark, bounded: what the live view keeps stays limited.

``benchmarks/attack_viewer.py`` measures what the robot notices. Here the attacks only
begin, and the queues, channels, connections and files that they cause are counted.
"""

import random  # noqa: TID251 - the attacks draw bytes; seeded
import sys
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Any

import attack_viewer
import pytest

from navette.runtime import Context, Node
from navette.viewer.hub import Hub
from navette.viewer.session import Session

sys.path.append(str(Path(__file__).parents[1] / "unit" / "viewer"))

from viewer_harness import Client, Program

_SENDS = 2
_MAX_CLIENTS = 8
_PENDING = 16 + 64  # unfinished requests; one frame can open 64 channels
_QUEUED = 40_000_000  # bytes of a client
_FILES = _MAX_CLIENTS + 32 + 100  # open files of the process


class Bounds(Hub):
    """Checks the state of each client after each of its frames."""

    exceeded: list[str]

    def receive(self, session: Session, frame: str | bytes) -> None:
        super().receive(session, frame)
        everyone = self._sessions.values()
        opened = sum(len(each.client_channels) for each in everyone)
        checks = {
            "pending": session.pending <= _PENDING,
            "queued": session.outbox.size <= _QUEUED,
            "channels": opened <= 256,
            "names": len(session.parameter_names) <= 1000,
            "clients": self.clients <= _MAX_CLIENTS,
        }
        self.exceeded += [name for name, is_met in checks.items() if not is_met]


class Talker(Node):
    def __init__(self, context: Context) -> None:
        super().__init__("talker", context=context)
        self.declare_parameter("depth", 3)


@pytest.fixture(scope="module")
def program() -> Iterator[Program]:
    patch = pytest.MonkeyPatch()
    patch.setattr(attack_viewer, "TIMEOUT_S", 0.2)
    patch.setattr(attack_viewer, "LARGE", 4_500_000)  # above the limit of a frame
    patch.setattr("navette.viewer.node.Hub", Bounds)
    Bounds.exceeded = []
    with Program(Talker, max_clients=_MAX_CLIENTS) as running:
        yield running
    patch.undo()


@pytest.mark.parametrize("name", attack_viewer.ATTACKS)
def test_an_attack_leaves_bounded_state(name: str, program: Program) -> None:
    port = program.viewer.port
    attack: Any = attack_viewer.ATTACKS[name](port, random.Random(1))
    for _ in islice(attack, _SENDS):
        pass
    attack.close()
    assert len(list(Path("/proc/self/fd").iterdir())) < _FILES
    assert program.failure is None
    with Client(program.address) as client:
        assert client.get_parameters("/talker.depth") == {"/talker.depth": 3}
    assert Bounds.exceeded == []
