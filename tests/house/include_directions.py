"""The direction of includes: which folder may include which, and what only
named files may include. ARCHITECTURE.md gives the rules in words.

    include_directions.py ROOT   prints the violations in ROOT; 1 where any
"""

import pathlib
import re
import sys

# A folder of core includes itself and those before it.
CORE = (
    "base", "mesh", "operators", "spectrum", "diffusion", "pieces",
    "boundaries", "hierarchy", "skeleton", "pipeline",
)

# Never in core, at the start of what is included.
SERVICE_HEADERS = (
    "grpc/", "grpcpp/", "google/protobuf/", "google/rpc/", "hiredis/",
    "marrow/v1/", "sw/redis", "sys/socket.h", "netinet/",
)

# The folders of core that a folder may include; the longest match counts.
CORE_OF = {
    "core": CORE,
    "server": CORE,
    # Status macros, digests, checksums: no geometry.
    "client": ("base",),
    # A .drc file from a stranger is read behind core's checks.
    "client/encoder": ("base", "mesh"),
}

# Other top-level folders that each may include.
FOLDERS = {
    "core": ("core",),
    "server": ("core", "server"),
    "client": ("core", "client", "server"),
}

# A library or folder, and how many files may include it and where.
FEW = (
    ("Spectra", "Spectra/", {"core/spectrum": 1}),
    ("Draco", "draco/", {"core/mesh": 1, "client": 1}),
    ("the embedded server", "server/", {"client": 1, "server": None}),
)

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)
# A grpc::Status made from a code: the conversion has one home.
MAKES_STATUS = re.compile(r"\bgrpc::Status[({]\s*(?:static_cast<)?grpc::Status")
STATUS_HOME = "server/status.cc"


def sources(root):
    for top in FOLDERS:
        for path in sorted((root / top).rglob("*")):
            if path.suffix in (".cc", ".h"):
                yield path.relative_to(root), path.read_text("utf-8")


def rooms(path):
    """The folders of core that a file may include."""
    return CORE_OF[max((folder for folder in CORE_OF
                        if path.is_relative_to(folder)), key=len)]


def folder_violation(path, included):
    """What is wrong with the including of one header, or None."""
    top, first = path.parts[0], included.split("/")[0]
    if top == "core" and included.startswith(SERVICE_HEADERS):
        return "core knows nothing of gRPC, protobuf, sockets or Redis"
    if first not in (*FOLDERS, "tests"):
        return None
    if first not in FOLDERS[top]:
        return f"{top} must not include {first}"
    if first != "core":
        return None
    room = included.split("/")[1]
    if room not in CORE:
        return f"core/{room} is not a folder of core"
    if room not in rooms(path):
        return f"{top} must not include core/{room}"
    if top == "core" and CORE.index(room) > CORE.index(path.parts[1]):
        return f"core/{path.parts[1]} stands before core/{room}"
    return None


def few_violations(files):
    """Libraries that more files include than may."""
    for name, prefix, homes in FEW:
        users = {}
        for path, includes in files:
            if any(i.startswith(prefix) for i in includes):
                home = next((h for h in homes if path.is_relative_to(h)), None)
                users.setdefault(home, []).append(str(path))
        for path in users.pop(None, []):
            yield f"{path}: must not include {name}"
        for home, paths in users.items():
            if homes[home] is not None and len(paths) > homes[home]:
                yield (f"{', '.join(paths)}: {homes[home]} file of {home} may "
                       f"include {name}, not {len(paths)}")


def violations(root):
    root = pathlib.Path(root)
    found, files = [], []
    for path, text in sources(root):
        includes = INCLUDE.findall(text)
        files.append((path, includes))
        for included in includes:
            wrong = folder_violation(path, included)
            if wrong:
                found.append(f"{path}: includes {included}: {wrong}")
        if MAKES_STATUS.search(text) and str(path) != STATUS_HOME:
            found.append(f"{path}: makes a grpc::Status: only {STATUS_HOME} "
                         "turns an absl::Status into one")
    return found + list(few_violations(files))


if __name__ == "__main__":
    wrong = violations(sys.argv[1])
    print("\n".join(wrong) or "every include goes the right way")
    sys.exit(1 if wrong else 0)
