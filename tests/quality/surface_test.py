import pathlib
import tempfile
import unittest

import numpy

import segmenting
import surface as surfaces


class SurfaceTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        path = pathlib.Path(cls.folder.name, "octopus.off")
        segmenting.sample("octopus", path, 5000)
        cls.surface = surfaces.read_off(path)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_a_file_is_read_as_it_was_written(self):
        path = pathlib.Path(self.folder.name, "again.off")
        surfaces.write_off(path, self.surface)
        points, faces = surfaces.read_off(path)
        self.assertEqual(len(faces), 5000)
        numpy.testing.assert_array_equal(points, self.surface[0])
        numpy.testing.assert_array_equal(faces, self.surface[1])

    def test_a_coloured_mesh_is_read_whatever_its_precision(self):
        points, faces = self.surface
        folder = pathlib.Path(self.folder.name)
        single = points.astype(numpy.float32).astype(numpy.float64)
        for name, exact in (("double", points / 3), ("single", single)):
            path = folder / f"{name}.off"
            surfaces.write_off(path, (exact, faces))
            segmenting.segment([path], folder, "--levels", "1")
            read = surfaces.read_coloured(folder / f"{name}.level-1.ply")
            numpy.testing.assert_array_equal(read[0][read[1]], exact[faces])

    def test_noise_is_as_strong_as_asked(self):
        points, faces = surfaces.add_noise(self.surface, 0.5)
        steps = numpy.linalg.norm(points - self.surface[0], axis=1)
        deviation = (steps ** 2).mean() ** 0.5
        self.assertAlmostEqual(
            deviation / surfaces.mean_edge(self.surface), 0.5, delta=0.02)
        again, _ = surfaces.add_noise(self.surface, 0.5)
        numpy.testing.assert_array_equal(points, again)

    def test_missing_faces_are_as_many_as_asked(self):
        points, faces = surfaces.without_faces(self.surface, 0.1)
        self.assertAlmostEqual(len(faces) / len(self.surface[1]), 0.9,
                               delta=0.02)
        self.assertIs(points, self.surface[0])
        _, again = surfaces.without_faces(self.surface, 0.1)
        numpy.testing.assert_array_equal(faces, again)

    def test_children_lie_in_their_face(self):
        fine = surfaces.subdivide(self.surface)
        areas = surfaces.face_areas(fine).reshape(-1, 4)
        numpy.testing.assert_allclose(
            areas, areas.mean(axis=1, keepdims=True) * [[1, 1, 1, 1]])
        numpy.testing.assert_allclose(areas.sum(axis=1),
                                      surfaces.face_areas(self.surface))
        centres = fine[0][fine[1][3::4]].mean(axis=1)
        points, faces = self.surface
        numpy.testing.assert_allclose(centres, points[faces].mean(axis=1))

    def test_every_edge_has_two_faces_after_dividing(self):
        fine = surfaces.subdivide(self.surface)
        self.assertEqual(2 * len(surfaces.edges(fine[1])), 3 * len(fine[1]))

    def test_decimation_keeps_the_shape(self):
        coarse = surfaces.decimate(self.surface, 0.25)
        self.assertAlmostEqual(len(coarse[1]), 1250, delta=10)
        self.assertEqual(len(coarse[0]), coarse[1].max() + 1)
        self.assertAlmostEqual(surfaces.face_areas(coarse).sum()
                               / surfaces.face_areas(self.surface).sum(),
                               1, delta=0.05)

    def test_the_nearest_face_is_the_one_that_it_lies_in(self):
        fine = surfaces.subdivide(self.surface)
        nearest = surfaces.nearest_faces(fine, self.surface)
        numpy.testing.assert_array_equal(nearest, numpy.arange(20000) // 4)


if __name__ == "__main__":
    unittest.main()
