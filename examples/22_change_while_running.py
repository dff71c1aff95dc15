"""Change parameters from another node while the robot drives, as the live view does.

Every node serves its parameters. A rejected change is reported to the caller; accepted
changes are published on /parameter_events.

Prints::

    at 1 s: 0.5 m/s
    event: /driver changed speed_mps to 0.8
    at 2 s: 0.8 m/s
    rejected: speed_mps must stay below 1.0 for a radius below 2.0 m
    at 3 s: 0.8 m/s
"""

import navette
from navette import Parameter
from navette.msgs.rcl_interfaces.msg import ParameterEvent, SetParametersResult


class Driver(navette.Node):
    def __init__(self):
        super().__init__("driver")
        self.declare_parameters("", [("speed_mps", 0.5), ("radius_m", 1.5)])
        self.add_on_set_parameters_callback(self.check)

    def check(self, parameters):
        requested = {p.name: p.value for p in parameters}
        radius = requested.get("radius_m", self.get_parameter("radius_m").value)
        if requested.get("speed_mps", 0.0) >= 1.0 and radius < 2.0:
            reason = "speed_mps must stay below 1.0 for a radius below 2.0 m"
            return SetParametersResult(successful=False, reason=reason)
        return SetParametersResult(successful=True)


def on_event(event):
    for changed in event.changed_parameters:
        value = navette.Parameter.from_parameter_msg(changed).value
        print(f"event: {event.node} changed {changed.name} to {value}")


def wait_for(future):
    executor.spin_until_future_complete(future)
    return future.result()


def report(seconds):
    print(f"at {seconds} s: {driver.get_parameter('speed_mps').value} m/s")


with navette.init(clock=navette.VirtualClock()):
    executor = navette.SingleThreadedExecutor()
    driver, operator = Driver(), navette.Node("operator")
    executor.add_node(driver)
    executor.add_node(operator)
    operator.create_subscription(ParameterEvent, "/parameter_events", on_event, 10)
    sliders = navette.AsyncParameterClient(operator, "driver")
    for second, speed in enumerate((None, 0.8, 1.2), start=1):
        if speed is not None:
            change = [Parameter("speed_mps", value=speed)]
            (result,) = wait_for(sliders.set_parameters(change)).results
            if not result.successful:
                print("rejected:", result.reason)
        executor.spin_for(1_000_000_000)
        report(second)
