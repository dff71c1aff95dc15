"""Hash of a type's description, ``RIHS01_…`` (REP 2016)."""

from dataclasses import dataclass

_SIZE = 32


@dataclass(frozen=True)
class TypeHash:
    """Version and 32 bytes of a type hash; version -1 means unknown."""

    version: int = -1
    value: bytes = bytes(_SIZE)

    @classmethod
    def parse(cls, text: str) -> "TypeHash":
        """Parse ``RIHS01_<64 hexadecimal digits>``."""
        head, _, digits = text.partition("_")
        return cls(int(head.removeprefix("RIHS")), bytes.fromhex(digits))

    def __str__(self) -> str:
        if self.version < 0:
            return "INVALID"
        return f"RIHS{self.version:02d}_{self.value.hex()}"
