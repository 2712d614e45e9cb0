"""What ./dev robust measures, held to its limits on samples of 5000 faces."""

import pathlib
import tempfile
import unittest

import robust
import segmenting

FACES = 5000


def numbers(table, first):
    """The cells of the row that begins so."""
    [row] = [line for line in table.splitlines()
             if line.startswith(f"| {first} |")]
    return [cell.strip() for cell in row.split("|")[2:-1]]


class RobustTest(unittest.TestCase):

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def test_noise_and_triangles_hardly_change_the_cut(self):
        limits = {"noise 0.2": 0.03, "noise 1.0": 0.10, "half": 0.05,
                  "subdivided": 0.05, "1 % missing": 0.05}
        files = robust.sample_files(self.folder, FACES,
                                    ("quadruped", "octopus"))
        table = robust.disturbance_table(files, self.folder / "out",
                                         tuple(limits))
        errors = map(float, numbers(table, "**most**")[2:])
        for (name, limit), error in zip(limits.items(), errors, strict=True):
            with self.subTest(name):
                self.assertLessEqual(error, limit)

    def test_poses_hardly_change_the_cut(self):
        for pose in ("rest", "run", "sit"):
            segmenting.sample("humanoid", self.folder / f"creature/{pose}.off",
                              FACES, pose)
        row = numbers(robust.pose_table(self.folder, self.folder / "out"),
                      "creature")
        self.assertEqual(row[:2], ["3", "3"])
        self.assertLessEqual(float(row[2]), 0.04)
        self.assertLessEqual(float(row[4]), 0.10)

    def test_glued_limbs_are_found(self):
        cases = [case for case in robust.GLUED if case[2] == "left_leg"]
        table = robust.glued_table(self.folder, FACES, cases)
        limbs, found, found_glued = numbers(table, "humanoid, rest")[1:4]
        self.assertEqual(found, limbs)
        self.assertEqual(found_glued, limbs)

    def test_files_of_several_bodies_are_told_apart(self):
        for name in ("a/1.obj", "a/2.obj", "b/tr_reg_000.ply",
                     "b/tr_reg_001.ply", "b/tr_reg_010.ply", "c/1.obj"):
            path = self.folder / name
            path.parent.mkdir(exist_ok=True)
            path.touch()
        groups = robust.pose_groups(self.folder)
        self.assertEqual({name: len(files) for name, files in groups.items()},
                         {"a": 2, "b 00": 2})


if __name__ == "__main__":
    unittest.main()
