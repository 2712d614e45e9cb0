import contextlib
import io
import pathlib
import tempfile
import unittest

import segmenting


class SegmentingTest(unittest.TestCase):

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        self.mesh = self.folder / "octopus.off"

    def test_a_mesh_of_one_level_has_an_automatic_cut(self):
        segmenting.sample("octopus", self.mesh, 5000)
        segmenting.segment([self.mesh], self.folder, "--levels", "1")
        labels = segmenting.cut_labels(self.folder, "octopus")
        self.assertEqual(len(labels), 5000)

    def test_files_that_would_overwrite_each_other_are_an_error(self):
        told = io.StringIO()
        with contextlib.redirect_stderr(told):
            with self.assertRaises(SystemExit):
                segmenting.segment([self.mesh, self.mesh.with_suffix(".obj")],
                                   self.folder)
        self.assertIn("rename one", told.getvalue())


if __name__ == "__main__":
    unittest.main()
