import itertools
import unittest

import numpy

import comparison


def slow_rand_error(a, b):
    pairs = list(itertools.combinations(range(len(a)), 2))
    return sum((a[i] == a[j]) != (b[i] == b[j]) for i, j in pairs) / len(pairs)


class ComparisonTest(unittest.TestCase):

    def test_rand_error_counts_pairs(self):
        random = numpy.random.default_rng(3)
        for _ in range(20):
            a, b = random.integers(0, 5, (2, 30))
            self.assertAlmostEqual(comparison.rand_error(a, b),
                                   slow_rand_error(a, b))

    def test_names_of_labels_do_not_count(self):
        a, b = numpy.array([4, 4, 9, 7]), numpy.array([1, 1, 0, 5])
        self.assertEqual(comparison.rand_error(a, b), 0)
        self.assertEqual(comparison.hamming(a, b), 0)

    def test_hamming_is_the_mean_of_missing_and_wrong(self):
        # The group of four loses one to the other side of b, whose groups lie
        # in a's.
        a, b = numpy.array([0, 0, 0, 0, 1]), numpy.array([0, 0, 0, 2, 1])
        self.assertAlmostEqual(comparison.hamming(a, b), 0.1)
        self.assertAlmostEqual(comparison.hamming(b, a), 0.1)

    def test_finds_limbs_in_one_segment_or_several(self):
        names = ["body", "arm", "leg", "tail"]
        parts = numpy.repeat([0, 1, 2, 3], [10, 10, 10, 10])
        labels = numpy.repeat([0, 1, 2, 3, 0], [8, 7, 5, 10, 10])
        # Body and tail are one; the arm is two segments with some of the body.
        self.assertEqual(
            comparison.num_limbs_found(labels, parts, names), 2)
        self.assertEqual(
            comparison.num_limbs_found(numpy.zeros(40), parts, names), 0)


if __name__ == "__main__":
    unittest.main()
