"""The files of the project, for the tests of it as a whole."""

import os
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]

# What builds and runs leave behind.
_MADE = {".git", "build", "out", "node_modules", "__pycache__"}


def files():
    """Every file of the project, relative to ROOT, in order."""
    found = []
    for folder, folders, names in os.walk(ROOT):
        folders[:] = [name for name in folders if name not in _MADE]
        # .git is a file in a work tree.
        found += [pathlib.Path(folder, name).relative_to(ROOT)
                  for name in names if name not in _MADE]
    return sorted(found)


def text(path):
    """The text of a file, or None where it is not text."""
    try:
        return (ROOT / path).read_text("utf-8")
    except UnicodeDecodeError:
        return None
