"""The judge: a program that scores segmentations against those of people.

    JUDGE BENCHMARK SEGS --models

prints a row a model, then one for its category, and last one for "all". A row
is a name, the number of models, and the six columns of MEASURES, of four
decimals, but parts of one and ratio of two.
"""

import re
import subprocess

from segmenting import fail

MEASURES = ("RI", "Hamming", "GCE", "LCE", "parts", "ratio")

# A wide number fills its column and touches the one before.
ROW = re.compile(r"\s*(\S+)\s+(\d+)" + r"\s+(\d+\.\d{4})" * 4
                 + r"\s*(\d+\.\d)\s*(\d+\.\d\d)")


class Scores:
    """`models`: number -> (category, measures); `categories`: name -> (number
    of models, measures); `mean`: measures over the categories. Measures are
    dicts of MEASURES."""

    def __init__(self):
        self.models = {}
        self.categories = {}
        self.mean = None

    def add_category(self, name, models, measures, waiting):
        self.categories[name] = models, measures
        for number, row in waiting.items():
            self.models[number] = name, row
        waiting.clear()


def parse(text):
    scores, waiting = Scores(), {}
    for line in text.splitlines():
        match = ROW.fullmatch(line)
        if not match:
            continue
        name, models = match[1], int(match[2])
        measures = dict(zip(MEASURES, map(float, match.groups()[2:])))
        if name.isdigit():
            waiting[int(name)] = measures
        elif name == "all":
            scores.mean = measures
        elif waiting:
            scores.add_category(name, models, measures, waiting)
    if scores.mean is None or waiting:
        fail("the judge's answer is not the table that it should be:\n" + text)
    return scores


def ask(judge, benchmark, folder):
    """The judge's scores of the files N.seg of a folder."""
    answer = subprocess.run([judge, benchmark, folder, "--models"],
                            capture_output=True, text=True)
    if answer.returncode != 0:
        fail(f"{judge} failed on {folder}:\n{answer.stderr}{answer.stdout}")
    return parse(answer.stdout)
