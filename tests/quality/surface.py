"""Triangle surfaces as arrays, and what disturbs them.

A surface is (points, faces): n x 3 float64 and m x 3 int64. What disturbs one
returns the disturbed surface and says how its faces lie in the old one's.
"""

import ctypes
import ctypes.util

import numpy

import segmenting

# Cells that a face is divided into, along an edge, to be found by its points.
_SPLIT = 4


def read_off(path):
    words = path.read_text("ascii").split()
    if words[0] != "OFF":
        segmenting.fail(f"{path} is not an OFF file")
    num_points, num_faces = int(words[1]), int(words[2])
    end = 4 + 3 * num_points
    points = numpy.array(words[4:end], dtype=numpy.float64).reshape(-1, 3)
    rows = numpy.array(words[end:end + 4 * num_faces], dtype=numpy.int64)
    return points, rows.reshape(-1, 4)[:, 1:]


def read_coloured(path):
    """The mesh of a STEM.level-N.ply of marrow's, points at one position made
    one; None where a face is no triangle."""
    data = path.read_bytes()
    header, body = data.split(b"end_header\n", 1)
    counts = [int(line.split()[2]) for line in header.decode().splitlines()
              if line.startswith("element")]
    width = "<f8" if b"property double x\n" in header else "<f4"
    point = numpy.dtype([("at", width, 3), ("colour", "u1", 3)])
    face = numpy.dtype([("corners", "u1"), ("at", "<i4", 3),
                        ("colour", "u1", 3)])
    if len(body) != counts[0] * point.itemsize + counts[1] * face.itemsize:
        return None
    points = numpy.frombuffer(body, point, counts[0])["at"]
    faces = numpy.frombuffer(body, face, counts[1],
                             offset=counts[0] * point.itemsize)["at"]
    points, numbers = numpy.unique(points, axis=0, return_inverse=True)
    return points.astype(numpy.float64), numbers[faces].astype(numpy.int64)


def write_off(path, surface):
    points, faces = surface
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", encoding="ascii") as file:
        file.write(f"OFF\n{len(points)} {len(faces)} 0\n")
        numpy.savetxt(file, points, fmt="%.17g")
        numpy.savetxt(file, numpy.insert(faces, 0, 3, axis=1), fmt="%d")


def area_normals(surface):
    """Normals of the faces, each as long as its face is large."""
    points, faces = surface
    a, b, c = (points[faces[:, corner]] for corner in range(3))
    return numpy.cross(b - a, c - a) / 2


def face_areas(surface):
    return numpy.linalg.norm(area_normals(surface), axis=1)


def edges(faces):
    """Each edge once, the lesser point first."""
    sides = numpy.concatenate([faces[:, [0, 1]], faces[:, [1, 2]],
                               faces[:, [2, 0]]])
    return numpy.unique(numpy.sort(sides, axis=1), axis=0)


def mean_edge(surface):
    points, faces = surface
    ends = edges(faces)
    return numpy.linalg.norm(points[ends[:, 0]] - points[ends[:, 1]],
                             axis=1).mean()


def add_noise(surface, share, seed=1):
    """Points moved along their normals, by a Gaussian whose deviation is that
    share of the mean edge. Faces stay."""
    points, faces = surface
    normals = numpy.zeros_like(points)
    of_faces = area_normals(surface)
    for corner in range(3):
        numpy.add.at(normals, faces[:, corner], of_faces)
    length = numpy.linalg.norm(normals, axis=1, keepdims=True)
    normals /= numpy.where(length > 0, length, 1)
    steps = numpy.random.default_rng(seed).standard_normal((len(points), 1))
    return points + steps * share * mean_edge(surface) * normals, faces


def without_faces(surface, share, seed=1):
    """That share of the faces missing, at random."""
    points, faces = surface
    kept = numpy.random.default_rng(seed).random(len(faces)) >= share
    return points, faces[kept]


def subdivide(surface):
    """Every face divided into four at the middles of its edges: new face f is
    in old face f // 4."""
    points, faces = surface
    ends, numbers = numpy.unique(
        numpy.sort(faces[:, [[0, 1], [1, 2], [2, 0]]], axis=2).reshape(-1, 2),
        axis=0, return_inverse=True)
    middles = points[ends].mean(axis=1)
    ab, bc, ca = (len(points) + numbers.reshape(-1, 3)).T
    a, b, c = faces.T
    children = numpy.stack([numpy.stack(child, axis=1) for child in (
        (a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))], axis=1)
    return numpy.concatenate([points, middles]), children.reshape(-1, 3)


def _simplifier():
    name = ctypes.util.find_library("meshoptimizer")
    return name and ctypes.CDLL(name).meshopt_simplify


def can_decimate():
    return bool(_simplifier())


def decimate(surface, share):
    """About that share of the faces, by meshoptimizer's quadric edge
    collapse."""
    points, faces = surface
    simplify = _simplifier()
    if not simplify:
        segmenting.fail("libmeshoptimizer is missing: run ./dev setup")
    centre, size = points.mean(axis=0), numpy.ptp(points, axis=0).max()
    places = numpy.ascontiguousarray((points - centre) / size, numpy.float32)
    corners = numpy.ascontiguousarray(faces.ravel(), numpy.uint32)
    kept = numpy.empty_like(corners)
    simplify.restype = ctypes.c_size_t
    simplify.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_size_t,
                         ctypes.c_void_p, ctypes.c_size_t, ctypes.c_size_t,
                         ctypes.c_size_t, ctypes.c_float, ctypes.c_uint,
                         ctypes.c_void_p]
    count = simplify(kept.ctypes.data, corners.ctypes.data, len(corners),
                     places.ctypes.data, len(places), 12,
                     3 * round(len(faces) * share), 1.0, 0, None)
    used, numbers = numpy.unique(kept[:count], return_inverse=True)
    return points[used], numbers.reshape(-1, 3)


def points_on_faces(surface):
    """The centres of the cells that each face is divided into, and the face
    of each."""
    points, faces = surface
    grid = [(i + shift, j + shift)
            for i in range(_SPLIT) for j in range(_SPLIT)
            for shift in (1 / 3, 2 / 3)
            if i + j + 2 * shift < _SPLIT]
    a, b, c = (points[faces[:, corner]] for corner in range(3))
    cells = [a + (b - a) * (i / _SPLIT) + (c - a) * (j / _SPLIT)
             for i, j in grid]
    return (numpy.concatenate(cells),
            numpy.tile(numpy.arange(len(faces)), len(cells)))


def nearest_faces(surface, other):
    """For every face of `surface` the face of `other` that is nearest to its
    centre, or hardly farther."""
    from scipy.spatial import cKDTree
    points, faces = surface
    centres = points[faces].mean(axis=1)
    places, owners = points_on_faces(other)
    return owners[cKDTree(places).query(centres)[1]]
