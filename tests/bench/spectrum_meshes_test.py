"""Marrow's eigenvalues are SciPy's, on the meshes of the folder MARROW_DATA.

Some small ones, or all of them where MARROW_ALL_MESHES is set.

Usage: spectrum_meshes_test.py MARROW_BENCH
"""

import os
import pathlib
import sys
import tempfile
import unittest

import numpy as np

import spectrum_bench
import spectrum_scipy

BENCH = sys.argv.pop(1)
PAIRS = 60
MOST_BYTES = 250_000
USUAL, STRICT = 1e-5, 1e-9


def folder_of_meshes():
    """None where there is none."""
    folder = pathlib.Path(os.environ.get("MARROW_DATA") or "") / "meshes"
    return folder if "MARROW_DATA" in os.environ and folder.is_dir() else None


def meshes():
    files = sorted(folder_of_meshes().rglob("*.o[fb][fj]"))
    if os.environ.get("MARROW_ALL_MESHES"):
        return files
    return [file for file in files if file.stat().st_size < MOST_BYTES]


def difference(values, exact):
    return np.max(np.abs(np.array(values)[1:] / exact[1:] - 1))


class SpectrumMeshesTest(unittest.TestCase):

    def test_eigenvalues_are_scipys(self):
        files = meshes()
        self.assertGreater(len(files), 3)
        for file in files:
            with (self.subTest(file.name),
                  tempfile.TemporaryDirectory() as folder):
                spectrum_bench.run([BENCH, "problem", folder, "0", str(file)])
                exact, _ = spectrum_scipy.eigenpairs(
                    *spectrum_scipy.read(folder), PAIRS)
                for solver, most in (("marrow", USUAL), ("strict", STRICT)):
                    found = spectrum_bench.run(
                        [BENCH, "solve", solver, folder, str(PAIRS)])
                    off = difference(found["eigenvalues"], exact)
                    print(f"{file.name}: {solver} is off by {off:.1e}")
                    self.assertLess(off, most)


if __name__ == "__main__":
    if folder_of_meshes() is None:
        print("MARROW_DATA names no folder with meshes/: nothing is compared")
        sys.exit(77)  # what CTest takes for a test that was skipped
    unittest.main()
