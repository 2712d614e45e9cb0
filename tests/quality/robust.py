"""How far the automatic cut changes with the pose, with noise, with the
triangles, and where limbs touch.

Meshes and samples are disturbed, and poses compared with each other, each pose
being a file of a folder with one list of faces. What is measured goes to
docs/quality.md; nothing is written there for what was not given.
"""

import argparse
import itertools
import pathlib
import re

import comparison
import document
import glue
import segmenting
import surface as surfaces
from document import Number

SAMPLES = ("humanoid", "quadruped", "hand", "octopus")
SAMPLE_FACES = 10000

# What disturbs a surface, and how its faces lie in the old surface: by number
# of children, or by nearness where that is 0.
DISTURBANCES = {
    "noise 0.2": (lambda surface: surfaces.add_noise(surface, 0.2), 1),
    "noise 0.5": (lambda surface: surfaces.add_noise(surface, 0.5), 1),
    "noise 1.0": (lambda surface: surfaces.add_noise(surface, 1.0), 1),
    "half": (lambda surface: surfaces.decimate(surface, 0.5), 0),
    "quarter": (lambda surface: surfaces.decimate(surface, 0.25), 0),
    "subdivided": (surfaces.subdivide, 4),
    "1 % missing": (lambda surface: surfaces.without_faces(surface, 0.01), 0),
}

# A file of several bodies in one folder names its body so.
BODY = re.compile(r"tr_reg_(\d\d)\d")

# Sample, pose, and the two limbs that are glued, each with the stretch of it,
# from 0 at the body to 1 at the tip; part 0 is the body itself.
WHOLE, MIDDLE, TIP = (0, 1), (0.35, 0.7), (0.7, 1)
GLUED = (
    ("humanoid", "rest", "left_arm", TIP, "torso", WHOLE),
    ("humanoid", "rest", "left_leg", MIDDLE, "right_leg", MIDDLE),
    ("humanoid", "sit", "right_arm", TIP, "right_leg", MIDDLE),
    ("quadruped", "rest", "left_foreleg", MIDDLE, "right_foreleg", MIDDLE),
    ("quadruped", "rest", "left_hindleg", MIDDLE, "right_hindleg", MIDDLE),
    ("hand", "rest", "index", TIP, "middle", TIP),
    ("hand", "grasp", "thumb", TIP, "index", MIDDLE),
    ("octopus", "rest", "tentacle_1", MIDDLE, "tentacle_2", MIDDLE),
)


def mean_and_max(values):
    return [Number(sum(values) / len(values)), Number(max(values))]


def pose_groups(folder):
    """Name -> files of one body, by folder and BODY."""
    groups = {}
    for path in segmenting.meshes_below(folder):
        body = BODY.match(path.stem)
        name = path.parent.name + (f" {body[1]}" if body else "")
        groups.setdefault(name, []).append(path)
    return {name: files for name, files in groups.items() if len(files) > 1}


def pose_row(name, files, out):
    segmenting.segment(files, out)
    labels = [segmenting.cut_labels(out, path.stem) for path in files]
    if len({len(each) for each in labels}) > 1:
        segmenting.fail(f"the poses of {name} differ in their faces")
    pairs = list(itertools.combinations(labels, 2))
    counts = [len(set(each)) for each in labels]
    return [name, len(files), len(pairs),
            *mean_and_max([comparison.rand_error(*pair) for pair in pairs]),
            *mean_and_max([comparison.hamming(*pair) for pair in pairs]),
            f"{min(counts)} to {max(counts)}"]


def mean_row(rows):
    """The means of the columns of means, the maxima of the others."""
    columns = list(zip(*rows))
    summary = [mean_and_max(column)[index % 2]
               for index, column in enumerate(columns[3:7])]
    return ["**all**", sum(columns[1]), sum(columns[2]), *summary, ""]


def pose_table(folder, out):
    rows = [pose_row(name, files, out / "poses" / name.replace(" ", "-"))
            for name, files in pose_groups(folder).items()]
    if not rows:
        segmenting.fail(f"{folder} has no two poses of a body")
    return document.table(
        ["body", "poses", "pairs", "RI, mean", "RI, most", "Hamming, mean",
         "Hamming, most", "segments"], rows + [mean_row(rows)])


def read_clean(files, folder):
    """Stem -> surface, of the meshes of triangles that were segmented."""
    found = {}
    for path in files:
        surface = surfaces.read_coloured(folder / f"{path.stem}.level-1.ply")
        if surface is None:
            print(f"-- {path}: left out, not all faces are triangles")
        else:
            found[path.stem] = surface
    return found


def carried_back(labels, clean, disturbed, children):
    """Labels of the disturbed faces -> labels of the clean ones."""
    if children == 0:
        return labels[surfaces.nearest_faces(clean, disturbed)]
    # The last of four is the one in the middle.
    return labels[children - 1::children]


