"""A zenoh-ros2-sdk program that executes commands from standard input.

Arguments: port of the router, type hashes of String and SetBool.
"""

import sys
from typing import Any

import zenoh_ros2_sdk as sdk

PORT, STRING, SET_BOOL = int(sys.argv[1]), sys.argv[2], sys.argv[3]
NETWORK: dict[str, Any] = {"router_port": PORT, "domain_id": 7, "node_name": "peer"}
TEXT: dict[str, Any] = {"msg_definition": "string data", "type_hash": STRING, **NETWORK}
SWITCH: dict[str, Any] = {
    "request_definition": "bool data",
    "response_definition": "bool success\nstring message",
    "type_hash": SET_BOOL,
    **NETWORK,
}


def report(*words: object) -> None:
    sys.stdout.write(" ".join(map(str, words)) + "\n")
    sys.stdout.flush()


def switch(request: Any) -> Any:
    return server.response_msg_class(success=request.data, message="by the peer")


publisher = sdk.ROS2Publisher("/from_peer", "std_msgs/msg/String", **TEXT)
subscriber = sdk.ROS2Subscriber(
    "/to_peer", "std_msgs/msg/String", lambda m: report("received", m.data), **TEXT
)
server = sdk.ROS2ServiceServer("/peer_switch", "std_srvs/srv/SetBool", switch, **SWITCH)
client = sdk.ROS2ServiceClient("/our_switch", "std_srvs/srv/SetBool", **SWITCH)
report("ready")
for line in sys.stdin:
    match line.split():
        case ["publish", text]:
            publisher.publish(data=text)
        case ["call"]:
            reply = client.call(data=True)
            report("reply", reply.success, reply.message)
        case ["topics"]:
            network = {"router_port": PORT, "domain_id": 7}
            for name, types in sdk.get_topic_names_and_types(**network):
                report("topic", name, *types)
            for name, types in sdk.get_service_names_and_types(**network):
                report("service", name, *types)
            report("listed")
for end in (publisher, subscriber, server, client):
    end.close()
sdk.ZenohSession.get_instance().close()
