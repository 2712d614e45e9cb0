"""Limbs of a creature glued to what they come near to: short-circuits of its
surface.

Two vertices of six faces each are taken out with those faces, and the holes
joined by a tube.
"""

import numpy

import surface as surfaces

_SIDES = 6
MAX_SHARE = 0.02  # of the area, that a tube may have


def rings(faces):
    """Vertex -> its neighbours in order around it, for those inside the
    surface that have six."""
    following = {}
    for face in faces.tolist():
        for corner in range(3):
            ahead = following.setdefault(face[corner], {})
            ahead[face[(corner + 1) % 3]] = face[(corner + 2) % 3]
    found = {}
    for vertex, ahead in following.items():
        ring = [next(iter(ahead))]
        while len(ring) < len(ahead) and ahead.get(ring[-1]) is not None:
            ring.append(ahead[ring[-1]])
        if len(ring) == _SIDES and ahead.get(ring[-1]) == ring[0]:
            found[vertex] = ring
    return found


def tube(surface, ring_a, ring_b):
    """Points and faces of a tube from one ring to another, which runs around
    its hole the other way; about as fine as the rings."""
    points, _ = surface
    ring_b = ring_b[::-1]
    turns = [numpy.roll(ring_b, turn) for turn in range(_SIDES)]
    ring_b = min(turns, key=lambda ring: numpy.linalg.norm(
        points[ring] - points[ring_a], axis=1).sum())
    length = numpy.linalg.norm(points[ring_b] - points[ring_a], axis=1).mean()
    steps = max(1, round(length / surfaces.mean_edge(surface)))
    shares = numpy.arange(1, steps)[:, None, None] / steps
    added = points[ring_a] * (1 - shares) + points[ring_b] * shares
    inner = numpy.arange(added.size // 3).reshape(-1, _SIDES) + len(points)
    hoops = [numpy.array(ring_a), *inner, numpy.array(ring_b)]
    faces = []
    for here, there in zip(hoops, hoops[1:]):
        after_here, after_there = numpy.roll(here, -1), numpy.roll(there, -1)
        faces += [numpy.stack([here, after_here, there], axis=1),
                  numpy.stack([after_here, after_there, there], axis=1)]
    return added.reshape(-1, 3), numpy.concatenate(faces)


def glue(surface, zone_a, zone_b):
    """Joins the nearest two fitting vertices of two sets of vertices.

    Returns the glued surface, the old faces that are its first (the others are
    the tube's), and the tube's share of the area. None where that would be
    above MAX_SHARE.
    """
    points, faces = surface
    ring_of = rings(faces)
    a = numpy.array(sorted(ring_of.keys() & set(zone_a)), dtype=numpy.int64)
    b = numpy.array(sorted(ring_of.keys() & set(zone_b)), dtype=numpy.int64)
    gaps = numpy.linalg.norm(points[a][:, None] - points[b][None], axis=2)
    # Nearer than that, the holes could touch.
    gaps[gaps < 3 * surfaces.mean_edge(surface)] = numpy.inf
    row, column = numpy.unravel_index(gaps.argmin(), gaps.shape)
    ends = a[row], b[column]
    added, tube_faces = tube(surface, ring_of[ends[0]], ring_of[ends[1]])
    kept = numpy.flatnonzero(~numpy.isin(faces, ends).any(axis=1))
    all_points = numpy.concatenate([points, added])
    share = (surfaces.face_areas((all_points, tube_faces)).sum()
             / surfaces.face_areas(surface).sum())
    if not numpy.isfinite(gaps[row, column]) or share > MAX_SHARE:
        return None
    joined = numpy.concatenate([faces[kept], tube_faces])
    used, numbers = numpy.unique(joined, return_inverse=True)
    return (all_points[used], numbers.reshape(-1, 3)), kept, share
