import itertools
import unittest

import numpy

import best_cut
import comparison

# 0 -> 1, 2; 1 -> 3, 4; 3 -> 7 (only child) -> 8, 9; 2 -> 5, 6.
PARENTS = [None, 0, 0, 1, 1, 2, 2, 3, 7, 7]
LEAVES = [4, 5, 6, 8, 9]


def tree():
    return [{"id": node, "parent": parent,
             "children": [child for child, other in enumerate(PARENTS)
                          if other == node]}
            for node, parent in enumerate(PARENTS)]


def all_cuts(nodes, root=0):
    """Each cut below a node, as a list of nodes."""
    yield [root]
    children = nodes[root]["children"]
    if children:
        below = [list(all_cuts(nodes, child)) for child in children]
        for choice in itertools.product(*below):
            yield sum(choice, [])


def labels_of(cut, leaves):
    def ancestor_in_cut(node):
        while node not in cut:
            node = PARENTS[node]
        return node
    return numpy.array([ancestor_in_cut(leaf) for leaf in leaves])


def mean_error(labels, people):
    return numpy.mean([comparison.rand_error(labels, each)
                       for each in people])


class BestCutTest(unittest.TestCase):

    def test_no_cut_is_better(self):
        nodes, random = tree(), numpy.random.default_rng(7)
        sizes = set()
        for _ in range(40):
            leaves = random.choice(LEAVES, 60)
            merged = random.integers(0, 4, len(PARENTS))
            people = [numpy.where(random.random(60) < 0.2,
                                  random.integers(0, 4, 60), merged[leaves])
                      for _ in range(3)]
            found = best_cut.best_cut(nodes, leaves, people)
            least = min(mean_error(labels_of(cut, leaves), people)
                        for cut in all_cuts(nodes))
            self.assertAlmostEqual(mean_error(found, people), least)
            sizes.add(len(set(found)))
        self.assertGreater(len(sizes), 2)

    def test_people_who_see_one_part_keep_the_root(self):
        leaves = numpy.repeat(LEAVES, 5)
        found = best_cut.best_cut(tree(), leaves, [numpy.zeros(25, int)])
        self.assertEqual(set(found), {0})


if __name__ == "__main__":
    unittest.main()
