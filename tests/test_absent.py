"""test_absent.py - an effect that is off leaves no trace: the result is bit for bit that of a build
in which the effect does not exist, and no instruction of it runs.

SPDX-License-Identifier: GPL-3.0-or-later

Arguments: the two programs of absent.c, usual and without effects.  The instructions are counted by
valgrind's callgrind; where it is not installed that test says that it is skipped.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

USUAL, WITHOUT = (os.path.abspath(path) for path in sys.argv[1:3])
del sys.argv[1:3]

VALGRIND = shutil.which("valgrind")

# In a step or an event of the usual build stand a few questions whether a pass is called for; none
# stands in a loop over pairs or grains, of which there are hundreds a step here.  The compiler also
# lays out the same lines in another order.
ASKED = 0.01


def run(program, *which):
    done = subprocess.run([program, *which], capture_output=True, text=True, check=False,
                          timeout=120)
    assert done.returncode == 0, done.stderr
    return done.stdout


def instructions(program, which):
    """Executed within the advance of this model."""
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(
            [VALGRIND, "--tool=callgrind", "--toggle-collect=absent_advance",
             f"--callgrind-out-file={folder}/out", program, which],
            capture_output=True, text=True, check=False, timeout=280)
    found = re.search(r"Collected : (\d+)", done.stderr)
    assert done.returncode == 0 and found, done.stderr
    return int(found.group(1))


class Absent(unittest.TestCase):
    def test_what_is_off_changes_no_bit(self):
        usual, without = run(USUAL), run(WITHOUT)
        self.assertEqual(usual, without)
        lines = usual.splitlines()
        self.assertGreaterEqual(len(lines), 6)
        self.assertGreater(sum(int(line.split()[3]) for line in lines), 500)

    def test_the_other_build_really_lacks_the_effects(self):
        self.assertIn("md friction", run(USUAL, "md friction"))
        done = subprocess.run([WITHOUT, "md friction"], capture_output=True, text=True,
                              check=False, timeout=120)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("models that can run this scene: none", done.stderr)

    def test_what_is_off_runs_no_instruction(self):
        if not VALGRIND:
            self.skipTest("valgrind is not installed")
        for which in [" ".join(line.split()[:2]) for line in run(USUAL).splitlines()]:
            usual, without = instructions(USUAL, which), instructions(WITHOUT, which)
            print(f"{which}: {usual} instructions, {without} where no effect exists", flush=True)
            self.assertGreater(usual, 1e5)
            self.assertLess(abs(usual / without - 1), ASKED, which)

    def test_what_is_on_does_run(self):
        if not VALGRIND:
            self.skipTest("valgrind is not installed")
        self.assertGreater(instructions(USUAL, "md friction"),
                           1.05 * instructions(USUAL, "md verlet"))


unittest.main()
