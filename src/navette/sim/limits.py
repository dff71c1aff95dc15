# SPDX-License-Identifier: Apache-2.0
"""Limits on the parts of a world or robot file, checked before it is compiled.

A small file can describe a model that no machine simulates: 20,000 joints, or nested
replicas. The limits are far above real robots and worlds.
"""

import math
from collections import Counter

from navette.sim.xml_tree import XmlNode

#: Largest number of parts in a file, by tag.
_MOST = {
    "model": 10_000,
    "link": 20_000,
    "body": 20_000,
    "collision": 50_000,
    "visual": 50_000,
    "geom": 50_000,
    "light": 1000,
    "camera": 100,
    "include": 1000,
    "sensor": 200,
}
#: Largest number of links of one robot or other moving model, and of joints in MJCF:
#: the time of a physics step grows with their square.
MOST_MOVING = 300
_JOINTS = ("joint", "freejoint")
_MOST_CELLS = 1 << 24  # of a height field or a texture
_MOST_MEMORY = 1 << 30  # bytes
_MOST_ITERATIONS = 1000
_UNITS = {"K": 1 << 10, "M": 1 << 20, "G": 1 << 30, "T": 1 << 40}


class PartCounter:
    """Counts the parts of a file and of the files it includes."""

    def __init__(self) -> None:
        self._count: Counter[str] = Counter()

    def add(self, node: XmlNode, kind: str, count: int = 1) -> None:
        """Count parts of a kind.

        Raises:
            FileFormatError: more than allowed.
        """
        most = MOST_MOVING if kind in _JOINTS else _MOST.get(kind)
        if most is None:
            return
        kind = "joint" if kind in _JOINTS else kind
        self._count[kind] += count
        if self._count[kind] > most:
            raise node.error(f"more than {most} parts <{kind}>")


def check_parts(root: XmlNode) -> None:
    """Check the numbers of parts of an SDF or URDF file.

    Raises:
        FileFormatError: more than allowed.
    """
    counter = PartCounter()
    pending = [root]
    while pending:
        node = pending.pop()
        pending += node.children
        if node.tag not in _JOINTS:
            counter.add(node, node.tag)
        if node.tag in ("model", "robot") and not node.flag("static"):
            links = sum(1 for _ in node.all("link"))
            if links > MOST_MOVING:
                raise node.error(
                    f"{links} links; a moving model may have at most {MOST_MOVING}"
                )


def check_mjcf_parts(node: XmlNode, counter: PartCounter, times: int = 1) -> None:
    """Check the numbers of parts of an MJCF file, generated ones included.

    Raises:
        FileFormatError: more than allowed.
    """
    counter.add(node, node.tag, times)
    _check_sizes(node)
    if node.tag == "replicate":
        times *= max(1, _product(node, "count"))
    elif node.tag in ("composite", "flexcomp"):
        generated = times * _product(node, "count")
        for kind in ("body", "joint"):
            counter.add(node, kind, generated)
    if times > _MOST["geom"]:
        raise node.error(f"{times} replicas; at most {_MOST['geom']} are allowed")
    for child in node.children:
        check_mjcf_parts(child, counter, times)


def _check_sizes(node: XmlNode) -> None:
    if node.tag == "hfield":
        cells = _product(node, "nrow") * _product(node, "ncol")
    elif node.tag == "texture":
        cells = _product(node, "width") * _product(node, "height")
    else:
        cells = 0
    if cells > _MOST_CELLS:
        raise node.error(f"{cells} cells; at most {_MOST_CELLS} are allowed")
    if node.tag == "size":
        for key in node.attributes:
            if _bytes(node, key) > _MOST_MEMORY:
                raise node.error(
                    f"{key}={node.attributes[key]!r}; at most {_MOST_MEMORY} allowed"
                )
    if node.tag == "option":
        for key in node.attributes:
            if key.endswith("iterations") and _product(node, key) > _MOST_ITERATIONS:
                raise node.error(
                    f"{key}={node.attributes[key]!r}; at most {_MOST_ITERATIONS}"
                )


def _product(node: XmlNode, key: str) -> int:
    """Return the product of the integers of an attribute; 1 without it."""
    try:
        return math.prod(int(word) for word in node.attributes.get(key, "1").split())
    except ValueError:
        raise node.error(f"{key}={node.attributes[key]!r}; expected integers") from None


def _bytes(node: XmlNode, key: str) -> float:
    text = node.attributes[key].strip()
    unit = _UNITS.get(text[-1:].upper(), 1)
    try:
        return float(text[:-1] if unit > 1 else text) * unit
    except ValueError:
        return 0  # MuJoCo names what is wrong
