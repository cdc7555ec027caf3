"""test_stress.py - a hard case that does not hold is told, with the grain, the place and the time.

SPDX-License-Identifier: GPL-3.0-or-later

The cases that hold are run by `sandreel stress` itself; these plant what must be found.
"""
import json
import os
import subprocess
import sys
import tempfile
import unittest

PROGRAM = os.path.abspath(sys.argv.pop(1))

# Two soft discs fly at each other; what must hold is added by each test.
SCENE = """
model = "md"; until = 4; box = [0, 0, 20, 4]; %s
grains = ({ radius = 0.5; density = 1; restitution = 1; stiffness = 1e3; });
placements = ({ kind = "square"; region = [4, 1, 5, 2]; velocity = (2, 0); },
              { kind = "square"; region = [9, 1, 10, 2]; velocity = (-2, 0); });
hard = { models = %s; %s };
"""


class Stress(unittest.TestCase):
    def run_case(self, holds, more="", models='["md"]'):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "case.cfg")
            with open(path, "w", encoding="utf-8") as out:
                out.write(SCENE % (more, models, holds))
            done = subprocess.run([PROGRAM, "stress", path, "--json"], capture_output=True,
                                  text=True, check=False, timeout=120)
        return done.returncode, json.loads(done.stdout)["runs"] if done.stdout else done.stderr

    def fails(self, check, *words, **how):
        code, runs = self.run_case(**how)
        self.assertEqual(code, 4)
        self.assertFalse(runs[0]["passed"])
        self.assertEqual(runs[0]["tightest"], check)
        for word in words:
            self.assertIn(word, runs[0]["why"])

    def test_what_holds_passes(self):
        code, runs = self.run_case("overlap = 0.5; momentum = 4; collisions = 1;"
                                   "energy_changes = 0.01; grains = 2;")
        self.assertEqual(code, 0)
        self.assertTrue(runs[0]["passed"])

    def test_an_overlap_names_both_grains_the_place_and_the_time(self):
        # Two grains of 0.785 meet at a speed of 4 on a spring of 1000: xi = 4 sqrt(0.39 / 1000).
        self.fails("overlap", "grain 1 at (", "and grain 0", "t = ",
                   holds="overlap = 1e-3; looks = 400;")

    def test_energy_that_comes_from_a_moving_wall_is_told(self):
        self.fails("rises", "is the fastest", holds="energy_rises = 1e-3;",
                   more='walls = ({ shape = "segment"; points = ((12, 0), (12, 4));'
                        ' velocity = (-3, 0); moves = (0, 1); });')

    def test_a_collision_that_does_not_happen_is_missed(self):
        self.fails("collides", "at least 2", holds="collisions = 2;")

    def test_a_grain_that_leaves_the_rectangle_is_named(self):
        self.fails("inside", "grain ", holds="within = [0, 0, 9.6, 4];")

    def test_a_run_that_should_stop_but_does_not_fails(self):
        self.fails("ends", "must be stopped", holds='ends = "stopped"; because = "overlaps";')

    def test_a_second_run_that_ends_elsewhere_fails(self):
        self.fails("positions", "second self", holds='agrees_with = ["gravity=(0, -0.01)"];'
                   "positions = 1e-3;")

    def test_a_scene_without_a_case_is_wrong_use(self):
        code, said = self.run_case("", models="[]")
        self.assertEqual(code, 2)
        self.assertIn("not a hard case", said)


unittest.main()
