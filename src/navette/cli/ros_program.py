"""What programs that take the place of ROS 2's have in common."""

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from navette import runtime
from navette.errors import NavetteError
from navette.runtime import Executor


@contextmanager
def ros_program() -> Iterator[None]:
    """Initialise and shut down as a ROS 2 program; report user errors in one line."""
    runtime.init(args=sys.argv)
    try:
        yield
    except (KeyboardInterrupt, runtime.ExternalShutdownException):
        pass  # the usual end
    except NavetteError as error:
        raise SystemExit(f"navette: {error}") from error
    finally:
        runtime.try_shutdown()


def add_live_view(executor: Executor, *, cli_args: Sequence[str] | None = None) -> None:
    """Add the live view; where its port is in use, the page there shows this, too."""
    from navette.viewer.node import ViewerNode

    try:
        viewer = ViewerNode(cli_args=cli_args)
    except NavetteError as error:
        sys.stderr.write(f"navette: without a live view: {error}\n")
        return
    executor.add_node(viewer)
    viewer.get_logger().info(f"live view: {viewer.url}")
