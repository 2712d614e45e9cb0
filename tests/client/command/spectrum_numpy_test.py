"""What `marrow spectrum -o` writes, as NumPy reads it.

Usage: spectrum_numpy_test.py BIN_FOLDER
"""

import io
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import numpy as np

MARROW = os.path.join(sys.argv.pop(1), "marrow")
MARROWD = MARROW + "d"
RADIUS = 3.0


def wait_for_watch(pid):
    """Until a process has blocked SIGINT, to wait for it by itself."""
    while True:
        with open(f"/proc/{pid}/status", encoding="ascii") as status:
            blocked = next(line for line in status if line.startswith("SigBlk"))
        if int(blocked.split()[1], 16) >> (signal.SIGINT - 1) & 1:
            return
        time.sleep(0.01)


def sphere(subdivisions):
    """(vertices, faces) of an icosphere of radius RADIUS."""
    golden = (1 + 5 ** 0.5) / 2
    points = [(s, t * golden, 0) for s in (-1, 1) for t in (-1, 1)]
    points += [(0, x, y) for x, y, _ in points] + [(y, 0, x)
                                                  for x, y, _ in points]
    points = np.array(points, dtype=float)
    edge = min(np.linalg.norm(points[0] - p) for p in points[1:])
    near = [[abs(np.linalg.norm(p - q) - edge) < 1e-9 for q in points]
            for p in points]
    faces = [(a, b, c) for a in range(12) for b in range(a) for c in range(b)
             if near[a][b] and near[b][c] and near[a][c]]
    faces = [(a, b, c) if np.linalg.det(points[[a, b, c]]) > 0 else (a, c, b)
             for a, b, c in faces]
    points = list(points)
    for _ in range(subdivisions):
        middles = {}

        def middle(a, b):
            key = min(a, b), max(a, b)
            if key not in middles:
                middles[key] = len(points)
                points.append(points[a] + points[b])
                points[-1] /= np.linalg.norm(points[-1])
            return middles[key]
        points = [p / np.linalg.norm(p) for p in points]
        faces = [face for a, b, c in faces
                 for ab, bc, ca in [(middle(a, b), middle(b, c), middle(c, a))]
                 for face in ((a, ab, ca), (ab, b, bc), (ca, bc, c),
                              (ab, bc, ca))]
    return RADIUS * np.array(points), np.array(faces)


def shuffled(vertices, faces, unused):
    """(vertices, faces, new index of each old vertex): in another order, with
    `unused` vertices in between that no face has."""
    places = list(range(len(vertices) + unused))
    random.Random(7).shuffle(places)
    order = np.array(places[:len(vertices)])
    moved = np.full((len(places), 3), 9.0) + np.arange(len(places))[:, None]
    moved[order] = vertices
    return moved, order[faces], order


def write_off(path, vertices, faces):
    with open(path, "w", encoding="ascii") as file:
        file.write(f"OFF\n{len(vertices)} {len(faces)} 0\n")
        for vertex in vertices:
            file.write(" ".join(map(repr, map(float, vertex))) + "\n")
        for face in faces:
            file.write("3 " + " ".join(map(str, face)) + "\n")


def mass(vertices, faces):
    """A third of the area around each vertex."""
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    result = np.zeros(len(vertices))
    for corner in range(3):
        np.add.at(result, faces[:, corner], areas / 3)
    return result


def marrow(*words, **options):
    return subprocess.run([MARROW, "spectrum", *words], capture_output=True,
                          timeout=120, check=True, **options).stdout


