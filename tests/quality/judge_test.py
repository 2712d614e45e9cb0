import contextlib
import io
import unittest

import judge

TABLE = """\
             models      RI  Hamming     GCE     LCE   parts  ratio
  81              1  0.0300   0.0400  0.0500  0.0200     9.0   1.10
  82              1  0.0500   0.0600  0.0700  0.0400     8.0   0.90
Ant               2  0.0400   0.0500  0.0600  0.0300     8.5   1.00
  181             1  0.1000   0.2000  0.1000  0.0500 20096.01177.17
Hand              1  0.1000   0.2000  0.1000  0.0500     6.0   1.00
articulated       3  0.0700   0.1250  0.0800  0.0400     7.2   1.00
all               3  0.0700   0.1250  0.0800  0.0400     7.2   1.00
"""


class JudgeTest(unittest.TestCase):

    def test_models_are_of_the_category_that_follows_them(self):
        scores = judge.parse(TABLE)
        self.assertEqual(list(scores.categories), ["Ant", "Hand"])
        self.assertEqual(scores.models[82][0], "Ant")
        self.assertEqual(scores.models[82][1]["Hamming"], 0.06)
        self.assertEqual(scores.models[181][0], "Hand")
        self.assertEqual(scores.models[181][1]["parts"], 20096)
        self.assertEqual(scores.models[181][1]["ratio"], 1177.17)
        self.assertEqual(scores.categories["Ant"][0], 2)
        self.assertEqual(scores.mean["ratio"], 1.0)

    def test_an_answer_without_a_mean_is_refused(self):
        told = io.StringIO()
        with contextlib.redirect_stderr(told):
            with self.assertRaises(SystemExit):
                judge.parse(TABLE.replace("all  ", "none "))
        self.assertIn("not the table", told.getvalue())


if __name__ == "__main__":
    unittest.main()
