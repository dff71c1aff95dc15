"""What a process writes, as whole lines of text."""

_LONGEST = 1 << 20


class LineCutter:
    """Cuts bytes, as they come, into lines; a line of over 1 MiB is cut itself."""

    def __init__(self) -> None:
        self._rest = b""

    def feed(self, data: bytes) -> list[str]:
        """The lines that are whole now, without their ends."""
        *lines, rest = (self._rest + data).split(b"\n")
        if len(rest) > _LONGEST:
            lines.append(rest)
            rest = b""
        self._rest = rest
        return [line.decode("utf-8", "replace").rstrip("\r") for line in lines]

    def finish(self) -> list[str]:
        """What has no end of line yet."""
        return self.feed(b"\n") if self._rest else []
