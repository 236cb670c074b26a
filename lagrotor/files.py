"""Writing a file whole or not at all."""

import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import IO, Any

from lagrotor.errors import InputError

PICTURES, FILMS = (".png", ".svg", ".pdf"), (".gif", ".mp4")


def write_beside(target: Path, write: Callable[[IO[bytes]], Any]) -> Path:
    """Let `write` fill a file beside `target`, then rename it: readers see the old file or the new, never half of one.

    Raises InputError when the folder is missing or cannot be written to.
    """
    try:
        handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.")
    except OSError as error:
        raise InputError(f"{target}: {error.strerror}: choose an existing folder that can be written to") from None
    try:
        with os.fdopen(handle, "wb") as file:
            write(file)
        umask = os.umask(0)
        os.umask(umask)
        os.chmod(name, 0o666 & ~umask)
        os.replace(name, target)
    except OSError as error:
        raise InputError(f"{target}: {error.strerror}: choose another file") from None
    finally:
        Path(name).unlink(missing_ok=True)
    return target


def write_text(target: Path, text: str) -> Path:
    """Write UTF-8 text whole or not at all."""
    return write_beside(target, lambda file: file.write(text.encode()))
