"""Runs programs like fleetplan_bench, which read jobs from stdin and write rows of CSV."""

import json
import pathlib
import subprocess
import threading


def measure(program, jobs, file):
    """Measures the jobs. Writes every row to the CSV file as soon as it arrives."""
    text = "".join(json.dumps(job) + "\n" for job in jobs)
    with open_csv(file) as csv, \
            subprocess.Popen([program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        feeder = threading.Thread(target=feed, args=(process.stdin, text))
        feeder.start()
        for row in process.stdout:
            csv.write(row)
            csv.flush()
        feeder.join()
    check(process)


def measure_in_turn(program, jobs, file, other, other_jobs, other_file):
    """Measures with two programs, job by job and each first every other time, so that other work on the machine
    disturbs both alike."""
    with open_csv(file) as csv, open_csv(other_file) as other_csv:
        for number, (job, other_job) in enumerate(zip(jobs, other_jobs, strict=True)):
            turns = [(program, job, csv), (other, other_job, other_csv)]
            for turn in turns if number % 2 == 0 else reversed(turns):
                measure_one(*turn, with_head=number == 0)


def measure_one(program, job, csv, with_head):
    process = subprocess.run([program], input=json.dumps(job) + "\n", stdout=subprocess.PIPE, text=True, check=False)
    check(process)
    csv.writelines(process.stdout.splitlines(keepends=True)[0 if with_head else 1:])
    csv.flush()


def open_csv(file):
    pathlib.Path(file).parent.mkdir(parents=True, exist_ok=True)
    return open(file, "w", encoding="utf-8")


def check(process):
    if process.returncode != 0:
        raise ValueError("the measurement failed")


def feed(stdin, text):
    try:
        with stdin:
            stdin.write(text)
    except BrokenPipeError:
        pass  # the program ended; its exit status is checked