class SpectrumNumpyTest(unittest.TestCase):

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.vertices, self.faces = sphere(4)
        self.mesh = self.path("sphere.off")
        write_off(self.mesh, self.vertices, self.faces)

    def path(self, name):
        return os.path.join(self.folder, name)

    def spectrum(self, *words, mesh=None):
        out = self.path("out.npz")
        marrow(mesh or self.mesh, "-o", out, *words)
        with np.load(out, allow_pickle=False) as archive:
            return dict(archive)

    def test_the_sphere_is_the_sphere(self):
        found = self.spectrum("-k", "24", "--strict")
        exact = [l * (l + 1) / RADIUS**2 for l in range(5)
                 for _ in range(2 * l + 1)]
        np.testing.assert_allclose(found["eigenvalues"], exact, rtol=0.03,
                                   atol=1e-12)
        vectors = found["eigenvectors"]
        self.assertEqual(vectors.shape, (len(self.vertices), 25))
        self.assertEqual(vectors.dtype, np.float64)
        weights = mass(self.vertices, self.faces)
        np.testing.assert_allclose(vectors.T @ (weights[:, None] * vectors),
                                   np.eye(25), atol=1e-8)
        self.assertAlmostEqual(float(found["area"]), weights.sum(), places=6)
        self.assertLessEqual(found["residuals"].max(), 1e-8)
        self.assertEqual(found["count_below_bound"], 25)
        self.assertGreater(found["bound"], found["eigenvalues"][-1])
        self.assertRegex(str(found["solver_revision"]), r"^\w+/\d+$")

    def test_usual_pairs_have_about_the_residual_that_is_promised(self):
        residuals = self.spectrum("-k", "40")["residuals"]
        self.assertEqual(residuals.shape, (41,))
        self.assertLessEqual(residuals.max(), 1e-4)

    def test_rows_are_the_files_vertices(self):
        vertices, faces, order = shuffled(self.vertices, self.faces, unused=5)
        mesh = self.path("shuffled.off")
        write_off(mesh, vertices, faces)
        usual = self.spectrum("-k", "8", "--strict")
        other = self.spectrum("-k", "8", "--strict", mesh=mesh)
        np.testing.assert_array_equal(other["eigenvalues"],
                                      usual["eigenvalues"])
        rows = other["eigenvectors"]
        self.assertEqual(len(rows), len(vertices))
        np.testing.assert_array_equal(rows[order], usual["eigenvectors"])
        unused = np.setdiff1d(np.arange(len(vertices)), order)
        self.assertEqual(len(unused), 5)
        self.assertTrue(np.isnan(rows[unused]).all())

    def test_a_pipe_gets_the_same_bytes_and_nothing_else(self):
        out = self.path("out.npz")
        printed = marrow(self.mesh, "-k", "8", "-o", out)
        self.assertEqual(len(printed.split()), 9)
        piped = marrow(self.mesh, "-k", "8", "-o", "-")
        with open(out, "rb") as file:
            self.assertEqual(piped, file.read())
        with np.load(io.BytesIO(piped)) as archive:
            self.assertEqual(archive["eigenvectors"].shape[1], 9)
        refused = subprocess.run(
            [MARROW, "spectrum", self.mesh, "-o", "-", "--json"],
            capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("name a file", refused.stderr)

    def test_a_server_gives_the_same(self):
        with subprocess.Popen(
                [MARROWD, "--listen", "127.0.0.1:0"], stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT, text=True) as server:
            try:
                port = next(word for line in server.stdout
                            for word in line.replace('"', " ").split()
                            if word.startswith("127.0.0.1:"))
                there = self.spectrum("-k", "8", "--strict", "--server",
                                      port.rstrip(",}"))
            finally:
                server.send_signal(signal.SIGTERM)
        here = self.spectrum("-k", "8", "--strict")
        self.assertEqual(sorted(here), sorted(there))
        for name, value in here.items():
            np.testing.assert_array_equal(there[name], value)

    def test_an_interrupt_leaves_no_file(self):
        vertices, faces = sphere(6)
        mesh = self.path("large.off")
        write_off(mesh, vertices, faces)
        with subprocess.Popen(
                [MARROW, "spectrum", mesh, "-k", "500", "--strict", "-o",
                 self.path("large.npz")], stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL) as command:
            wait_for_watch(command.pid)
            time.sleep(1)
            command.send_signal(signal.SIGINT)
            self.assertEqual(command.wait(timeout=60), 130)
        self.assertEqual(sorted(os.listdir(self.folder)),
                         ["large.off", "sphere.off"])


if __name__ == "__main__":
    unittest.main()
