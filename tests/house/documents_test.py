"""What the documents say to type is there to be typed.

MARROW_BIN names the folder of the programs.
"""

import json
import os
import re
import shlex
import subprocess
import tempfile
import unittest

import tree

BIN = os.environ["MARROW_BIN"]
LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)]*)?\)")
SHELL_BLOCK = re.compile(r"^```sh\n(.*?)^```", re.MULTILINE | re.DOTALL)


def run(*command):
    return subprocess.run(command, cwd=tree.ROOT, capture_output=True,
                          text=True, timeout=60, check=True).stdout


def documents():
    for path in tree.files():
        if path.suffix == ".md":
            yield path, tree.text(path)


def commands(program):
    """(document, words after the program) of all commands in shell blocks."""
    for path, text in documents():
        for block in SHELL_BLOCK.findall(text):
            for line in block.replace("\\\n", " ").splitlines():
                words = shlex.split(line, comments=True)
                if words and os.path.basename(words[0]) == program:
                    yield path, words[1:]


def keys_of(value):
    """The names of all fields, at any depth."""
    if isinstance(value, dict):
        return set(value).union(*map(keys_of, value.values()))
    if isinstance(value, list):
        return set().union(*map(keys_of, value))
    return set()


def verbs():
    return re.findall(r"^  ([a-z]+)  ", run("./dev"), re.MULTILINE)


class DocumentsTest(unittest.TestCase):

    def check_options(self, path, help_text, words):
        for word in words:
            if not word.startswith("-"):
                continue
            option = re.escape(word.split("=")[0])
            with self.subTest(f"{path}: {' '.join(words)}"):
                self.assertRegex(help_text, rf"(?<![\w-]){option}(?![\w-])")

    def test_every_verb_is_in_the_readme(self):
        self.assertIn("demo", verbs())
        for verb in verbs():
            self.assertIn(f"./dev {verb}", tree.text("README.md"))

    def test_every_field_of_the_json_file_is_described(self):
        with tempfile.TemporaryDirectory() as folder:
            marrow = os.path.join(BIN, "marrow")
            mesh = os.path.join(folder, "me.off")
            run(marrow, "sample", "octopus", "--faces", "5000", "-o", mesh)
            run(marrow, "segment", mesh, "-o", folder)
            with open(os.path.join(folder, "me.json"),
                      encoding="utf-8") as file:
                keys = keys_of(json.load(file))
        self.assertIn("medial_structure", keys)
        words = set(re.findall(r"\w+", " ".join(
            re.findall(r"`([^`]*)`", tree.text("docs/json.md")))))
        self.assertEqual(keys - words, set())

    def test_verbs_exist(self):
        found = list(commands("dev"))
        self.assertTrue(found)
        for path, words in found:
            self.assertIn(words[0], verbs(), path)

    def test_an_unknown_verb_is_an_error(self):
        result = subprocess.run([tree.ROOT / "dev", "dance"], cwd="/",
                                capture_output=True, text=True, timeout=60)
        self.assertEqual(result.returncode, 2)
        self.assertIn("no verb 'dance'", result.stderr)

    def test_commands_of_marrow_exist(self):
        found = list(commands("marrow"))
        self.assertTrue(found)
        for path, words in found:
            command = [] if words[0].startswith("-") else words[:1]
            text = run(f"{BIN}/marrow", *command, "--help")
            self.check_options(path, text, words)

    def test_commands_of_marrowd_exist(self):
        found = list(commands("marrowd"))
        self.assertTrue(found)
        for path, words in found:
            self.check_options(path, run(f"{BIN}/marrowd", "--help"), words)

    def check_table(self, document, *command):
        """The options in the tables of a document are in a help text."""
        text = tree.text(document)
        options = re.findall(r"^\| `(--[a-z-]+)`", text, re.MULTILINE)
        self.assertTrue(options)
        self.check_options(document, run(*command, "--help"), options)

    def test_option_tables_are_true(self):
        self.check_table("README.md", f"{BIN}/marrow", "segment")
        self.check_table("docs/operating.md", f"{BIN}/marrowd")

    def test_links_lead_to_files(self):
        for path, text in documents():
            for link in LINK.findall(text):
                if "://" in link:
                    continue
                with self.subTest(f"{path}: {link}"):
                    self.assertTrue((tree.ROOT / path.parent / link).exists())


if __name__ == "__main__":
    unittest.main()
