#!/usr/bin/env python3
"""What the README tells a visitor to run, run against a server of this build.

Usage: readme_test.py FLEETPLAN_BINARY [unittest arguments]
"""

import json
import pathlib
import re
import subprocess
import sys
import unittest
import urllib.request

PROJECT = pathlib.Path(__file__).resolve().parent.parent.parent
README = (PROJECT / "README.md").read_text()
BINARY = None


def block(language):
    """The README's only block of code in a language."""
    blocks = re.findall(rf"^```{language}\n(.*?)^```$", README, re.MULTILINE | re.DOTALL)
    assert len(blocks) == 1, f"{len(blocks)} blocks of {language}"
    return blocks[0]


class Readme(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = subprocess.Popen([BINARY, "--port", "0", "--log-level", "off"],
                                      stdout=subprocess.PIPE, text=True)
        line = cls.server.stdout.readline()
        cls.url = re.search(r"http://\S+", line).group()

    @classmethod
    def tearDownClass(cls):
        cls.server.terminate()
        cls.server.wait()
        cls.server.stdout.close()

    def post(self, path, body):
        request = urllib.request.Request(self.url + path, json.dumps(body).encode(),
                                         {"Content-Type": "application/json"})
        with urllib.request.urlopen(request) as response:
            return json.load(response)

    def assert_shape(self, shown, answer, where="answer"):
        """The answer has at least the members that are shown, of the same types."""
        if isinstance(shown, dict):
            self.assertLessEqual(set(shown), set(answer), where)
            for key, value in shown.items():
                self.assert_shape(value, answer[key], f"{where}.{key}")
        elif isinstance(shown, list):
            self.assertGreaterEqual(len(answer), len(shown), where)
            for index, value in enumerate(shown):
                self.assert_shape(value, answer[index], f"{where}[{index}]")
        else:
            self.assertIs(type(answer), type(shown), where)

    def test_the_python_example_plans_for_every_robot(self):
        program = block("python").replace("http://localhost:8080", self.url)
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"(?s)\Asolved flowtime \d+\.\d+ s\nleft\n .*\nright\n .*\nparked\n\Z")

    def test_the_first_request_answers_as_shown_and_can_be_validated(self):
        shown = json.loads(block("json"))
        request = json.loads((PROJECT / "tests/scenarios/corridor-swap.json").read_text())
        answer = self.post("/v1/plan", request)
        self.assert_shape(shown, answer)
        self.assertEqual(shown["status"], answer["status"])
        self.assertAlmostEqual(shown["flowtime"], answer["flowtime"], delta=1.0)
        self.assertTrue(self.post("/v1/validate", {**request, **answer})["valid"])

    def test_the_settings_are_those_of_the_help(self):
        said = subprocess.run([BINARY, "--help"], capture_output=True, text=True, check=True).stdout
        flags = set(re.findall(r"--[a-z-]+", said)) - {"--help", "--version"}
        table = set(re.findall(r"^\| `(--[a-z-]+)` \|", README, re.MULTILINE))
        self.assertEqual(table, flags)

    def test_every_file_that_is_named_exists(self):
        named = re.findall(r"(?<![\w/])(?:scripts|tests)/[\w./-]*\w", README) + re.findall(r"\]\((\w[\w./-]+)\)", README)
        self.assertIn("scripts/serve", named)
        for name in named:
            self.assertTrue((PROJECT / name).exists(), name)


if __name__ == "__main__":
    BINARY = sys.argv.pop(1)
    unittest.main()
