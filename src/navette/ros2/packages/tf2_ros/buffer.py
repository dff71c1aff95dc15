"""tf2_ros.buffer."""

from navette.runtime.tf import Buffer

__all__ = ["Buffer"]
