"""A node of ROS 2 played by Zenoh alone: any version of it, nothing else installed.

Standard input is one line of JSON (see ``test_zenoh_versions.py``), then lines
``publish`` and ``call``. The process writes ``ready``, then one line for each sample
(``sample KEY BASE64``), request (``request …``) and reply. It ends with its input.
"""

import base64
import json
import sys
from typing import Any

import zenoh
from zenoh import ext


def write(*parts: str) -> None:
    sys.stdout.write(" ".join(parts) + "\n")
    sys.stdout.flush()


def bytes_of(text: str) -> bytes:
    return base64.b64decode(text)


def text_of(payload: Any) -> str:
    return base64.b64encode(payload.to_bytes()).decode()


def session_of(router: str) -> Any:
    """Open a session as rmw_zenoh's default configuration does."""
    config = zenoh.Config()
    for key, value in (
        ("mode", '"peer"'),
        ("connect/endpoints", json.dumps([router])),
        ("listen/endpoints", '["tcp/127.0.0.1:0"]'),
        ("scouting/multicast/enabled", "false"),
        ("scouting/gossip/enabled", "true"),
        ("timestamping/enabled", "true"),
    ):
        config.insert_json5(key, value)
    return zenoh.open(config)


class Peer:
    """Declares what the order lists; publishes and calls on command."""

    def __init__(self, order: dict[str, Any]) -> None:
        self._session = session_of(order["router"])
        self._kept: list[Any] = []
        self._publishers = [
            (
                self._publisher(each),
                bytes_of(each["data"]),
                bytes_of(each["attachment"]),
            )
            for each in order["publish"]
        ]
        for each in order["subscribe"]:
            self._kept.append(self._subscriber(each))
        for each in order["serve"]:
            self._kept.append(self._server(each))
        for token in order["tokens"]:
            self._kept.append(self._session.liveliness().declare_token(token))
        self._calls = order["call"]

    def publish(self) -> None:
        for publisher, data, attachment in self._publishers:
            publisher.put(data, attachment=attachment)

    def call(self) -> None:
        for each in self._calls:
            replies = self._session.get(
                each["key"],
                payload=bytes_of(each["data"]),
                attachment=bytes_of(each["attachment"]),
                target=zenoh.QueryTarget.ALL_COMPLETE,
                consolidation=zenoh.ConsolidationMode.NONE,
                timeout=20.0,
            )
            for reply in replies:
                if reply.ok is not None:
                    write("reply", each["key"], text_of(reply.ok.payload))

    def _publisher(self, each: dict[str, Any]) -> Any:
        if not each["latched"]:
            return self._session.declare_publisher(each["key"])
        return ext.declare_advanced_publisher(
            self._session,
            each["key"],
            cache=ext.CacheConfig(1),
            publisher_detection=True,
            sample_miss_detection=ext.MissDetectionConfig(
                heartbeat=None, sporadic_heartbeat=0.5
            ),
        )

    def _subscriber(self, each: dict[str, Any]) -> Any:
        def received(sample: Any) -> None:
            write("sample", each["key"], text_of(sample.payload))

        if not each["latched"]:
            return self._session.declare_subscriber(each["key"], received)
        return ext.declare_advanced_subscriber(
            self._session,
            each["key"],
            received,
            history=ext.HistoryConfig(detect_late_publishers=True, max_samples=1),
            recovery=ext.RecoveryConfig(periodic_queries=None, heartbeat=True),
        )

    def _server(self, each: dict[str, Any]) -> Any:
        def answer(query: Any) -> None:
            write("request", each["key"], text_of(query.payload))
            query.reply(
                each["key"], bytes_of(each["data"]), attachment=query.attachment
            )
            query.drop()

        return self._session.declare_queryable(each["key"], answer, complete=True)


def main() -> None:
    peer = Peer(json.loads(sys.stdin.readline()))
    write("ready")
    for line in sys.stdin:
        if line.strip() == "publish":
            peer.publish()
        elif line.strip() == "call":
            peer.call()


if __name__ == "__main__":
    main()
