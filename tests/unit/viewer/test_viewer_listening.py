"""Ports of the live view are taken before a node exists, and completely."""

import socket

import pytest

from navette.errors import InvalidValueError
from navette.viewer.listening import listen, port_of


def closed(listeners: list[socket.socket]) -> None:
    for each in listeners:
        each.close()


def test_a_free_port_is_chosen_and_accepts_clients_at_once() -> None:
    listeners = list(listen("127.0.0.1", 0))
    with socket.create_connection(("127.0.0.1", port_of(listeners)), 1.0):
        closed(listeners)


def test_all_addresses_of_a_name_share_one_port() -> None:
    listeners = list(listen("localhost", 0))
    ports = {each.getsockname()[1] for each in listeners}
    closed(listeners)
    assert len(ports) == 1
    assert 0 not in ports


def test_a_port_in_use_is_named_and_leaves_no_socket_open() -> None:
    first = list(listen("127.0.0.1", 0))
    port = port_of(first)
    with pytest.raises(InvalidValueError, match=f"port {port}: the port is in use"):
        listen("127.0.0.1", port)
    closed(first)
    closed(list(listen("127.0.0.1", port)))  # free again


def test_an_unknown_host_is_named() -> None:
    with pytest.raises(InvalidValueError, match=r"cannot listen on no-such-host\."):
        listen("no-such-host.invalid", 0)
