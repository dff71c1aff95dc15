"""A service: call it from outside and from inside a callback.

Prints::

    called from outside: 2 + 3 = 5
    awaited in a timer: 20 + 22 = 42
    blocking call in a timer: 1 + 1 = 2
"""

import navette
from navette.msgs.example_interfaces.srv import AddTwoInts


class Adder(navette.Node):
    def __init__(self):
        super().__init__("adder")
        self.create_service(AddTwoInts, "add", self.add)

    def add(self, request, response):
        response.sum = request.a + request.b
        return response


class Caller(navette.Node):
    def __init__(self):
        super().__init__("caller")
        self.client = self.create_client(AddTwoInts, "add")
        self.create_timer(1.0, self.call_and_await)
        self.create_timer(1.2, self.call_and_block)

    async def call_and_await(self):
        response = await self.client.call_async(AddTwoInts.Request(a=20, b=22))
        print("awaited in a timer: 20 + 22 =", response.sum)

    def call_and_block(self):
        # ROS 2 deadlocks here without a second thread and callback group.
        response = self.client.call(AddTwoInts.Request(a=1, b=1))
        print("blocking call in a timer: 1 + 1 =", response.sum)


with navette.init(clock=navette.VirtualClock()):
    adder, caller = Adder(), Caller()
    executor = navette.SingleThreadedExecutor()
    executor.add_node(adder)
    executor.add_node(caller)
    future = caller.client.call_async(AddTwoInts.Request(a=2, b=3))
    executor.spin_until_future_complete(future)
    print("called from outside: 2 + 3 =", future.result().sum)
    executor.spin_for(1_500_000_000)
