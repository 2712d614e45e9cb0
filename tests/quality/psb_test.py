"""The whole of ./dev psb on a benchmark of two samples. MARROW_JUDGE names a
judge; without it, stub_judge.py is asked."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import psb
import segmenting

HERE = pathlib.Path(__file__).parent
MODELS = {3: "humanoid", 7: "octopus"}


def make_benchmark(folder):
    """Two people: one sees all parts, the other the two sides of the body."""
    (folder / "off").mkdir()
    for number, name in MODELS.items():
        _, parts = segmenting.sample(name, folder / f"off/{number}.off", 5000)
        people = folder / f"seg/Benchmark/{number}"
        segmenting.write_labels(people / f"{number}_0.seg", parts)
        segmenting.write_labels(people / f"{number}_1.seg", parts % 2)


class PsbTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        make_benchmark(cls.folder)
        cls.document = cls.folder / "quality.md"
        cls.document.write_text("<!-- begin psb -->\n<!-- end psb -->\n")
        cls.judge = os.environ.get("MARROW_JUDGE", HERE / "stub_judge.py")
        subprocess.run(
            [sys.executable, "-B", HERE / "psb.py", cls.folder, cls.judge,
             "-o", cls.folder / "out", "--document", cls.document],
            stdout=subprocess.DEVNULL, check=True)
        cls.text = cls.document.read_text()

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def mean_error(self, title):
        table = self.text.split(f"\n### {title}")[1]
        return float(re.search(r"\*\*mean\*\* \| 2 \| ([\d.]+)", table)[1])

    def test_every_cut_labels_every_face(self):
        for cut in psb.CUTS:
            for number in MODELS:
                path = self.folder / "out" / cut / f"{number}.seg"
                self.assertEqual(len(segmenting.read_labels(path)), 5000)

    def test_no_cut_is_better_than_the_best(self):
        best = self.mean_error("Best cut")
        for title in ("Level 1", "Level 2", "Automatic cut"):
            self.assertLessEqual(best, self.mean_error(title))
        self.assertLess(best, self.mean_error("Every face"))

    def test_the_document_says_what_was_done(self):
        self.assertIn("at commit", self.text)
        self.assertIn("`--method merge`", self.text)
        self.assertIn("2 worst by RI", self.text)
        self.assertIn("Left as one segment: none", self.text)

    def test_no_benchmark_is_an_error(self):
        result = subprocess.run(
            [sys.executable, "-B", HERE / "psb.py", self.folder / "off",
             self.judge], capture_output=True, text=True)
        self.assertEqual(result.returncode, 1)
        self.assertIn("has no off/N.off", result.stderr)


if __name__ == "__main__":
    unittest.main()
