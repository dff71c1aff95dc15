"""A chain of three nodes: raw samples are validated, batched and summarized.

Each node owns an algorithm that is independent of topics; the message types are defined
at run time.

Prints::

    batch of 3 at 0.5 s: mean [2.3, 2.0, 3.0]
    batch of 3 at 0.9 s: mean [6.0, 2.0, 3.0]
    7 samples in 0.9 s, 1 rejected, 2 batches
"""

import tempfile
from pathlib import Path

import numpy as np

import navette
from navette.msgs import get_interface, load_interfaces

TYPES = {
    "Raw": "bool valid\nstring data  # x:1;y:2;z:3\nbuiltin_interfaces/Time stamp",
    "Sample": "float64 x\nfloat64 y\nfloat64 z\nbuiltin_interfaces/Time stamp",
    "Batch": "Sample[] samples",
}

with tempfile.TemporaryDirectory() as folder:
    (Path(folder) / "msg").mkdir()
    for name, text in TYPES.items():
        (Path(folder) / "msg" / f"{name}.msg").write_text(text)
    load_interfaces("chain_msgs", folder)
    Raw, Sample, Batch = (get_interface(f"chain_msgs/msg/{name}") for name in TYPES)


class Batcher:
    """Collects valid samples in batches and counts rejected ones."""

    def __init__(self, size):
        self.size, self.samples, self.rejected = size, [], 0

    def add(self, raw):
        """Add a sample; return the batch that it completes, or None."""
        if not raw.valid:
            self.rejected += 1
            return None
        pairs = (part.split(":") for part in raw.data.split(";"))
        values = {name: float(value) for name, value in pairs}
        self.samples.append(Sample(**values, stamp=raw.stamp))
        if len(self.samples) < self.size:
            return None
        batch, self.samples = self.samples, []
        return batch


class Producer(navette.Node):
    def __init__(self):
        super().__init__("producer")
        self.publisher = self.create_publisher(Raw, "/raw", 10)
        self.create_timer(0.125, self.produce)
        self.count = 0

    def produce(self):
        self.count += 1
        raw = Raw(valid=self.count != 3, data=f"x:{self.count};y:2;z:3")
        raw.stamp = self.get_clock().now().to_msg()
        self.publisher.publish(raw)


class Transformer(navette.Node):
    def __init__(self):
        super().__init__("transformer")
        self.batcher = Batcher(self.declare_parameter("batch_size", 3).value)
        self.publisher = self.create_publisher(Batch, "/batches", 10)
        self.create_subscription(Raw, "/raw", self.on_raw, 10)

    def on_raw(self, message):
        batch = self.batcher.add(message)
        if batch is not None:
            self.publisher.publish(Batch(samples=batch))


class Aggregator(navette.Node):
    def __init__(self):
        super().__init__("aggregator")
        self.raw = self.batches = 0
        self.create_subscription(Raw, "/raw", self.on_raw, 10)
        self.create_subscription(Batch, "/batches", self.on_batch, 10)

    def on_raw(self, message):
        self.raw += 1

    def on_batch(self, message):
        self.batches += 1
        mean = np.mean([(s.x, s.y, s.z) for s in message.samples], axis=0)
        seconds = message.samples[-1].stamp.nanosec / 1e9
        size = len(message.samples)
        print(f"batch of {size} at {seconds:.1f} s: mean {mean.round(1).tolist()}")


with navette.init(clock=navette.VirtualClock()):
    executor = navette.SingleThreadedExecutor()
    transformer, aggregator = Transformer(), Aggregator()
    for node in (Producer(), transformer, aggregator):
        executor.add_node(node)
    executor.spin_for(900_000_000)
    print(
        f"{aggregator.raw} samples in 0.9 s, {transformer.batcher.rejected} rejected, "
        f"{aggregator.batches} batches"
    )
