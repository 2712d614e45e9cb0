"""SciPy's part of ./dev bench spectrum: one run, in a process of its own.

  spectrum_scipy.py solve FOLDER PAIRS   solves what marrow_bench wrote there
  spectrum_scipy.py probe                times a little dense algebra

Prints a line of JSON. As `marrow_bench solve` does, `seconds` is the time from
the matrices to the pairs, and `peak_bytes` is of the process until then.
"""

import ctypes
import json
import os
import resource
import sys
import time

import numpy as np
import scipy
import scipy.sparse
import scipy.sparse.linalg


def read(folder):
    """L by columns and the diagonal of M."""
    def array(name, kind):
        return np.fromfile(os.path.join(folder, name), dtype=kind)
    mass = array("mass.f64", "<f8")
    stiffness = scipy.sparse.csc_matrix(
        (array("values.f64", "<f8"), array("rows.i32", "<i4"),
         array("starts.i32", "<i4")), shape=(mass.size, mass.size))
    return stiffness, mass


def residual(stiffness, mass, values, vectors):
    """The largest, in the norm of M^-1 and in units of lambda."""
    worst = 0.0
    for value, vector in zip(values[1:], vectors.T[1:]):
        rest = stiffness @ vector - value * mass * vector
        worst = max(worst, np.sqrt(np.sum(rest**2 / mass)) / value)
    return worst


def eigenpairs(stiffness, mass, pairs):
    """The lowest pairs, the constant one included, ascending.

    The shift is below zero, where the matrix is definite.
    """
    values, vectors = scipy.sparse.linalg.eigsh(
        stiffness, k=pairs + 1, M=scipy.sparse.diags(mass, format="csc"),
        sigma=-0.01, which="LM")
    order = np.argsort(values)
    return values[order], vectors[:, order]


def solve(folder, pairs):
    stiffness, mass = read(folder)
    start = time.perf_counter()
    values, vectors = eigenpairs(stiffness, mass, pairs)
    seconds = time.perf_counter() - start
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    return {"seconds": seconds, "peak_bytes": peak,
            "residual": residual(stiffness, mass, values, vectors),
            "eigenvalues": values.tolist()}


def blas():
    """What the process has loaded to do its dense algebra."""
    with open("/proc/self/maps", encoding="utf-8") as maps:
        paths = {line.split()[-1] for line in maps if "blas" in line}
    for path in sorted(paths):
        library = ctypes.CDLL(path)
        if hasattr(library, "openblas_get_config"):
            library.openblas_get_config.restype = ctypes.c_char_p
            library.openblas_get_corename.restype = ctypes.c_char_p
            words = library.openblas_get_config().decode().split()
            return " ".join(words[:2]), library.openblas_get_corename().decode()
    return "the reference BLAS", "none"


def probe():
    generator = np.random.default_rng(1)
    square = generator.random((700, 700))
    tall = generator.random((20000, 100))
    best = np.inf
    for _ in range(3):
        start = time.perf_counter()
        square @ square
        for _ in range(10):
            tall.T @ (tall @ square[0, :100])
        best = min(best, time.perf_counter() - start)
    library, core = blas()
    return {"seconds": best, "blas": library, "core": core,
            "numpy": np.__version__, "scipy": scipy.__version__}


def main(words):
    if words == ["probe"]:
        return probe()
    if len(words) == 3 and words[0] == "solve":
        return solve(words[1], int(words[2]))
    sys.exit(__doc__)


if __name__ == "__main__":
    print(json.dumps(main(sys.argv[1:])))
