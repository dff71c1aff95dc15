"""A program in the robot's network namespace that tries to reach its nodes over Zenoh.

Reads a JSON list of attempts from standard input and prints what each achieved. An
attempt is a Zenoh configuration (key and value pairs), and the keys to reach.
"""

import json
import socket
import sys
import threading
from pathlib import Path
from typing import Any

import zenoh

_OPEN_MS = 2000
_WATCH_S = 1.5
_ETH_ALL = 3


def attempt(config: dict[str, Any], topic: str, service: str) -> dict[str, Any]:
    """Open a session, subscribe, publish and query; return the successes."""
    settings = zenoh.Config()
    for key, value in config.items():
        settings.insert_json5(key, json.dumps(value))
    settings.insert_json5("scouting/multicast/enabled", "false")
    settings.insert_json5("connect/timeout_ms", "0")
    settings.insert_json5("transport/unicast/open_timeout", str(_OPEN_MS))
    settings.insert_json5("connect/exit_on_failure", "true")
    try:
        session = zenoh.open(settings)
    except zenoh.ZError as error:
        return {"opened": False, "reason": str(error)[:200]}
    samples: list[str] = []
    with session:
        subscriber = session.declare_subscriber(
            "**", lambda sample: samples.append(str(sample.key_expr))
        )
        tokens = [
            str(reply.ok.key_expr)
            for reply in session.liveliness().get("@ros2_lv/**", timeout=_WATCH_S)
            if reply.ok
        ]
        publisher = session.declare_publisher(topic)
        querier = session.declare_querier(service)
        publisher.put(b"\\0\\1\\0\\0\\5\\0\\0\\0evil\\0")
        threading.Event().wait(_WATCH_S)
        found = {
            "opened": True,
            "peers": len(session.info.peers_zid()) + len(session.info.routers_zid()),
            "samples": len(samples),
            "tokens": len(tokens),
            "reaches_subscriber": publisher.matching_status.matching,
            "reaches_service": querier.matching_status.matching,
        }
        subscriber.undeclare()
    return found


def impersonate(config: dict[str, Any], seconds: float) -> dict[str, int]:
    """Serve as the router; return what the programs that connect disclose."""
    settings = zenoh.Config()
    for key, value in config.items():
        settings.insert_json5(key, json.dumps(value))
    settings.insert_json5("scouting/multicast/enabled", "false")
    samples: list[str] = []
    with zenoh.open(settings) as session:
        print("serving", flush=True)  # noqa: T201 - read by the test
        subscriber = session.declare_subscriber(
            "**", lambda sample: samples.append(str(sample.key_expr))
        )
        peers: set[str] = set()
        pause = threading.Event()
        for _ in range(round(seconds / 0.1)):
            pause.wait(0.1)
            peers.update(map(str, session.info.peers_zid()))
        replies = session.liveliness().get("@ros2_lv/**", timeout=_WATCH_S)
        tokens = sum(1 for _ in replies)
        subscriber.undeclare()
    return {"peers": len(peers), "samples": len(samples), "tokens": tokens}


def listening() -> list[int]:
    """Return the TCP ports on which programs of the namespace listen."""
    ports = set()
    for line in Path("/proc/net/tcp").read_text(encoding="ascii").splitlines()[1:]:
        words = line.split()
        if words[3] == "0A":
            ports.add(int(words[1].rpartition(":")[2], 16))
    return sorted(ports)


def eavesdrop(seconds: float, texts: list[str]) -> dict[str, Any]:
    """Count the packets of all devices, and those in which each text is readable."""
    packets, found = 0, dict.fromkeys(texts, 0)
    with socket.socket(
        socket.AF_PACKET, socket.SOCK_RAW, socket.htons(_ETH_ALL)
    ) as tap:
        tap.settimeout(0.1)
        stop = threading.Event()
        timer = threading.Timer(seconds, stop.set)
        timer.start()
        while not stop.is_set():
            try:
                packet = tap.recv(1 << 16)
            except TimeoutError:
                continue
            packets += 1
            for text in texts:
                found[text] += text.encode() in packet
        timer.cancel()
    return {"packets": packets, "readable": found}


def main() -> None:
    order = json.load(sys.stdin)
    if "seconds" in order:
        print(json.dumps(eavesdrop(order["seconds"], order["texts"])))  # noqa: T201 - read by the test
        return
    if "impersonate" in order:
        found = impersonate(order["impersonate"], order["for_s"])
        print(json.dumps(found))  # noqa: T201 - read by the test
        return
    ports = listening()
    results = {}
    for name, config in order["attempts"].items():
        for port in ports if order["every_port"] else [order["port"]]:
            endpoint = f"{config['protocol']}/{order['address']}:{port}"
            mode = {"mode": config["mode"], "connect/endpoints": [endpoint]}
            chosen = {**mode, **config["config"]}
            found = attempt(chosen, order["topic"], order["service"])
            results[f"{name} {port}"] = found
    print(json.dumps({"ports": ports, "results": results}))  # noqa: T201 - read by the test


if __name__ == "__main__":
    main()
