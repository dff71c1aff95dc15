"""A pyzeros program that executes commands from standard input.

Arguments: port of the router.
"""

import asyncio
import json
import sys
from typing import Any

import pyzeros
import zenoh
from ros2_pyterfaces.cydr.std_msgs.msg import String
from ros2_pyterfaces.cydr.std_srvs.srv import SetBool

PORT = int(sys.argv[1])


def report(*words: object) -> None:
    sys.stdout.write(" ".join(map(str, words)) + "\n")
    sys.stdout.flush()


def text(value: Any) -> str:
    return value.decode() if isinstance(value, bytes) else str(value)


def open_session() -> zenoh.Session:
    config = zenoh.Config()
    for key, value in {
        "mode": "peer",
        "connect/endpoints": [f"tcp/127.0.0.1:{PORT}"],
        "listen/endpoints": ["tcp/127.0.0.1:0"],
        "scouting/multicast/enabled": False,
    }.items():
        config.insert_json5(key, json.dumps(value))
    return zenoh.open(config)


async def answer(server: Any) -> None:
    async for responder in server.listen_reliable():
        responder.response.success = responder.request.data
        responder.response.message = b"by the peer"
        responder.send()


async def receive(subscription: Any) -> None:
    async for message in subscription.listen_reliable():
        report("received", text(message.data))


async def run_commands(publisher: Any, client: Any) -> None:
    loop = asyncio.get_running_loop()
    while line := await loop.run_in_executor(None, sys.stdin.readline):
        match line.split():
            case ["publish", what]:
                publisher.publish(String(data=what.encode()))
            case ["call"]:
                reply = await client.call_async(SetBool.Request(data=True))
                report("reply", bool(reply.success), text(reply.message))


def compile_codecs() -> None:
    """Compile missing codecs; takes half a minute on a busy machine."""
    for kind in (String, SetBool.Request, SetBool.Response):
        kind().serialize()


async def main() -> None:
    compile_codecs()
    session = open_session()
    with pyzeros.auto_context("peer", zenoh_session=session, domain_id=7):
        publisher = pyzeros.Pub(String, "/from_peer")
        tasks = [
            asyncio.create_task(receive(pyzeros.Sub(String, "/to_peer"))),
            asyncio.create_task(answer(pyzeros.Server(SetBool, "/peer_switch"))),
        ]
        client = pyzeros.Client(SetBool, "/our_switch")
        report("ready")
        await run_commands(publisher, client)
        for task in tasks:
            task.cancel()
    session.close()


asyncio.run(main())
