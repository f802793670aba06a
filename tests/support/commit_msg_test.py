"""The git hook scripts/commit-msg."""

import os
import pathlib
import subprocess
import tempfile
import unittest

HOOK = pathlib.Path(__file__).resolve().parents[2] / "scripts/commit-msg"


def fault_of(message):
    """What the hook says about a message; empty if it accepts it."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "COMMIT_EDITMSG"
        file.write_text(message, encoding="utf-8")
        done = subprocess.run([HOOK, file], capture_output=True, text=True, check=False)
    assert (done.returncode == 0) == (done.stderr == ""), done
    return done.stderr


class CommitMsg(unittest.TestCase):
    def test_accepts_a_short_subject_alone_or_before_a_body(self):
        for message in ["Fix it\n", "Fix it", "x" * 72 + "\n", "Fix it\n\nIt was broken.\n" + "x" * 200 + "\n"]:
            self.assertEqual(fault_of(message), "", message)

    def test_rejects_a_long_subject(self):
        self.assertIn("73 characters", fault_of("x" * 73 + "\n"))
        self.assertIn("73 characters", fault_of("x" * 73 + "\n\nIt was broken.\n"))

    def test_counts_characters_rather_than_bytes(self):
        self.assertEqual(fault_of("ä" * 72 + "\n"), "")
        self.assertIn("73 characters", fault_of("ä" * 73 + "\n"))

    def test_rejects_a_body_without_an_empty_line_before_it(self):
        self.assertIn("second line", fault_of("Fix it\nIt was broken.\n"))

    def test_ignores_what_git_drops(self):
        self.assertEqual(fault_of("\n\nFix it\n# " + "x" * 80 + "\n#\n"), "")
        self.assertEqual(fault_of("# " + "x" * 80 + "\nFix it\n\nIt was broken.\n"), "")
        scissors = "# ------------------------ >8 ------------------------\n"
        self.assertEqual(fault_of("Fix it\n" + scissors + "diff --git a/a b/a\n"), "")

    def test_can_be_run_by_git(self):
        self.assertTrue(os.access(HOOK, os.X_OK))


if __name__ == "__main__":
    unittest.main()
