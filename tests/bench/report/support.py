"""Shared by the tests of this folder."""

import contextlib
import io
import pathlib
import tempfile
import unittest

from results import Result, Run


def result(file, robots, seconds, flowtime=None):
    return Result(file, robots, flowtime is not None, 1, seconds, flowtime, flowtime)


def run(robots, seconds, flowtime=None, file="empty/1", **more):
    """A run that solved its instance if it has a flowtime; the lower bound is 100. Makespans are
    a tenth."""
    costs = {"makespan": None} if flowtime is None else {"makespan": flowtime / 10, "lower_bound": 100.0,
                                                              "makespan_lower_bound": 10.0}
    return Run(**{"file": file, "robots": robots, "solved": flowtime is not None, "attempts": 1, "seconds": seconds,
                  "flowtime": flowtime, "cpu_seconds": seconds, **costs, **more})


class ProgramTest(unittest.TestCase):
    """With a temporary folder, and in it a program that stands for a benchmark."""

    PROGRAM = ""  # its source

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.program = self.folder / "program"
        self.program.write_text(self.PROGRAM)
        self.program.chmod(0o755)

    def run_main(self, main, *words):
        """The exit status of main(PROGRAM, WORDS) and the text printed."""
        with contextlib.redirect_stdout(io.StringIO()) as text, contextlib.redirect_stderr(text):
            status = main(str(self.program), list(words))
        return status, text.getvalue()
