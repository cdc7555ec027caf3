"""test_sweep.py - parameter studies: which points, with which seeds, and what becomes of them when
something ends too early.

Called with the path of the binary.  Points are runs of a few dozen grains, some milliseconds each.

SPDX-License-Identifier: GPL-3.0-or-later
"""
import csv
import glob
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import verdict

PROGRAM = os.path.abspath(sys.argv.pop(1))

SCENE = """
model = "md"; until = 1.0; box = (0.0, 0.0, 8.0, 8.0); gravity = (0.0, -10.0);
grains = ({ radius = 0.4; restitution = 0.5; stiffness = 1e4; });
placements = ({ region = (1.0, 1.0, 7.0, 5.0); kind = "square"; spacing = 1.2;
                temperature = 1.0; });
output = { log = 0.05; frames = 0.1; checkpoint_wall = 0.0; };
"""
GRID = ["--vary", "grains.restitution=0.3:0.9:0.3", "--repeats", "2"]
# Some seconds a point, so that a signal finds it at work.
SLOW = ["-s", "md.dt=2e-6"]


class Sweep(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        memory = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
        cls.folder = tempfile.mkdtemp(prefix="sandreel-sweep-", dir=memory)
        with open(os.path.join(cls.folder, "box.cfg"), "w", encoding="utf-8") as out:
            out.write(SCENE)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder, ignore_errors=True)

    def call(self, *arguments, code=0, before=(), env=None):
        done = subprocess.run([*before, PROGRAM, *arguments], cwd=self.folder, capture_output=True,
                              text=True, timeout=300, check=False,
                              env=dict(os.environ, **(env or {})))
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def sweep(self, name, *arguments, code=0, **keywords):
        self.call("sweep", "box.cfg", "-o", name, *arguments, code=code, **keywords)
        return self.rows(name)

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def rows(self, name, file="results.csv"):
        with open(self.path(name, file), encoding="utf-8") as text:
            rows = list(csv.DictReader(text))
        for row in rows:                # what only tells how fast the machine was
            for column in [c for c in row if "seconds" in c]:
                del row[column]
        return rows

    # Which points

    def test_a_grid_has_every_combination_and_both_ends(self):
        rows = self.sweep("grid", *GRID)
        self.assertEqual([row["grains.restitution"] for row in rows],
                         ["0.3", "0.3", "0.6", "0.6", "0.9", "0.9"])
        self.assertEqual([row["repeat"] for row in rows], ["0", "1"] * 3)
        self.assertEqual(len({row["seed"] for row in rows}), 6)
        self.assertEqual(glob.glob(self.path("grid/points/*/frames")), [])
        # A collision loses 1 - r^2 of its energy: 0.91 against 0.19, far beyond the scatter of two.
        energies = [sum(float(row["kinetic_energy_mean"]) for row in rows[k:k + 2])
                    for k in (0, 2, 4)]
        self.assertLess(energies[0], energies[2])

    def test_a_point_is_the_run_with_its_values_and_its_seed(self):
        row = self.sweep("one", "--vary", "grains.restitution=0.7")[0]
        self.call("run", "box.cfg", "-s", "grains.restitution=0.7", "--seed", row["seed"], "-o",
                  "alone", "-j1")
        with open(self.path("alone/log.csv"), encoding="utf-8") as text:
            log = list(csv.DictReader(line for line in text if line[0] != "#"))
        self.assertEqual(float(row["kinetic_energy"]), float(log[-1]["kinetic_energy"]))
        late = [float(one["kinetic_energy"]) for one in log if float(one["time"]) >= 0.4999]
        self.assertAlmostEqual(float(row["kinetic_energy_mean"]), sum(late) / len(late), places=9)
        self.assertGreater(float(row["kinetic_energy_error"]), 0)

    def test_lists_take_words_and_vectors_and_combine(self):
        rows = self.sweep("lists", "--vary", "model=md,ed", "--vary", "gravity=(0, -1),(0, -2)")
        self.assertEqual([(row["model"], row["gravity"]) for row in rows],
                         [("md", "(0, -1)"), ("md", "(0, -2)"), ("ed", "(0, -1)"),
                          ("ed", "(0, -2)")])

    def test_random_points_lie_in_their_ranges_and_come_again(self):
        arguments = ["--random", "5", "--vary", "grains.restitution=0.2:0.4", "--vary",
                     "until=0.1,0.2"]
        rows = self.sweep("random", *arguments)
        self.assertEqual(rows, self.sweep("random2", *arguments))
        values = [float(row["grains.restitution"]) for row in rows]
        self.assertEqual(len(rows), 10)
        self.assertEqual(len(set(values)), 5)
        self.assertTrue(all(0.2 <= value <= 0.4 for value in values))
        other = self.sweep("random3", *arguments, "--seed", "2")
        self.assertNotEqual(values, [float(row["grains.restitution"]) for row in other])

    def test_a_seed_stays_when_the_study_grows(self):
        few = self.sweep("few", "--vary", "grains.restitution=0.5,0.6", "--until", "0.1")
        many = self.sweep("many", "--vary", "grains.restitution=0.4,0.5,0.6,0.7", "--until", "0.1")
        self.assertEqual([row["seed"] for row in few], [row["seed"] for row in many[1:3]])

    def test_wrong_studies_are_refused_before_anything_runs(self):
        for arguments, words in ((["--vary", "grains.restituton=0:1:0.5"], "did you mean"),
                                 (["--vary", "until=1:0:0.5"], "steps do not lead"),
                                 (["--vary", "until=1:2"], "--random"),
                                 (["--vary", "until"], "no key"), ([], "nothing is varied"),
                                 ([*GRID, "--shard", "3/2"], "--shard")):
            done = self.call("sweep", "box.cfg", "-o", "wrong", *arguments,
                             code=3 if "did" in words else 2)
            self.assertIn(words, done.stderr)
        self.assertFalse(os.path.exists(self.path("wrong")))

    # Points that fail, and going on

    def test_a_point_that_breaks_is_kept_apart_and_the_others_are_done(self):
        rows = self.sweep("broken", "--vary", "overlap_limit=0.3,1e-9,0.2", code=1)
        self.assertEqual([row["overlap_limit"] for row in rows], ["0.3", "0.2"])
        bad = self.rows("broken", "failed.csv")
        self.assertEqual([row["overlap_limit"] for row in bad], ["1e-9"])
        self.assertIn("exit code 1", bad[0]["cause"])
        self.assertIn("grain", bad[0]["cause"])

    def children(self, parent):
        found = []
        for name in glob.glob("/proc/[0-9]*/stat"):
            try:
                with open(name, encoding="utf-8", errors="replace") as text:
                    fields = text.read().rsplit(")", 1)[1].split()
            except OSError:
                continue
            if int(fields[1]) == parent:
                found.append(int(name.split("/")[2]))
        return found

    def start(self, name, *arguments):
        return subprocess.Popen([PROGRAM, "sweep", "box.cfg", "-o", name, "-j1", *arguments],
                                cwd=self.folder, stdout=subprocess.DEVNULL,
                                stderr=subprocess.PIPE, text=True)

    def wait_for(self, condition):
        for _ in range(20000):
            if condition():
                return
            time.sleep(0.003)
        self.fail("waited in vain")

    def test_a_point_whose_process_is_killed_is_done_again_by_resume(self):
        arguments = ["--vary", "grains.restitution=0.4,0.8", *SLOW]
        whole = self.sweep("whole", *arguments)
        with self.start("shot", *arguments) as child:
            self.wait_for(lambda: os.path.exists(self.path("shot/points/000000/log.csv")))
            os.kill(self.children(child.pid)[0], signal.SIGKILL)
            errors = child.communicate(timeout=200)[1]
        self.assertEqual(child.returncode, 1, errors)
        self.assertIn("signal 9", self.rows("shot", "failed.csv")[0]["cause"])
        self.assertEqual(self.rows("shot"), whole[1:])
        self.call("sweep", "box.cfg", "-o", "shot", *arguments, code=2)     # there already
        self.call("sweep", "box.cfg", "-o", "shot", "--vary", "until=1,2", "--resume", code=2)
        self.assertEqual(self.sweep("shot", *arguments, "--resume"), whole)
        self.assertFalse(os.path.exists(self.path("shot/failed.csv")))

    def test_an_interrupted_study_goes_on_from_the_checkpoints_of_its_points(self):
        arguments = ["--vary", "grains.restitution=0.4,0.8", *SLOW]
        with self.start("torn", *arguments) as child:
            self.wait_for(lambda: os.path.exists(self.path("torn/points/000001/log.csv")))
            child.send_signal(signal.SIGTERM)
            errors = child.communicate(timeout=200)[1]
        self.assertEqual(child.returncode, 143, errors)
        self.assertEqual(len(self.rows("torn")), 1)
        self.assertTrue(glob.glob(self.path("torn/points/000001/checkpoint/*.checkpoint")))
        rows = self.sweep("torn", *arguments, "--resume")
        self.assertEqual(rows, self.sweep("untorn", *arguments))

    # Many at once

    def test_shards_together_make_the_whole_study(self):
        whole = self.sweep("all", *GRID)
        for k in (1, 2, 3):
            rows = self.sweep("parts", *GRID, "--shard", f"{k}/3")
            self.assertEqual(len(rows), 2 * k)
        self.assertEqual(rows, whole)

    def test_gnu_parallel_runs_the_shards(self):
        if not shutil.which("parallel"):
            self.skipTest("GNU parallel is not installed")
        # The line of docs/studies.md.
        with open(os.path.join(os.environ["SOURCE_ROOT"], "docs/studies.md"),
                  encoding="utf-8") as text:
            lines = [line.strip() for line in text if line.strip().startswith("parallel ")]
        self.assertEqual(len(lines), 1)
        line = lines[0].replace("sandreel ", PROGRAM + " ", 1)
        done = subprocess.run(["sh", "-c", line], cwd=self.folder, capture_output=True, text=True,
                              timeout=300, check=False,
                              env=dict(os.environ, PARALLEL="--will-cite"))
        self.assertEqual(done.returncode, 0, done.stderr)
        vary = lines[0].split("--vary ")[1].split()[0]
        whole = self.sweep("sequential", "--vary", vary)
        self.assertEqual(self.rows("study"), whole)

    def test_two_ranks_of_mpi_share_the_points(self):
        if not shutil.which("mpirun"):
            self.skipTest("Open MPI is not installed")
        mpirun = ["mpirun", "--oversubscribe", "-n", "2"]
        done = self.call("sweep", "box.cfg", "-o", "ranks", *GRID, before=mpirun,
                         code=0 if self.has_mpi() else 1, env={
                             "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"})
        if not self.has_mpi():
            self.skipTest("built without MPI, and it says so: " + done.stderr[:80])
        self.assertEqual(self.rows("ranks"), self.sweep("norank", *GRID))
        # Every point was done once, and each of the ranks has counted a first one.
        self.assertEqual(done.stderr.count("done, 0 failed"), 6)
        self.assertEqual(done.stderr.count("1 of 6 done"), 2)

    def has_mpi(self):
        return "\nmpi " in self.call("version").stdout


if __name__ == "__main__":
    verdict.run()
