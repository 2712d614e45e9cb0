"""./dev bench spectrum: SciPy, Spectra and Marrow on the same matrices.

Every run is a process of its own, and the solvers take turns. The table goes
between two markers in docs/performance.md, as far as it is known after every
size, so that what hours have measured is there when the rest is interrupted.
"""

import argparse
import datetime
import json
import os
import pathlib
import platform
import statistics
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
SCIPY = [sys.executable, "-B", str(HERE / "spectrum_scipy.py")]
BEGIN = "<!-- ./dev bench spectrum: begin -->"
END = "<!-- ./dev bench spectrum: end -->"
# "" is what OpenBLAS chooses by itself, which on a CPU that it does not know
# is its slowest.
CORES = ("", "Haswell", "Zen", "SkylakeX", "Cooperlake", "Neoversen1")
SOLVERS = ("scipy-1", "scipy-2", "spectra", "marrow", "strict")
NAMES = {"scipy-1": "SciPy, 1 thread", "scipy-2": "SciPy, 2 threads",
         "spectra": "Spectra", "marrow": "Marrow", "strict": "Marrow, strict"}
# Above this size so many pairs are not asked for.
MANY_PAIRS = 200
MANY_PAIRS_VERTICES = 160_000


def arguments(words):
    def numbers(text):
        return [int(number) for number in text.split(",")]

    def solvers(text):
        chosen = text.split(",")
        if not set(chosen) <= set(SOLVERS):
            raise argparse.ArgumentTypeError(f"choose of {','.join(SOLVERS)}")
        return chosen
    parser = argparse.ArgumentParser(
        prog="./dev bench spectrum",
        description="Compare eigensolvers on the same matrices and write the "
        "table of docs/performance.md.")
    parser.add_argument("path", nargs="?", default="",
                        help="a mesh, or a folder of them; without it, samples")
    parser.add_argument("--sizes", type=numbers, metavar="N,...",
                        default=[7000, 24000, 48000, 134000, 537000, 1000000],
                        help="about how many vertices; meshes are subdivided; "
                        "0: as the mesh is")
    parser.add_argument("-k", "--pairs", type=numbers, metavar="K,...",
                        default=[10, 50, 200, 500],
                        help=f"more than {MANY_PAIRS} only up to "
                        f"{MANY_PAIRS_VERTICES} vertices")
    parser.add_argument("--solvers", type=solvers, default=list(SOLVERS),
                        metavar="NAME,...", help="of " + ",".join(SOLVERS))
    parser.add_argument("--repeats", type=int, default=5,
                        help="runs of which the median is taken (5); one, where "
                        "it takes a minute")
    parser.add_argument("--limit", type=float, default=600, metavar="SECONDS",
                        help="a run that takes longer is ended (600), and one "
                        "that must take longer, as it did for fewer vertices, "
                        "is not begun")
    parser.add_argument("--append", action="store_true",
                        help="keep the tables that are in the document, and "
                        "add this one below them")
    parser.add_argument("--output", metavar="FILE",
                        default=str(ROOT / "docs/performance.md"),
                        help="the document with the markers; - prints the table "
                        "alone")
    parser.add_argument("--bench", help=argparse.SUPPRESS,
                        default=str(ROOT / "build/release/bin/marrow_bench"))
    return parser.parse_args(words)


def tell(text):
    print(text, file=sys.stderr, flush=True)


def run(command, environment=None, limit=None):
    """The JSON that a command prints; None where it took too long."""
    try:
        done = subprocess.run(command, env={**os.environ, **(environment or {})},
                              capture_output=True, text=True, timeout=limit,
                              check=False)
    except subprocess.TimeoutExpired:
        return None
    if done.returncode != 0:
        last = (done.stderr.strip().splitlines() or ["no message"])[-1]
        raise RuntimeError(f"{' '.join(command)}: exit code "
                           f"{done.returncode}: {last}")
    return json.loads(done.stdout)


def threads(count):
    return {"OPENBLAS_NUM_THREADS": str(count), "OMP_NUM_THREADS": str(count)}


def best_core():
    """(environment, probe) of the OpenBLAS core that is fastest here."""
    best = None
    for core in CORES:
        environment = {"OPENBLAS_CORETYPE": core} if core else {}
        try:
            found = run(SCIPY + ["probe"], {**environment, **threads(1)})
        except RuntimeError:  # A core whose instructions this CPU lacks.
            continue
        if best is None or found["seconds"] < best[1]["seconds"]:
            best = environment, found
    return best


