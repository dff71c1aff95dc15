"""A lifecycle node: another node configures, activates and deactivates it.

Its publisher publishes only while the node is active. On the command line:
``navette lifecycle set /camera configure``.

Prints::

    configure: inactive
    activate: active
    published while active: 3
    deactivate: inactive
    published in total: 3
    cleanup: unconfigured
"""

import navette
from navette.msgs.lifecycle_msgs.msg import Transition
from navette.msgs.lifecycle_msgs.srv import ChangeState, GetState
from navette.msgs.std_msgs.msg import Empty


class Camera(navette.LifecycleNode):
    def __init__(self):
        super().__init__("camera")

    def on_configure(self, state):
        self.images = self.create_lifecycle_publisher(Empty, "image", 10)
        self.timer = self.create_timer(0.1, lambda: self.images.publish(Empty()))
        return navette.TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, state):
        self.destroy_timer(self.timer)
        self.destroy_publisher(self.images)
        return navette.TransitionCallbackReturn.SUCCESS


def call(kind, name, request):
    client = operator.create_client(kind, f"/camera/{name}")
    future = client.call_async(request)
    executor.spin_until_future_complete(future)
    return future.result()


def change(what):
    transition = Transition(id=getattr(Transition, f"TRANSITION_{what.upper()}"))
    done = call(ChangeState, "change_state", ChangeState.Request(transition=transition))
    state = call(GetState, "get_state", GetState.Request()).current_state.label
    return state if done.success else "rejected"


with navette.init(clock=navette.VirtualClock()):
    executor = navette.SingleThreadedExecutor()
    camera, operator, images = Camera(), navette.Node("operator"), []
    executor.add_node(camera)
    executor.add_node(operator)
    operator.create_subscription(Empty, "image", images.append, 10)
    print("configure:", change("configure"))
    executor.spin_for(500_000_000)
    print("activate:", change("activate"))
    executor.spin_for(310_000_000)
    print("published while active:", len(images))
    print("deactivate:", change("deactivate"))
    executor.spin_for(500_000_000)
    print("published in total:", len(images))
    print("cleanup:", change("cleanup"))
