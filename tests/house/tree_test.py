"""Rules that every file of the project keeps."""

import unittest

import tree

MAX_LINES = 500
SOURCES = {".cc", ".h", ".py", ".proto", ".sh", ".cmake"}

# Paths and hosts of one machine, and notes to oneself. Split, so that this
# file keeps the rule.
FORBIDDEN = (
    "/wo" "rk/", "/ro" "ot/", "/ho" "me/", "deb.deb" "ian.org",
    "registry.npm" "js", "pypi" ".org", "TO" "DO", "FIX" "ME",
)


class TreeTest(unittest.TestCase):

    def test_finds_files(self):
        self.assertIn("dev", [str(path) for path in tree.files()])

    def test_no_source_is_long(self):
        for path in tree.files():
            if path.suffix not in SOURCES and path.name != "dev":
                continue
            with self.subTest(str(path)):
                lines = tree.text(path).count("\n")
                self.assertLessEqual(lines, MAX_LINES,
                                     f"split {path}: {lines} lines")

    def test_no_forbidden_words(self):
        for path in tree.files():
            text = tree.text(path) or ""
            for word in FORBIDDEN:
                with self.subTest(f"{path}: {word}"):
                    self.assertNotIn(word, text)

    def test_headers_are_guarded_by_their_path(self):
        for path in tree.files():
            if path.suffix != ".h":
                continue
            guard = str(path).upper().translate(str.maketrans("/.-", "___"))
            with self.subTest(str(path)):
                self.assertIn(f"#ifndef MARROW_{guard}_\n"
                              f"#define MARROW_{guard}_\n", tree.text(path))


if __name__ == "__main__":
    unittest.main()