class Bench:
    """Runs of all solvers, and which of them took too long."""

    def __init__(self, options):
        self.options = options
        self.core, self.probe = best_core()
        self.too_slow = set()
        self.quickest = {}  # (solver, pairs) -> (vertices, seconds)

    def command(self, solver, folder, pairs):
        if solver.startswith("scipy"):
            return (SCIPY + ["solve", folder, str(pairs)],
                    {**self.core, **threads(solver[-1])})
        return ([self.options.bench, "solve", solver, folder, str(pairs)], {})

    def must_be_too_slow(self, run_of, vertices):
        """Whether a run takes too long even if its time only grows as fast as
        the number of vertices, which is less than any of the solvers' does."""
        before, seconds = self.quickest.get(run_of, (1, 0))
        return (run_of in self.too_slow or
                seconds * vertices / before > self.options.limit)

    def once(self, solver, folder, vertices, pairs):
        run_of = solver, pairs
        if self.must_be_too_slow(run_of, vertices):
            return None
        command, environment = self.command(solver, folder, pairs)
        try:
            result = run(command, environment, self.options.limit)
        except RuntimeError as error:
            tell(f"   {error}")
            result = None
        if result is None:
            # Larger meshes take longer still.
            self.too_slow.add(run_of)
        elif vertices != self.quickest.get(run_of, (0, 0))[0]:
            self.quickest[run_of] = vertices, result["seconds"]
        return result

    def compare(self, folder, vertices, pairs):
        """Solver -> its runs, the solvers taking turns."""
        runs = {solver: [] for solver in self.options.solvers}
        for turn in range(self.options.repeats):
            for solver, results in runs.items():
                if turn > 0 and (not results or results[0]["seconds"] > 60):
                    continue
                result = self.once(solver, folder, vertices, pairs)
                if result is None:
                    continue
                results.append(result)
                tell(f"   {pairs} pairs, {NAMES[solver]}: "
                     f"{result['seconds']:.2f} s")
        return runs

    def rows(self, folder, problem, pairs):
        runs = self.compare(folder, problem["vertices"], pairs)
        medians = {solver: statistics.median(r["seconds"] for r in results)
                   for solver, results in runs.items() if results}
        reference = next((runs[s][0]["eigenvalues"] for s in runs
                          if s in medians and s != "marrow"), None)
        for solver, results in runs.items():
            label = [problem["mesh"], problem["vertices"], pairs, NAMES[solver]]
            if not results:
                yield label + ["not run"] + [""] * 6
                continue
            first = results[0]
            yield label + [
                f"{medians[solver]:.3g}", len(results),
                ratio(medians, solver, "scipy-1"),
                ratio(medians, solver, "spectra"), f"{first['residual']:.0e}",
                difference(first["eigenvalues"], reference),
                self.certificate(folder, first["eigenvalues"]),
                round(max(r["peak_bytes"] for r in results) / 2**20)]

    def certificate(self, folder, values):
        """Eigenvalues found of those that there are below the last."""
        bound = values[-1] * (1 + 1e-6)
        count = run([self.options.bench, "count", folder, repr(bound)])["count"]
        return f"{len(values)} of {count}"


def ratio(medians, solver, to):
    if to not in medians:
        return ""
    return f"{medians[to] / medians[solver]:.2g}"


def difference(values, reference):
    """The largest relative difference to another solver's eigenvalues."""
    if reference is None:
        return ""
    worst = max(abs(a - b) / b for a, b in zip(values[1:], reference[1:]))
    return f"{worst:.0e}"


HEADER = ("mesh", "vertices", "pairs", "solver", "s", "runs",
          "times SciPy's speed", "times Spectra's", "residual",
          "eigenvalues off by", "found", "peak, MiB")


def line(cells):
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def output_of(*command):
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True,
                          check=False).stdout.strip()


def machine(bench):
    """A sentence on what the figures were measured with."""
    fields = {}
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        for entry in file:
            name, _, value = entry.partition(":")
            fields.setdefault(name.strip(), value.strip())
    with open("/proc/meminfo", encoding="utf-8") as file:
        gibibytes = int(file.readline().split()[1]) / 2**20
    commit = output_of("git", "rev-parse", "--short", "HEAD") or "unknown"
    if output_of("git", "status", "--porcelain", "--untracked-files=no", "--",
                 ".", ":!docs"):
        commit += " with changes"
    compiler = output_of("c++", "-dumpfullversion")
    probe = bench.probe
    return (f"Measured on {datetime.date.today()} at commit {commit}: "
            f"{os.cpu_count()} cores of {fields.get('model name', 'a CPU')} "
            f"({platform.machine()}), {gibibytes:.0f} GiB, gcc {compiler} -O2, "
            f"SciPy {probe['scipy']} with NumPy {probe['numpy']} on "
            f"{probe['blas']} for {probe['core']}, the quickest there.")


def tables(options):
    """The table with the rows of the first size, of the first two, and so on."""
    bench = Bench(options)
    lines = [machine(bench), "", line(HEADER), line(["---"] * len(HEADER))]
    for size in options.sizes:
        with tempfile.TemporaryDirectory() as folder:
            command = [options.bench, "problem", folder, str(size)]
            problem = run(command + ([options.path] if options.path else []))
            tell(f"-- {problem['mesh']}: {problem['vertices']} vertices")
            for pairs in options.pairs:
                if (pairs > MANY_PAIRS and
                        problem["vertices"] > MANY_PAIRS_VERTICES):
                    continue
                lines += map(line, bench.rows(folder, problem, pairs))
        yield "\n".join(lines)


class Document:
    """One with the two markers between which tables go."""

    def __init__(self, path):
        self.path = pathlib.Path(path)
        text = self.path.read_text("utf-8")
        self.before, found, rest = text.partition(BEGIN)
        self.tables, found_too, self.after = rest.partition(END)
        if not found or not found_too:
            sys.exit(f"./dev bench spectrum: {path} lacks the lines\n"
                     f"{BEGIN}\n{END}\nbetween which the table goes")

    def write(self, tables):
        whole = self.path.with_name(self.path.name + ".new")
        whole.write_text(f"{self.before}{BEGIN}\n\n{tables}\n\n{END}{self.after}",
                         "utf-8")
        whole.replace(self.path)


def main(words):
    options = arguments(words)
    document = None if options.output == "-" else Document(options.output)
    kept = (f"{document.tables.strip()}\n\n"
            if document and options.append else "")
    text = ""
    try:
        for text in tables(options):
            if document:
                document.write(kept + text)
    except RuntimeError as error:
        sys.exit(f"./dev bench spectrum: {error}")
    except KeyboardInterrupt:
        sys.exit(130)
    print(f"-- the table is in {options.output}" if document else text)


if __name__ == "__main__":
    main(sys.argv[1:])
