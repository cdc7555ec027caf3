"""test_valgrind.py - one run of every model and method, and its going on from a checkpoint, under
valgrind: nothing is read that was not written, nothing is read or written outside of its block,
and nothing is lost.

    test_valgrind.py PROGRAM

Valgrind shows the program a processor without AVX-512, so of loops compiled more than once those
for AVX2 run; the sanitizer build tries the others where the processor has them.

SPDX-License-Identifier: GPL-3.0-or-later
"""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

import rundir

PROGRAM = os.path.abspath(sys.argv.pop(1))
SUPPRESSIONS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "valgrind.supp")
VALGRIND = ["valgrind", "--error-exitcode=99", "--leak-check=full", "--child-silent-after-fork=yes",
            "--errors-for-leak-kinds=definite,possible", "--suppressions=" + SUPPRESSIONS]
SKIPPED = 77

# All that is measured and kept, but no pictures: drawing is tried once, and is mostly Mesa's work.
BLIND = ["-s", "output.frames=0", "-s", "output.maps=0"]
DUMPED = ["-s", "output.dump=true", "-s", "output.contacts=true"]
SMALL = ["--until", "0.25", "-s", "output.checkpoint=0.1"]
GAS = ["--quick", "-s", "phases=()", *BLIND, "--until", "0.6", "-s", "output.checkpoint=0.2"]

CASES = [
    ("md-linear-verlet-drawn", rundir.DISCS_FILE, [*DUMPED, "--until", "0.1", "-s",
                                                   "output.checkpoint=0.04", "-s",
                                                   "view.size=(80, 60)"]),
    ("md-hertz-gear", rundir.DISCS_FILE, [*SMALL, *BLIND, *DUMPED, "-s", "md.force=hertz", "-s",
                                          "md.integrator=gear"]),
    ("ed-tc", rundir.DISCS_FILE, [*SMALL, *BLIND, *DUMPED, "--model", "ed"]),
    ("ed-plain", "cooling", [*GAS, "--model", "ed", "-s", "ed.t_c=0"]),
    ("dsmc-plain", "cooling", [*GAS, "--model", "dsmc", "--method", "plain"]),
    ("dsmc-dense", "obstacle", ["--quick", *BLIND, "--model", "dsmc", "--until", "0.002", "-s",
                                "output.checkpoint=0.001"]),
    ("dsmc-hsmc", "heap", ["--quick", *BLIND, "--model", "dsmc", "--method", "hsmc", "--until",
                           "0.3", "-s", "output.checkpoint=0.1"]),
    ("lga-gmlg", "hourglass", ["--quick", *BLIND, "--model", "lga", "--until", "0.02", "-s",
                               "output.checkpoint=0.01"]),
    ("lga-fhp2", "cooling", [*GAS, "--model", "lga", "--method", "fhp2"]),
    ("lga-sandpile", "pile", ["--quick", *BLIND, *DUMPED, "--model", "lga", "--method", "sandpile",
                              "--until", "200", "-s", "output.checkpoint=60"]),
]


class Valgrind(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="sandreel-valgrind-")
        rundir.write_scenes(cls.folder)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def call(self, program, *words):
        # Set, so that the program need not start itself anew, out of valgrind's sight (main.c).
        done = subprocess.run([*VALGRIND, program, *words], cwd=self.folder, text=True,
                              capture_output=True, env={**os.environ, "OMP_WAIT_POLICY": "passive"},
                              timeout=3000, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("ERROR SUMMARY: 0 errors", done.stderr)

    def test_what_is_wrong_is_found(self):
        # A tool that finds nothing proves nothing: python itself with a wild read.
        wild = "import ctypes; ctypes.string_at(ctypes.create_string_buffer(8), 1 << 16)"
        done = subprocess.run([*VALGRIND, sys.executable, "-S", "-c", wild], capture_output=True,
                              env={**os.environ, "PYTHONMALLOC": "malloc"}, timeout=600,
                              check=False)
        self.assertEqual(done.returncode, 99, done.stderr)


def of_case(name, scene, options):
    def test(self):
        words = ["run", scene, "-o", name, "-j2", "--progress", "none", *options]
        self.call(PROGRAM, *words)
        kept = os.listdir(os.path.join(self.folder, name, "checkpoint"))
        self.assertEqual(len([file for file in kept if file.endswith(".checkpoint")]), 2, kept)
        os.unlink(os.path.join(self.folder, name, "checkpoint", sorted(kept)[-1]))
        self.call(PROGRAM, *words, "--resume")
    return test


for case in CASES:
    setattr(Valgrind, "test_" + case[0].replace("-", "_"), of_case(*case))

if __name__ == "__main__":
    if not shutil.which("valgrind"):
        print("valgrind is not installed (apt install valgrind): skipped")
        sys.exit(SKIPPED)
    program = unittest.main(exit=False, verbosity=2)
    sys.exit(0 if program.result.wasSuccessful() else 1)
