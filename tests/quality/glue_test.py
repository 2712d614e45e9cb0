import pathlib
import tempfile
import unittest

import numpy

import glue
import segmenting
import surface as surfaces


class GlueTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "humanoid.off")
            names, parts = segmenting.sample("humanoid", path, 5000)
            cls.surface = surfaces.read_off(path)
        faces = cls.surface[1]
        cls.legs = [set(faces[parts == names.index(leg)].ravel())
                    for leg in ("left_leg", "right_leg")]

    def test_a_tube_is_a_handle(self):
        (points, faces), kept, share = glue.glue(self.surface, *self.legs)
        edges = surfaces.edges(faces)
        self.assertEqual(2 * len(edges), 3 * len(faces))
        directed = {(face[corner], face[(corner + 1) % 3])
                    for face in faces.tolist() for corner in range(3)}
        self.assertEqual(len(directed), 3 * len(faces))
        # The sample's is 2.
        self.assertEqual(len(points) - len(edges) + len(faces), 0)
        self.assertLessEqual(share, glue.MAX_SHARE)
        self.assertGreater(share, 0)
        numpy.testing.assert_array_equal(
            points[faces[:len(kept)]],
            self.surface[0][self.surface[1][kept]])

    def test_a_tube_that_is_too_large_is_refused(self):
        points = self.surface[0]
        ends = [{vertex for vertex in range(len(points))
                 if sign * points[vertex, 1] > limit}
                for sign, limit in ((1, points[:, 1].max() - 0.1),
                                    (-1, -points[:, 1].min() - 0.1))]
        self.assertIsNone(glue.glue(self.surface, *ends))


if __name__ == "__main__":
    unittest.main()
