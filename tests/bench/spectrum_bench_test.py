"""./dev bench spectrum, on one small mesh.

Usage: spectrum_bench_test.py MARROW_BENCH
"""

import os
import pathlib
import sys
import tempfile
import unittest

import spectrum_bench

BENCH = sys.argv.pop(1)
DOCUMENT = f"before\n\n{spectrum_bench.BEGIN}\nold\n{spectrum_bench.END}\nafter\n"


def document_after(*words):
    """What a document is after a run, of which nothing else is left behind."""
    with tempfile.TemporaryDirectory() as folder:
        document = pathlib.Path(folder) / "performance.md"
        document.write_text(DOCUMENT, "utf-8")
        spectrum_bench.main([*words, "--repeats", "1", "--bench", BENCH,
                             "--output", str(document)])
        if os.listdir(folder) != [document.name]:
            raise AssertionError(os.listdir(folder))
        return document.read_text("utf-8")


class SpectrumBenchTest(unittest.TestCase):

    def test_all_solvers_agree_and_none_misses_a_pair(self):
        text = document_after("--sizes", "2500", "-k", "10,50")
        self.assertTrue(text.startswith("before\n"))
        self.assertTrue(text.endswith(f"{spectrum_bench.END}\nafter\n"))
        self.assertNotIn("old", text)
        rows = [dict(zip(spectrum_bench.HEADER, row[2:-2].split(" | ")))
                for row in text.splitlines() if row.startswith("| humanoid")]
        self.assertEqual([(row["pairs"], row["solver"]) for row in rows],
                         [(pairs, name) for pairs in ("10", "50")
                          for name in spectrum_bench.NAMES.values()])
        for row in rows:
            with self.subTest(row):
                pairs = int(row["pairs"]) + 1
                self.assertEqual(row["found"], f"{pairs} of {pairs}")
                self.assertLess(float(row["eigenvalues off by"]),
                                1e-5 if row["solver"] == "Marrow" else 1e-9)
                self.assertLess(float(row["residual"]),
                                1e-3 if row["solver"] == "Marrow" else 1e-8)
                self.assertGreater(float(row["s"]), 0)
                self.assertGreater(int(row["peak, MiB"]), 5)

    def test_a_run_that_takes_too_long_is_not_run_again(self):
        options = spectrum_bench.arguments(
            ["--limit", "0.001", "--bench", BENCH, "--solvers", "marrow"])
        bench = spectrum_bench.Bench(options)
        with tempfile.TemporaryDirectory() as folder:
            problem = spectrum_bench.run([BENCH, "problem", folder, "2500"])
            (row,) = bench.rows(folder, problem, 10)
        self.assertEqual(row[4], "not run")
        self.assertIn(("marrow", 10), bench.too_slow)

    def test_a_run_that_must_take_too_long_is_not_begun(self):
        options = spectrum_bench.arguments(["--limit", "9", "--bench", "/absent"])
        bench = spectrum_bench.Bench(options)
        bench.quickest["marrow", 10] = 1000, 1.0
        self.assertFalse(bench.must_be_too_slow(("marrow", 10), 8999))
        self.assertFalse(bench.must_be_too_slow(("strict", 10), 9001))
        self.assertIsNone(bench.once("marrow", ".", 9001, 10))

    def test_tables_are_kept_where_one_is_appended(self):
        text = document_after("--sizes", "1000,2500", "-k", "10", "--solvers",
                              "marrow", "--append")
        self.assertIn(f"{spectrum_bench.BEGIN}\n\nold\n\nMeasured on", text)
        self.assertEqual(text.count("| humanoid"), 2)

    def test_failures_say_what_to_do(self):
        for words in (["--solvers", "arpack"], ["--sizes", "many"]):
            with self.assertRaises(SystemExit), open(
                    os.devnull, "w", encoding="utf-8") as sys.stderr:
                spectrum_bench.arguments(words)
            sys.stderr = sys.__stderr__
        with self.assertRaisesRegex(RuntimeError, "nowhere.off"):
            spectrum_bench.run([BENCH, "problem", ".", "0", "nowhere.off"])
        with tempfile.NamedTemporaryFile() as file:
            with self.assertRaisesRegex(SystemExit, "lacks the lines"):
                spectrum_bench.Document(file.name)


if __name__ == "__main__":
    unittest.main()
