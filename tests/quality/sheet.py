"""Pictures of the automatic cuts of many meshes on one page.

A folder stands for all meshes in it and below.
"""

import argparse
import pathlib
import tempfile

import numpy
from PIL import Image, ImageDraw, ImageFont

import segmenting

CELL_WIDTH, CELL_HEIGHT, CAPTION, MARGIN = 640, 320, 26, 8
PAPER, INK = (247, 247, 245), (20, 20, 20)
COLUMNS = 4
FONTS = ("DejaVuSans.ttf", "LiberationSans-Regular.ttf")


def font():
    for name in FONTS:
        try:
            return ImageFont.truetype(name, 18)
        except OSError:
            continue
    return ImageFont.load_default()


def drawn(picture):
    """Which pixels are not of the colour of a corner."""
    pixels = numpy.asarray(picture)
    return (pixels != pixels[0, 0]).any(axis=2)


def trimmed(picture):
    """Without the empty border."""
    box = Image.fromarray(drawn(picture)).getbbox()
    return picture.crop(box) if box else picture


def views(picture):
    """The two views, side by side without the space around them; as they are
    where no empty column lies between them."""
    empty = numpy.flatnonzero(~drawn(picture).any(axis=0))
    split = min(empty, key=lambda x: abs(x - picture.width // 2), default=0)
    if not 0 < split < picture.width - 1:
        return trimmed(picture)
    sides = [trimmed(picture.crop(box)) for box in (
        (0, 0, split, picture.height),
        (split, 0, picture.width, picture.height))]
    gap = 24
    joined = Image.new("RGB", (sum(side.width for side in sides) + gap,
                               max(side.height for side in sides)), PAPER)
    joined.paste(sides[0], (0, 0))
    joined.paste(sides[1], (sides[0].width + gap, 0))
    return joined


def page(entries):
    """One picture of (caption, picture file) entries, row by row."""
    columns = min(COLUMNS, len(entries))
    rows = -(-len(entries) // columns)
    cell = CELL_WIDTH + 2 * MARGIN, CELL_HEIGHT + CAPTION + 2 * MARGIN
    sheet = Image.new("RGB", (columns * cell[0], rows * cell[1]), PAPER)
    draw, face = ImageDraw.Draw(sheet), font()
    for index, (caption, path) in enumerate(entries):
        x = index % columns * cell[0] + MARGIN
        y = index // columns * cell[1] + MARGIN
        with Image.open(path) as file:
            picture = views(file.convert("RGB"))
        picture.thumbnail((CELL_WIDTH, CELL_HEIGHT), Image.LANCZOS)
        sheet.paste(picture, (x + (CELL_WIDTH - picture.width) // 2,
                              y + CAPTION))
        draw.text((x + 2, y), caption, fill=INK, font=face)
    return sheet


def entry(path, folder):
    count = len(set(segmenting.cut_labels(folder, path.stem)))
    return (f"{path.stem}: {count} segments",
            folder / f"{path.stem}.{segmenting.AUTOMATIC_CUT}.png")


def main():
    parser = argparse.ArgumentParser(prog="./dev sheet", description=__doc__)
    parser.add_argument("meshes", nargs="+", type=pathlib.Path, metavar="MESH",
                        help="mesh files, or folders of them")
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="FILE",
                        default=segmenting.ROOT / "out/sheet.png",
                        help="the page (out/sheet.png)")
    arguments = parser.parse_args()
    files = []
    for path in arguments.meshes:
        files += segmenting.meshes_below(path) if path.is_dir() else [path]
    if not files:
        segmenting.fail("there is no mesh in those folders")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        segmenting.segment(files, folder, "--png")
        sheet = page([entry(path, folder) for path in files])
    arguments.output.parent.mkdir(parents=True, exist_ok=True)
    sheet.save(arguments.output)
    print(f"{len(files)} meshes -> {arguments.output}")


if __name__ == "__main__":
    main()
