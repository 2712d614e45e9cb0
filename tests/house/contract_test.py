"""The contract says of every field what it may hold."""

import re
import unittest

import tree

FIELD = re.compile(r"(?:repeated |optional )?(map<.*>|[\w.]+) (\w+) = \d+;")
NUMBERS = {"double", "float", "fixed32", "int32", "int64", "uint32", "uint64"}
RANGE = re.compile(r"\b[Rr]ange\b")
DEFAULT = re.compile(r"\b([Dd]efault|Required|Always|Absent|Empty|Never empty)"
                     r"\b")


def contract():
    """(path, text) of all files of the contract."""
    for path in tree.files():
        if str(path).startswith("proto/marrow/"):
            yield path, tree.text(path)


def fields(text):
    """(type, name, comment, whether it is one of a oneof) of each field."""
    comment, blocks = [], []
    for line in map(str.strip, text.splitlines()):
        field = FIELD.fullmatch(line)
        if line.startswith("//"):
            comment.append(line[2:].strip())
            continue
        if field:
            yield (*field.groups(), " ".join(comment), blocks[-1] == "oneof")
        elif line.endswith("{"):
            blocks.append(line.split()[0])
        elif line == "}":
            blocks.pop()
        comment = []


class ContractTest(unittest.TestCase):

    def test_every_field_says_range_and_default(self):
        enums = set(re.findall(r"^enum (\w+)", "".join(
            text for _, text in contract()), re.MULTILINE))
        self.assertIn("CacheOutcome", enums)
        count = 0
        for path, text in contract():
            for kind, name, comment, in_oneof in fields(text):
                count += 1
                with self.subTest(f"{path}: {name}"):
                    if kind in NUMBERS | enums:
                        self.assertRegex(comment, RANGE)
                    if not in_oneof:
                        self.assertRegex(comment, DEFAULT)
        self.assertGreater(count, 150)


if __name__ == "__main__":
    unittest.main()
