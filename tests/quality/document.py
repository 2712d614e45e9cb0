"""Tables in Markdown, and the parts of a document that a program writes."""

import pathlib


def table(head, rows):
    """Rows of texts and numbers; texts are set left, numbers right."""
    numbers = [not isinstance(cell, str) for cell in (rows or [head])[0]]
    lines = [head, ["---:" if number else "---" for number in numbers]]
    lines += [[str(cell) for cell in row] for row in rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


class Number(float):
    """A number that shows a fixed count of decimals."""

    def __new__(cls, value, decimals=3):
        number = super().__new__(cls, value)
        number.decimals = decimals
        return number

    def __str__(self):
        return f"{float(self):.{self.decimals}f}"


def replace_part(path, name, text):
    """Puts text between the two lines that mark the part of that name."""
    path = pathlib.Path(path)
    begin, end = f"<!-- begin {name} -->\n", f"<!-- end {name} -->\n"
    document = path.read_text("utf-8")
    if document.count(begin) != 1 or document.count(end) != 1:
        raise ValueError(f"{path} has no lines {begin.strip()} and "
                         f"{end.strip()}: add them where the part belongs")
    before, rest = document.split(begin)
    after = rest.split(end)[1]
    path.write_text(f"{before}{begin}\n{text}\n{end}{after}", "utf-8")
