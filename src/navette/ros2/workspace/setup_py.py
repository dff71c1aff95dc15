"""Reader of setup.py that does not run it.

Constants, names, f-strings, sums, ``os.path.join`` and ``glob`` are evaluated; other
expressions are ignored.
"""

import ast
import glob
from dataclasses import dataclass
from pathlib import Path

from navette.errors import FileFormatError


@dataclass(frozen=True, slots=True)
class SetupPy:
    """The arguments of the ``setup()`` call.

    Attributes:
        folder: folder of setup.py, to which patterns are relative.
        names: texts that the module assigns to names.
    """

    folder: Path
    arguments: dict[str, ast.expr]
    names: dict[str, str]

    def text(self, node: ast.expr) -> str | None:
        """Return the text of an expression; None if it cannot be evaluated."""
        return _text(node, self.names)

    def texts(self, node: ast.expr) -> list[str]:
        """Return the texts of lists, sums of lists, and glob patterns."""
        if isinstance(node, (ast.List, ast.Tuple)):
            found = (self.text(item) for item in node.elts)
            return [text for text in found if text is not None]
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
            return [*self.texts(node.left), *self.texts(node.right)]
        if isinstance(node, ast.Call) and _called_name(node) == "glob" and node.args:
            return self._glob(self.text(node.args[0]), node.keywords)
        return []

    def _glob(self, pattern: str | None, options: list[ast.keyword]) -> list[str]:
        if not pattern or Path(pattern).is_absolute():
            return []
        # Not Path.glob: it refuses patterns such as `launch/[!_]**`.
        recursive = any(
            option.arg == "recursive" and getattr(option.value, "value", False)
            for option in options
        )
        return sorted(glob.glob(pattern, root_dir=self.folder, recursive=recursive))  # noqa: PTH207 - see above


def read_setup_py(path: Path) -> SetupPy | None:
    """Read a setup.py; return None without a file or without a call of ``setup()``.

    Raises:
        FileFormatError: the file is not valid Python; names the line.
    """
    if not path.is_file():
        return None
    try:
        tree = ast.parse(path.read_text(encoding="utf-8"))
    except SyntaxError as error:
        raise FileFormatError(path, error.msg, error.lineno) from None
    for call in ast.walk(tree):
        if isinstance(call, ast.Call) and _called_name(call) == "setup":
            arguments = {k.arg: k.value for k in call.keywords if k.arg is not None}
            return SetupPy(path.parent, arguments, _constants(tree))
    return None


def _called_name(call: ast.Call) -> str:
    function = call.func
    return getattr(function, "id", "") or getattr(function, "attr", "")


def _constants(tree: ast.Module) -> dict[str, str]:
    found: dict[str, str] = {}
    for node in tree.body:
        if isinstance(node, ast.Assign) and len(node.targets) == 1:
            target, text = node.targets[0], _text(node.value, found)
            if isinstance(target, ast.Name) and text is not None:
                found[target.id] = text
    return found


def _text(node: ast.expr, names: dict[str, str]) -> str | None:
    if isinstance(node, ast.Constant):
        return node.value if isinstance(node.value, str) else None
    if isinstance(node, ast.Name):
        return names.get(node.id)
    if isinstance(node, ast.FormattedValue):
        return _text(node.value, names)
    parts: list[ast.expr] = []
    between = ""
    if isinstance(node, ast.JoinedStr):
        parts = node.values
    elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
        parts = [node.left, node.right]
    elif isinstance(node, ast.Call) and _called_name(node) == "join":
        parts, between = node.args, "/"
    texts = [_text(part, names) for part in parts]
    if not texts or None in texts:
        return None
    return between.join(text or "" for text in texts)