def disturbed_errors(name, clean, reference, out):
    """Stem -> Rand-index error against the clean cut."""
    change, children = DISTURBANCES[name]
    folder = out / name.replace(" ", "-")
    files, surface_of = [], {}
    for stem, surface in clean.items():
        surface_of[stem] = change(surface)
        files.append(folder / f"{stem}.off")
        surfaces.write_off(files[-1], surface_of[stem])
    segmenting.segment(files, folder)
    return {stem: comparison.rand_error(
        carried_back(segmenting.cut_labels(folder, stem), surface,
                     surface_of[stem], children), reference[stem])
            for stem, surface in clean.items()}


def sample_files(out, faces, names=SAMPLES):
    files = [out / f"sample-{name}.off" for name in names]
    for name, path in zip(names, files):
        segmenting.sample(name, path, faces)
    return files


def disturbance_table(files, out, names=tuple(DISTURBANCES)):
    segmenting.segment(files, out / "clean")
    clean = read_clean(files, out / "clean")
    reference = {stem: segmenting.cut_labels(out / "clean", stem)
                 for stem in clean}
    columns = []
    for name in names:
        print(f"-- {name}", flush=True)
        columns.append(disturbed_errors(name, clean, reference, out))
    rows = [[stem, len(surface[1]), len(set(reference[stem]))]
            + [Number(column[stem]) for column in columns]
            for stem, surface in clean.items()]
    summaries = zip(*(mean_and_max(column.values()) for column in columns))
    rows += [[f"**{what}**", "", "", *numbers]
             for what, numbers in zip(("mean", "most"), summaries)]
    return document.table(["mesh", "faces", "segments", *names], rows)


def stretch(surface, parts, names, limb, ends):
    """The vertices of a limb in that stretch, by distance to its body."""
    points, faces = surface
    part = names.index(limb)
    mine = set(faces[parts == part].ravel())
    if part == 0:
        return mine
    body = points[list(mine & set(faces[parts == 0].ravel()))].mean(axis=0)
    distance = {vertex: ((points[vertex] - body) ** 2).sum() ** 0.5
                for vertex in mine}
    longest = max(distance.values())
    return {vertex for vertex in mine
            if ends[0] <= distance[vertex] / longest <= ends[1]}


def glued_row(case, out, faces):
    name, pose, limb, ends, other, other_ends = case
    path = out / f"{name}-{pose}-{limb}-{other}.off"
    names, parts = segmenting.sample(name, path, faces, pose)
    surface = surfaces.read_off(path)
    glued = glue.glue(surface,
                      stretch(surface, parts, names, limb, ends),
                      stretch(surface, parts, names, other, other_ends))
    what = [f"{name}, {pose}", f"{limb} to {other}", len(names) - 1]
    if glued is None:
        segmenting.fail(f"{path.stem}: a tube would be too large")
    joined, kept, share = glued
    touching = path.with_name(f"{path.stem}-glued.off")
    surfaces.write_off(touching, joined)
    segmenting.segment([path, touching], out)
    before = segmenting.cut_labels(out, path.stem)
    after = segmenting.cut_labels(out, touching.stem)[:len(kept)]
    return what + [
        comparison.num_limbs_found(before, parts, names),
        comparison.num_limbs_found(after, parts[kept], names),
        Number(comparison.rand_error(before[kept], after)),
        Number(100 * share, 1)]


def glued_table(out, faces, cases=GLUED):
    return document.table(
        ["sample", "glued", "limbs", "found", "found glued", "RI",
         "tube, % of area"], [glued_row(case, out, faces) for case in cases])


def main():
    parser = argparse.ArgumentParser(prog="./dev robust", description=__doc__)
    parser.add_argument("meshes", nargs="?", type=pathlib.Path,
                        metavar="MESHES", help="folder of meshes")
    parser.add_argument("poses", nargs="?", type=pathlib.Path,
                        metavar="POSES",
                        help="folder of folders with the poses of a body each")
    parser.add_argument("-o", "--output", type=pathlib.Path,
                        default=segmenting.ROOT / "out/robust", metavar="DIR",
                        help="folder of what is made (out/robust)")
    parser.add_argument("--faces", type=int, default=SAMPLE_FACES,
                        help=f"faces of a sample ({SAMPLE_FACES})")
    parser.add_argument("--document", type=pathlib.Path, metavar="FILE",
                        default=segmenting.ROOT / "docs/quality.md",
                        help="where the tables go (docs/quality.md)")
    arguments = parser.parse_args()
    out = arguments.output
    tables = {"glued": glued_table(out / "glued", arguments.faces)}
    files = sample_files(out / "samples", arguments.faces)
    if arguments.meshes:
        files = segmenting.meshes_below(arguments.meshes) + files
    tables["disturbed"] = disturbance_table(files, out)
    if arguments.poses:
        tables["poses"] = pose_table(arguments.poses, out)
    for part, table in tables.items():
        text = f"{segmenting.occasion()}\n\n{table}"
        print(f"{part}\n\n{text}")
        document.replace_part(arguments.document, part, text)


if __name__ == "__main__":
    main()
