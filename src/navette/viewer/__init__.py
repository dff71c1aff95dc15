"""The live view: the Foxglove WebSocket protocol and a web page on one port."""

from navette.viewer.layout import build_layout
from navette.viewer.params import ViewerParams

__all__ = ["ViewerParams", "build_layout"]
