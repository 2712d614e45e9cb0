"""The cut of a tree that is nearest to given labellings.

The Rand-index error of a cut S against a labelling H of n faces is

    (pairs(S) + pairs(H) - 2 pairs(S and H)) / pairs(n),

where pairs counts those within one group. It is a sum over the segments of S
and a constant, so its mean over several labellings is least where every node,
from the leaves up, is kept or split as is less.
"""

import numpy

import comparison


def counts_by_node(nodes, leaf_labels, labelling):
    """Node id -> its faces by label of `labelling`."""
    labels, columns = numpy.unique(labelling, return_inverse=True)
    counts = numpy.zeros((len(nodes), len(labels)))
    numpy.add.at(counts, (leaf_labels, columns), 1)
    for node in reversed(nodes):
        if node["parent"] is not None:
            counts[node["parent"]] += counts[node["id"]]
    return counts


def best_cut(nodes, leaf_labels, labellings):
    """The labels of the cut with the least mean error.

    `nodes` are the tree's, ids ascending from 0, parents first; `leaf_labels`
    the ids of its deepest level, a face.
    """
    cost = numpy.zeros(len(nodes))
    for labelling in labellings:
        counts = counts_by_node(nodes, leaf_labels, labelling)
        for node, row in enumerate(counts):
            cost[node] += (comparison.pairs([row.sum()])
                           - 2 * comparison.pairs(row))
    kept = [True] * len(nodes)
    for node in reversed(nodes):
        children = node["children"]
        split = sum(cost[child] for child in children)
        if children and split < cost[node["id"]]:
            cost[node["id"]] = split
            kept[node["id"]] = False
    segment = []
    for node in nodes:
        parent = node["parent"]
        closed = parent is not None and kept[parent]
        if closed:
            kept[node["id"]] = True
        segment.append(segment[parent] if closed else node["id"])
    return numpy.array(segment)[leaf_labels]
