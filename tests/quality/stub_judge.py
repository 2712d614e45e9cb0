#!/usr/bin/python3
"""Stands for a judge where there is none: the same table, but for RI with
zeros, and all models in one category."""

import pathlib
import sys

import comparison
import segmenting


def row(name, models, values):
    error, parts, ratio = values
    zeros = f"{0:.4f} " * 3
    print(f"{name} {models} {error:.4f} {zeros} {parts:.1f} {ratio:.2f}")


def main():
    benchmark, folder = map(pathlib.Path, sys.argv[1:3])
    rows = []
    for path in sorted(folder.glob("*.seg")):
        labels = segmenting.read_labels(path)
        people = [segmenting.read_labels(human) for human in (
            benchmark / "seg/Benchmark" / path.stem).glob("*.seg")]
        errors = [comparison.rand_error(labels, each) for each in people]
        parts = len(set(labels))
        theirs = sum(len(set(each)) for each in people) / len(people)
        rows.append((sum(errors) / len(errors), parts, parts / theirs))
        row(path.stem, 1, rows[-1])
    mean = [sum(column) / len(rows) for column in zip(*rows)]
    row("Creature", len(rows), mean)
    row("all", len(rows), mean)


main()
