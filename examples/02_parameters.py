"""Parameters: declare a default, set from a file, change while running.

Prints::

    after 1 s: 0.5 m
    /cart: speed_mps is now 2.0
    after 2 s: 2.5 m
    rejected: parameter 'speed_mps': 9.0 is out of range 0 … 2
"""

import tempfile
from pathlib import Path

import navette
from navette import Parameter
from navette.msgs.rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor

SETTINGS = """
cart:
  ros__parameters:
    speed_mps: 0.5
"""


class Cart(navette.Node):
    def __init__(self):
        super().__init__("cart")
        allowed = FloatingPointRange(from_value=0.0, to_value=2.0)
        descriptor = ParameterDescriptor(floating_point_range=[allowed])
        self.declare_parameter("speed_mps", 1.0, descriptor)
        self.add_post_set_parameters_callback(self.on_changed)
        self.create_timer(0.1, self.on_timer)
        self.distance = 0.0

    def on_changed(self, parameters):
        for parameter in parameters:
            name = self.get_fully_qualified_name()
            print(f"{name}: {parameter.name} is now {parameter.value}")

    def on_timer(self):
        self.distance += 0.1 * self.get_parameter("speed_mps").value


with tempfile.TemporaryDirectory() as folder:
    file = Path(folder) / "settings.yaml"
    file.write_text(SETTINGS)
    arguments = ["--ros-args", "--params-file", str(file)]
    navette.init(args=arguments, clock=navette.VirtualClock())
cart = Cart()
executor = navette.SingleThreadedExecutor()
executor.add_node(cart)
executor.spin_for(1_000_000_000)
print(f"after 1 s: {cart.distance:.1f} m")
cart.set_parameters([Parameter("speed_mps", value=2.0)])
executor.spin_for(1_000_000_000)
print(f"after 2 s: {cart.distance:.1f} m")
(result,) = cart.set_parameters([Parameter("speed_mps", value=9.0)])
print("rejected:", result.reason)
navette.shutdown()
