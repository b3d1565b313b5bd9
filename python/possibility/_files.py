"""Files of scenarios that are built in code."""

from __future__ import annotations

import json
import os
import re
import tempfile
from pathlib import Path
from typing import Any, Mapping

import numpy as np

_folder: "tempfile.TemporaryDirectory[str] | None" = None
_count = 0


def _temporary_folder() -> Path:
    global _folder
    if _folder is None:
        _folder = tempfile.TemporaryDirectory(prefix="possibility-")
    return Path(_folder.name)


def is_temporary(file: str) -> bool:
    return _folder is not None and Path(file).parent.parent == Path(_folder.name)


def _plain(value: Any) -> Any:
    if isinstance(value, (np.generic, np.ndarray)):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise TypeError(f"scenario: a {type(value).__name__} is no number, text, list or dict")


def _with_absolute_paths(value: Any, folder: Path, key: str = "") -> Any:
    """Paths are those at 'robot' and 'file'."""
    if isinstance(value, Mapping):
        return {k: _with_absolute_paths(v, folder, k) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [_with_absolute_paths(v, folder) for v in value]
    if key in ("robot", "file") and isinstance(value, (str, os.PathLike)):
        return os.path.normpath(folder / value)
    return value


def temporary_scenario(description: Mapping[str, Any], folder: Path) -> Path:
    """The description as a YAML file (JSON is YAML) in a folder of this process."""
    global _count
    _count += 1
    file = _temporary_folder() / str(_count) / "scenario.yaml"
    file.parent.mkdir()
    text = json.dumps(_with_absolute_paths(description, folder.absolute()), default=_plain,
                      ensure_ascii=False, indent=1)
    file.write_text(text + "\n", encoding="utf-8")
    return file


def without_file(message: str, file: Path) -> str:
    """The reader's message about a dict, which has no file and no lines."""
    return re.sub(re.escape(str(file)) + r"(:\d+)?", "scenario", message)
