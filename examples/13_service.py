"""A service: one node asks, another answers; also from inside a callback.

Prints::

    asked from outside: 2 + 3 = 5
    asked and awaited in a timer: 20 + 22 = 42
    asked and waited for in a timer: 1 + 1 = 2
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


class Asker(navette.Node):
    def __init__(self):
        super().__init__("asker")
        self.client = self.create_client(AddTwoInts, "add")
        self.create_timer(1.0, self.ask_and_await)
        self.create_timer(1.2, self.ask_and_wait)

    async def ask_and_await(self):
        answer = await self.client.call_async(AddTwoInts.Request(a=20, b=22))
        print("asked and awaited in a timer: 20 + 22 =", answer.sum)

    def ask_and_wait(self):
        # On ROS 2 this needs a second thread and callback group, or it waits for ever.
        answer = self.client.call(AddTwoInts.Request(a=1, b=1))
        print("asked and waited for in a timer: 1 + 1 =", answer.sum)


with navette.init(clock=navette.VirtualClock()):
    adder, asker = Adder(), Asker()
    executor = navette.SingleThreadedExecutor()
    executor.add_node(adder)
    executor.add_node(asker)
    future = asker.client.call_async(AddTwoInts.Request(a=2, b=3))
    executor.spin_until_future_complete(future)
    print("asked from outside: 2 + 3 =", future.result().sum)
    executor.spin_for(1_500_000_000)
