"""A loop in the program: ``ok``, ``spin_once`` and a ``Rate``, as in older programs.

A timer is usually the better choice. The loop below does its own work and runs one due
callback per iteration.

Prints::

    0.1 s: 1 tick
    0.2 s: 2 ticks
    0.3 s: 3 ticks
    after shutdown: ok() is False
"""

import navette

navette.init(clock=navette.VirtualClock())
node = navette.Node("loop")
ticks = []
node.create_timer(0.1, lambda: ticks.append(node.get_clock().now()))
rate = node.create_rate(10.0)  # Hz

while navette.ok():
    rate.sleep()
    navette.spin_once(node, timeout_sec=0.0)  # one due callback, without waiting
    seconds = node.get_clock().now().nanoseconds / 1e9
    print(f"{seconds:.1f} s: {len(ticks)} tick{'s' if len(ticks) > 1 else ''}")
    if len(ticks) == 3:
        navette.shutdown()
print("after shutdown: ok() is", navette.ok())
