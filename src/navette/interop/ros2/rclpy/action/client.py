"""Clients of actions."""

from navette.runtime.action.client import ActionClient, ClientGoalHandle

__all__ = ["ActionClient", "ClientGoalHandle"]
