import pathlib
import tempfile
import unittest

import document
from document import Number


class DocumentTest(unittest.TestCase):

    def test_numbers_stand_right(self):
        self.assertEqual(
            document.table(["name", "RI"], [["ant", Number(0.03149)]]),
            "| name | RI |\n| --- | ---: |\n| ant | 0.031 |\n")

    def test_only_the_part_is_replaced(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "a.md")
            path.write_text("a\n<!-- begin x -->\nold\n<!-- end x -->\nb\n")
            for _ in range(2):
                document.replace_part(path, "x", "new\n")
                self.assertEqual(
                    path.read_text(),
                    "a\n<!-- begin x -->\n\nnew\n\n<!-- end x -->\nb\n")
            with self.assertRaisesRegex(ValueError, "begin y"):
                document.replace_part(path, "y", "new\n")


if __name__ == "__main__":
    unittest.main()
