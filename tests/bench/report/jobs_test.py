import json
import pathlib
import tempfile
import unittest

from jobs import (file_jobs, hall_jobs, named_workload, reference_jobs, request_files, single_jobs,
                  within_reference_times)
from support import result

REQUEST = json.dumps({"map": {}, "robots": []})


class WithFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, text):
        file = self.folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)


class RequestFiles(WithFolder):
    def test_those_of_a_folder_are_found_at_any_depth(self):
        self.write("b.json", REQUEST)
        self.write("deep/er/a.json", REQUEST)
        self.write("index.json", "[]")
        self.write("notes.txt", REQUEST)
        self.assertEqual(request_files([str(self.folder)]),
                         [self.folder / "b.json", self.folder / "deep/er/a.json"])
        self.assertEqual(file_jobs([str(self.folder / "b.json")], [5]),
                         [{"name": str(self.folder / "b.json"), "file": str(self.folder / "b.json"), "robots": [5]}])

    def test_those_that_cannot_be_read_are_named(self):
        self.write("broken.json", "{")
        with self.assertRaisesRegex(ValueError, "broken.json is not JSON"):
            request_files([str(self.folder)])
        with self.assertRaisesRegex(ValueError, "none does not exist"):
            request_files([str(self.folder / "none")])


class Workloads(unittest.TestCase):
    def test_halls_are_measured_seed_by_seed(self):
        jobs = hall_jobs(["empty", "rects"], [4, 5], [15, 30])
        self.assertEqual([job["name"] for job in jobs], ["empty/4", "rects/4", "empty/5", "rects/5"])
        self.assertEqual(jobs[1], {"name": "rects/4", "robots": [15, 30],
                                   "workload": {"hall": "rects", "side": 64, "seed": 4, "robots": 300}})

    def test_they_are_known_by_their_names(self):
        self.assertEqual(named_workload("rects/12", [])["workload"]["seed"], 12)
        self.assertEqual(named_workload("crowd/2", [256])["workload"],
                         {"hall": "crowd", "side": 32, "seed": 2, "robots": 512})
        for name in ["rects/", "rects/1-2", "maps/1"]:
            self.assertIsNone(named_workload(name, []), name)


    def test_they_can_have_a_job_for_each_number_of_robots(self):
        jobs = [{"name": "a", "robots": [15, 30]}, {"name": "b", "robots": []}]
        self.assertEqual(single_jobs(jobs), [{"name": "a", "robots": [15]}, {"name": "a", "robots": [30]},
                                             {"name": "b", "robots": []}])

    def test_the_reference_gives_budgets_where_it_took_long_enough(self):
        jobs = [{"name": "a", "robots": [15, 30, 45, 60]}]
        reference = [result("a", 15, 0.19, 1.0), result("a", 30, 0.2, 1.0), result("a", 45, 60.0),
                     result("a", 60, 2.5, 1.0)]
        self.assertEqual(within_reference_times(jobs, reference),
                         [{"name": "a", "robots": [30], "budget": 0.2}, {"name": "a", "robots": [60], "budget": 2.5}])


class ReferenceJobs(WithFolder):
    def setUp(self):
        super().setUp()
        self.write("sub/a.json", REQUEST)
        self.reference = [result("sub/a.json", 2, 1.0, 1.0), result("empty/3", 15, 1.0, 1.0),
                          result("sub/a.json", 4, 1.0, 1.0)]

    def test_they_are_the_rows_of_the_reference(self):
        jobs = reference_jobs([], [], self.reference, str(self.folder))
        self.assertEqual([(job["name"], job["robots"]) for job in jobs], [("sub/a.json", [2, 4]), ("empty/3", [15])])
        self.assertEqual(jobs[0]["file"], str(self.folder / "sub/a.json"))

    def test_given_files_have_the_names_of_the_reference(self):
        job, = reference_jobs([str(self.folder / "sub")], [], self.reference, str(self.folder))
        self.assertEqual((job["name"], job["robots"]), ("sub/a.json", [2, 4]))

    def test_given_numbers_of_robots_replace_those_of_the_reference(self):
        job, = reference_jobs([str(self.folder / "sub")], [3], self.reference, str(self.folder))
        self.assertEqual(job["robots"], [3])

    def test_missing_files_are_named(self):
        with self.assertRaisesRegex(ValueError, "missing.json"):
            reference_jobs([], [], [result("missing.json", 1, 1.0, 1.0)], ".")


if __name__ == "__main__":
    unittest.main()
