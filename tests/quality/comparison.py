"""How far apart two labellings of the same faces are, every face counting as
one. 0 is equal up to the names of the labels."""

import numpy


def table(a, b):
    """Faces by label of a and label of b."""
    _, rows = numpy.unique(a, return_inverse=True)
    _, columns = numpy.unique(b, return_inverse=True)
    shape = rows.max() + 1, columns.max() + 1
    counts = numpy.bincount(rows * shape[1] + columns,
                            minlength=shape[0] * shape[1])
    return counts.reshape(shape)


def pairs(counts):
    """Pairs of faces within groups of these sizes."""
    counts = numpy.asarray(counts, dtype=numpy.float64)
    return (counts * (counts - 1)).sum() / 2


def rand_error(a, b):
    """The share of face pairs that one joins and the other parts."""
    both = table(a, b)
    disagree = (pairs(both.sum(axis=1)) + pairs(both.sum(axis=0))
                - 2 * pairs(both))
    return disagree / max(pairs([len(a)]), 1)


def hamming(a, b):
    """The mean of the shares of faces outside of the best match, of a's
    groups in b and of b's in a."""
    both = table(a, b)
    matched = both.max(axis=1).sum() + both.max(axis=0).sum()
    return 1 - matched / (2 * len(a))


# A limb counts as found where what stands for it is like it by so much.
FOUND = 0.7


def num_limbs_found(labels, parts, names):
    """How many parts, all but the first, are there as one or more segments.

    The segments that lie in the part by more than half stand for it; like it
    is the share of faces in both, of those in either.
    """
    both = table(labels, parts)
    found = 0
    for part in range(1, len(names)):
        mine = both[:, part] * 2 > both.sum(axis=1)
        common = both[mine, part].sum()
        either = both[mine].sum() + both[:, part].sum() - common
        found += common >= FOUND * either
    return int(found)
