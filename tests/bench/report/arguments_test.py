import argparse
import contextlib
import io
import unittest

from arguments import numbers, parse, request_options


class Numbers(unittest.TestCase):
    def test_lists_and_ranges_are_accepted(self):
        for text, expected in [("7", [7]), ("1-3,7", [1, 2, 3, 7]), ("15-60:15", [15, 30, 45, 60]),
                               ("1-10:4,2", [1, 5, 9, 2])]:
            self.assertEqual(numbers(text), expected)

    def test_anything_else_is_rejected(self):
        for text in ["", ",", "1,", "a", "1-", "3-1", "1-3:0", "1-3:", "1 2", "-1", "1.5", "0-1000000"]:
            with self.assertRaises(argparse.ArgumentTypeError, msg=text):
                numbers(text)


class Arguments(unittest.TestCase):
    def test_the_default_is_a_quick_run_of_both_halls_without_a_chart(self):
        arguments = parse([])
        self.assertEqual(arguments.halls, ["empty", "rects"])
        self.assertEqual(arguments.seeds, [1, 2, 3])
        self.assertEqual(arguments.robots, [60, 120, 180, 240, 300])
        self.assertEqual(request_options(arguments, arguments.budget), {"time_budget_ms": 60_000})
        self.assertIsNone(arguments.svg)

    def test_full_is_the_whole_protocol_of_the_paper(self):
        arguments = parse(["--full"])
        self.assertEqual(arguments.seeds, list(range(1, 101)))
        self.assertEqual(arguments.robots, list(range(15, 301, 15)))

    def test_files_are_measured_with_all_robots_unless_fewer_are_given(self):
        self.assertEqual(parse(["a.json"]).robots, [])
        self.assertEqual(parse(["--robots", "5,6", "a.json"]).robots, [5, 6])

    def test_options_go_into_the_requests(self):
        arguments = parse(["--budget", "2.5", "--mode", "anytime", "--options", '{"connectivity": 4}'])
        self.assertEqual(request_options(arguments, 2.5), {"time_budget_ms": 2500, "mode": "anytime", "connectivity": 4})

    def test_files_to_write_are_named_after_what_is_measured(self):
        for words, csv in [([], "to/paper.csv"), (["--scaling"], "to/scaling.csv"), (["--buildings"], "to/buildings.csv"),
                           (["a.json"], "to/files.csv"),
                           (["--reference", "r.csv", "a.json"], "to/comparison.csv"), (["--csv", "mine.csv"], "mine.csv"),
                           (["--output", "there"], "there/paper.csv")]:
            self.assertEqual(parse(["--output", "to", *words]).csv, csv)
        self.assertEqual(parse(["--output", "to", "--chart"]).svg, "to/paper.svg")
        self.assertEqual(parse(["--output", "to", "--svg", "mine.svg"]).svg, "mine.svg")

    def test_files_of_the_reference_are_beside_it_unless_another_root_is_given(self):
        for words, root in [(["data/r.csv"], "data"), (["r.csv"], "."), (["data/r.csv", "--root", "x"], "x")]:
            self.assertEqual(parse(["--reference", *words]).root, root)

    def test_mistakes_are_rejected_with_the_name_of_the_flag(self):
        for words in [["--seeds", "x"], ["--robots", "0"], ["--options", "[1]"], ["--robot-defaults", "1"],
                      ["--halls", "round"], ["--budget", "0"], ["--repeat", "x"], ["--bogus"]]:
            with contextlib.redirect_stderr(io.StringIO()) as message, self.assertRaises(SystemExit) as exit_:
                parse(words)
            self.assertEqual(exit_.exception.code, 2)
            self.assertIn(words[0], message.getvalue())

    def test_charts_are_only_of_the_papers_workloads(self):
        with contextlib.redirect_stderr(io.StringIO()), self.assertRaises(SystemExit):
            parse(["--chart", "--scaling"])

    def test_another_binary_is_only_for_measurements(self):
        for words in [[], ["--buildings"], ["--reference", "r.csv"]]:
            arguments = parse(["--output", "to", "--binary", "old", *words])
            self.assertEqual((arguments.binary, arguments.binary_csv), ("old", "to/binary.csv"))
        with contextlib.redirect_stderr(io.StringIO()) as message, self.assertRaises(SystemExit):
            parse(["--binary", "old", "--read", "paper.csv"])
        self.assertIn("--binary", message.getvalue())

    def test_budgets_of_a_reference_need_one(self):
        self.assertTrue(parse(["--reference", "r.csv", "--reference-budget"]).reference_budget)
        for words in [["--reference-budget"], ["--buildings", "--reference", "r.csv", "--reference-budget"]]:
            with contextlib.redirect_stderr(io.StringIO()) as message, self.assertRaises(SystemExit):
                parse(words)
            self.assertIn("--reference-budget", message.getvalue())

    def test_a_crowd_is_a_hall_on_request(self):
        self.assertEqual(parse(["--halls", "crowd,rects"]).halls, ["crowd", "rects"])

    def test_help_is_not_a_mistake(self):
        with contextlib.redirect_stdout(io.StringIO()) as text, self.assertRaises(SystemExit) as exit_:
            parse(["--help"])
        self.assertEqual(exit_.exception.code, 0)
        self.assertIn("--reference", text.getvalue())


if __name__ == "__main__":
    unittest.main()
