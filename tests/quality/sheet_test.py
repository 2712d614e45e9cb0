import pathlib
import subprocess
import sys
import tempfile
import unittest

from PIL import Image

import segmenting
import sheet

HERE = pathlib.Path(__file__).parent


def run(*arguments):
    return subprocess.run([sys.executable, "-B", HERE / "sheet.py",
                           *arguments], capture_output=True, text=True)


class SheetTest(unittest.TestCase):

    def test_all_meshes_of_a_folder_are_on_the_page(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            for creature in ("hand", "octopus"):
                segmenting.sample(creature, folder / f"{creature}.off", 5000)
            page = folder / "made/sheet.png"
            result = run(folder, "-o", page)
            self.assertEqual(result.returncode, 0, result.stderr)
            with Image.open(page) as picture:
                cells = [picture.crop((x, sheet.CAPTION, x + width,
                                       picture.height))
                         for width in [picture.width // 2]
                         for x in (0, width)]
        for cell in cells:
            self.assertGreaterEqual(cell.width, sheet.CELL_WIDTH)
            # Some segments, and their shades.
            self.assertGreater(len(cell.getcolors(1 << 24)), 100)

    def test_a_folder_without_meshes_is_an_error(self):
        with tempfile.TemporaryDirectory() as folder:
            result = run(folder)
        self.assertEqual(result.returncode, 1)
        self.assertIn("no mesh", result.stderr)


if __name__ == "__main__":
    unittest.main()
