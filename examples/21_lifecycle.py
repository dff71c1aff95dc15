"""A managed node: configured, activated and stopped from outside.

Its publisher is silent unless the node is active. On the command line:
``navette lifecycle set /camera configure``.

Prints::

    configure: inactive
    activate: active
    published while active: 3
    deactivate: inactive
    published in all: 3
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


def ask(kind, name, request):
    client = person.create_client(kind, f"/camera/{name}")
    future = client.call_async(request)
    executor.spin_until_future_complete(future)
    return future.result()


def change(what):
    transition = Transition(id=getattr(Transition, f"TRANSITION_{what.upper()}"))
    done = ask(ChangeState, "change_state", ChangeState.Request(transition=transition))
    state = ask(GetState, "get_state", GetState.Request()).current_state.label
    return state if done.success else "refused"


with navette.init(clock=navette.VirtualClock()):
    executor = navette.SingleThreadedExecutor()
    camera, person, seen = Camera(), navette.Node("person"), []
    executor.add_node(camera)
    executor.add_node(person)
    person.create_subscription(Empty, "image", seen.append, 10)
    print("configure:", change("configure"))
    executor.spin_for(500_000_000)
    print("activate:", change("activate"))
    executor.spin_for(310_000_000)
    print("published while active:", len(seen))
    print("deactivate:", change("deactivate"))
    executor.spin_for(500_000_000)
    print("published in all:", len(seen))
    print("cleanup:", change("cleanup"))
