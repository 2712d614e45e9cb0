"""Runs the marrow command, and reads what it writes.

MARROW_BIN names the folder of the programs, MARROW_JOBS how many meshes are
segmented at once: two, where it is not set.
"""

import datetime
import json
import os
import pathlib
import subprocess
import sys

import numpy

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = pathlib.Path(os.environ.get("MARROW_BIN", ROOT / "build/release/bin"))

PARAMETERS = ["--method", "merge"]

# The files STEM.CUT.seg and STEM.CUT.png of the automatic cut.
AUTOMATIC_CUT = "cut"

MESH_SUFFIXES = {".off", ".obj", ".ply", ".stl", ".glb", ".gltf", ".drc"}


def fail(message):
    """Ends the program as ./dev does."""
    print(f"dev: {message}", file=sys.stderr)
    sys.exit(1)


def jobs():
    return int(os.environ.get("MARROW_JOBS", "2"))


def meshes_below(folder):
    """All mesh files of a folder and the folders in it, in order."""
    return sorted(path for path in pathlib.Path(folder).rglob("*")
                  if path.suffix.lower() in MESH_SUFFIXES)


def sample(name, path, faces, pose="rest"):
    """Writes a sample creature; returns the names of its parts and the part
    of every face."""
    path.parent.mkdir(parents=True, exist_ok=True)
    parts = path.with_suffix(".parts")
    told = subprocess.run(
        [BIN / "marrow", "sample", name, "--pose", pose, "--faces", str(faces),
         "-o", path, "--parts", parts],
        capture_output=True, text=True, check=True).stdout
    names = [line.split()[1] for line in told.splitlines()
             if line.startswith("  ")]
    return names, read_labels(parts)


def segment(files, folder, *options):
    """Segments files of different stems into a folder."""
    stems = [path.stem for path in files]
    if len(set(stems)) != len(stems):
        fail(f"two of the files for {folder} have one name but for their "
             "folder or extension: rename one")
    folder.mkdir(parents=True, exist_ok=True)
    command = [BIN / "marrow", "segment", *files, *PARAMETERS, *options,
               "--threads", str(jobs()), "--quiet", "-o", folder]
    if subprocess.run(command).returncode != 0:
        fail("marrow could not segment all files; see above")


def read_labels(path):
    return numpy.loadtxt(path, dtype=numpy.int64, ndmin=1)


def write_labels(path, labels):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("".join(f"{label}\n" for label in labels))


def read_answer(folder, stem):
    return json.loads((folder / f"{stem}.json").read_text("utf-8"))


def cut_labels(folder, stem, cut=AUTOMATIC_CUT):
    """A label a face of the file, of a cut or level that marrow wrote."""
    return read_labels(folder / f"{stem}.{cut}.seg")


def deepest_level(answer):
    return answer["levels"][-1]["level"]


def commit():
    """The last commit of what is measured, and whether it has been changed
    since."""
    def git(*words):
        return subprocess.run(
            ["git", "-C", ROOT, *words, "--", "core", "server", "client",
             "proto"], text=True, capture_output=True).stdout.strip()
    changed = " with changes" if git("status", "--porcelain") else ""
    return (git("log", "-1", "--format=%h") or "unknown") + changed


def occasion():
    """When, of what and how it was measured: a sentence."""
    today = datetime.date.today().isoformat()
    return (f"Measured on {today} at commit {commit()} with "
            f"`{' '.join(PARAMETERS)}`, all else at its default.")
