"""Scores Marrow on a benchmark of segmentations that people drew.

The benchmark has off/N.off and seg/Benchmark/N/*.seg, a label a face and line.
Segmentations go to out/psb, a folder a cut; the table to docs/quality.md.
"""

import argparse
import concurrent.futures
import pathlib
import statistics

import best_cut
import document
import judge
import segmenting
from document import Number

AUTOMATIC, BEST, FACES = "automatic", "best", "faces"
# Folder of a cut -> what the table calls it.
CUTS = {
    "level-1": "level 1",
    "level-2": "level 2",
    AUTOMATIC: "automatic cut",
    BEST: "best cut of the tree",
    FACES: "every face its own",
}
NUM_WORST = 5


def models_of(benchmark):
    """The mesh files that people have segmented."""
    found = [path for path in (benchmark / "off").glob("*.off")
             if path.stem.isdigit()
             and any((benchmark / "seg/Benchmark" / path.stem).glob("*.seg"))]
    if not found:
        segmenting.fail(f"{benchmark} has no off/N.off with a "
                        "seg/Benchmark/N/*.seg")
    return sorted(found, key=lambda path: int(path.stem))


def human_labels(benchmark, stem):
    folder = benchmark / "seg/Benchmark" / stem
    return [segmenting.read_labels(path)
            for path in sorted(folder.glob("*.seg"))]


def write_cuts(benchmark, made, stem, out):
    """One file a cut; returns marrow's answer."""
    answer = segmenting.read_answer(made, stem)
    last = segmenting.deepest_level(answer)
    leaves = segmenting.cut_labels(made, stem, f"level-{last}")
    cuts = {f"level-{level}": segmenting.cut_labels(
        made, stem, f"level-{min(level, last)}") for level in (1, 2)}
    cuts[AUTOMATIC] = segmenting.cut_labels(made, stem)
    cuts[BEST] = best_cut.best_cut(answer["tree"]["nodes"], leaves,
                                   human_labels(benchmark, stem))
    cuts[FACES] = range(len(leaves))
    for cut, labels in cuts.items():
        segmenting.write_labels(out / cut / f"{stem}.seg", labels)
    return answer


def ask_for_all(program, benchmark, out):
    """Cut -> its scores."""
    with concurrent.futures.ThreadPoolExecutor(segmenting.jobs()) as pool:
        answers = pool.map(
            lambda cut: judge.ask(program, benchmark, out / cut), CUTS)
        return dict(zip(CUTS, answers))


def row(name, models, measures):
    decimals = {"parts": 1, "ratio": 2}
    return [name, models] + [Number(measures[key], decimals.get(key, 3))
                             for key in judge.MEASURES]


def category_table(scores):
    rows = [row(name, models, measures)
            for name, (models, measures) in scores.categories.items()]
    rows.append(row("**mean**", len(scores.models), scores.mean))
    return document.table(["category", "models", *judge.MEASURES], rows)


def seconds_text(answers):
    total = [answer["timings"]["total_seconds"] for answer in answers]
    solver = [answer["timings"]["spectrum_seconds"] for answer in answers]
    rest = [a - b for a, b in zip(total, solver)]
    each = (f"{name} {statistics.median(values):.2f} ({sum(values):.0f})"
            for name, values in (("whole", total), ("eigen-pairs", solver),
                                 ("the rest", rest)))
    return ("Seconds a model, median (and sum over all): " + ", ".join(each)
            + f"; {segmenting.jobs()} models at a time.")


def model_rows(all_scores, numbers):
    """A row a model, with the error of its best cut and of its faces."""
    rows = []
    for number in numbers:
        category, measures = all_scores[AUTOMATIC].models[number]
        others = [Number(all_scores[cut].models[number][1]["RI"])
                  for cut in (BEST, FACES)]
        rows.append([str(number), category, Number(measures["RI"]), *others,
                     Number(measures["Hamming"]),
                     Number(measures["parts"], 0),
                     Number(measures["ratio"], 2)])
    return document.table(["model", "category", "RI", "RI, best cut",
                           "RI, every face", "Hamming", "parts", "ratio"],
                          rows)


def model_lists(all_scores):
    """Models that are worse than their faces, the worst, those left whole."""
    automatic = all_scores[AUTOMATIC].models
    error = {number: row["RI"] for number, (_, row) in automatic.items()}
    worse = [number for number in error
             if error[number] > all_scores[FACES].models[number][1]["RI"]]
    whole = [str(number) for number, (_, row) in automatic.items()
             if row["parts"] < 2]
    worst = sorted(error, key=error.get, reverse=True)[:NUM_WORST]
    text = (f"Left as one segment: {', '.join(whole) or 'none'}.\n\n"
            f"Worse than every face its own: {len(worse)} of {len(error)} "
            "models.\n\n")
    if worse:
        text += model_rows(all_scores, worse) + "\n"
    return (text + f"The {len(worst)} worst by RI:\n\n"
            + model_rows(all_scores, worst))


def report(all_scores, answers):
    parts = [segmenting.occasion() + "\n" + seconds_text(answers)]
    for cut, name in CUTS.items():
        note = (": a bound, chosen with the answers in hand"
                if cut == BEST else "")
        parts.append(f"### {name.capitalize()}{note}\n\n"
                     + category_table(all_scores[cut]).rstrip())
    parts.append(model_lists(all_scores).rstrip())
    return "\n\n".join(parts) + "\n"


def main():
    parser = argparse.ArgumentParser(prog="./dev psb", description=__doc__)
    parser.add_argument("benchmark", type=pathlib.Path, metavar="BENCHMARK")
    parser.add_argument("judge", type=pathlib.Path, metavar="JUDGE",
                        help="program that prints the scores")
    parser.add_argument("-o", "--output", type=pathlib.Path,
                        default=segmenting.ROOT / "out/psb", metavar="DIR",
                        help="folder of the segmentations (out/psb)")
    parser.add_argument("--document", type=pathlib.Path, metavar="FILE",
                        default=segmenting.ROOT / "docs/quality.md",
                        help="where the table goes (docs/quality.md)")
    arguments = parser.parse_args()
    models = models_of(arguments.benchmark)
    made = arguments.output / "marrow"
    print(f"-- segmenting {len(models)} models", flush=True)
    segmenting.segment(models, made)
    answers = [write_cuts(arguments.benchmark, made, path.stem,
                          arguments.output) for path in models]
    print(f"-- asking the judge about {len(CUTS)} cuts", flush=True)
    scores = ask_for_all(arguments.judge.resolve(), arguments.benchmark,
                         arguments.output)
    text = report(scores, answers)
    print(text)
    document.replace_part(arguments.document, "psb", text)


if __name__ == "__main__":
    main()
