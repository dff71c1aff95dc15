"""Lines of text from a stream of bytes."""

_MAX_BYTES = 1 << 20


class LineSplitter:
    """Splits chunks of bytes into lines; a line of over 1 MiB is split itself."""

    def __init__(self) -> None:
        self._rest = b""

    def feed(self, data: bytes) -> list[str]:
        """Return the lines completed by ``data``, without line ends."""
        *lines, rest = (self._rest + data).split(b"\n")
        if len(rest) > _MAX_BYTES:
            lines.append(rest)
            rest = b""
        self._rest = rest
        return [line.decode("utf-8", "replace").rstrip("\r") for line in lines]

    def finish(self) -> list[str]:
        """Return the last line if it has no line end."""
        return self.feed(b"\n") if self._rest else []
