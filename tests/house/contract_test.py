"""The contract says of every field what it may hold, and of every code that
there is such a one."""

import re
import unittest

import tree

FIELD = re.compile(r"(?:repeated |optional )?(map<.*>|[\w.]+) (\w+) = \d+;")
NUMBERS = {"double", "float", "fixed32", "int32", "int64", "uint32", "uint64"}
RANGE = re.compile(r"\b[Rr]ange\b")
DEFAULT = re.compile(r"\b([Dd]efault|Required|Always|Absent|Empty|Never empty)"
                     r"\b")
CODE = re.compile(r"\b[A-Z]+_[A-Z_]+\b|\b(?:CRACKS|BOUNDARIES|COARSENED)\b")


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


def comment_of(message, field):
    """The comment of a field of a message."""
    for _, text in contract():
        body = re.search(rf"^message {message} {{\n(.*?)^}}", text,
                         re.MULTILINE | re.DOTALL)
        if body:
            found = fields("message {\n" + body.group(1) + "}")
            return next(c for _, name, c, _ in found if name == field)
    raise KeyError(message)


def codes():
    """Code -> whether it is a warning, of all that the server tells."""
    text = tree.text("server/mesh_warnings.cc")
    kinds = dict(re.findall(r'^    {"([A-Z_]+)", (true|false),', text,
                            re.MULTILINE))
    others = re.findall(r'MakeFinding\(\s*"([A-Z_]+)"', text)
    return {**{code: kind == "true" for code, kind in kinds.items()},
            **{code: True for code in others}}


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

    def test_every_code_is_described(self):
        known = codes()
        self.assertGreater(len(known), 15)
        self.assertTrue(known["FAR_FROM_ORIGIN"])
        warnings = {code for code, is_warning in known.items() if is_warning}
        self.assertEqual(
            set(CODE.findall(comment_of("Warning", "code"))), warnings)
        self.assertEqual(set(CODE.findall(comment_of("Finding", "code"))),
                         set(known) - warnings)
        told = re.search(r"^The codes of warnings are (.*?); of findings "
                         r"besides,(.*?)\. Others", tree.text("docs/json.md"),
                         re.MULTILINE | re.DOTALL)
        self.assertEqual(set(CODE.findall(told.group(1))), warnings)
        self.assertEqual(set(CODE.findall(told.group(2))),
                         set(known) - warnings)


if __name__ == "__main__":
    unittest.main()
