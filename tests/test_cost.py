"""test_cost.py - `cost` measures errors that are known, and `run` chooses by what it wrote.

SPDX-License-Identifier: GPL-3.0-or-later
"""
import csv
import json
import os
import subprocess
import sys
import tempfile
import unittest

PROGRAM = os.path.abspath(sys.argv.pop(1))

# An elastic gas: the energy is the same for every model at all times, but for soft discs, which
# keep some of it in overlaps.
SCENE = """
model = "ed"; until = 4; box = [0, 0, 24, 24];
left = "periodic"; right = "periodic"; bottom = "periodic"; top = "periodic";
grains = ({ radius = 0.5; density = 1.2732; restitution = %s; stiffness = 1e4; });
placements = ({ kind = "square"; spacing = 2.4; temperature = 1; });
measure = { cost = %s; };
overlap_limit = 1.0;
"""


class Cost(unittest.TestCase):
    def setUp(self):
        self.home = tempfile.TemporaryDirectory()
        self.folder = self.home.name
        self.cache = os.path.join(self.folder, "cache")

    def tearDown(self):
        self.home.cleanup()

    def call(self, *arguments):
        return subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True,
                              text=True, check=False, timeout=300,
                              env={**os.environ, "XDG_CACHE_HOME": self.cache})

    def write(self, restitution="1", observables='["energy"]'):
        with open(os.path.join(self.folder, "gas.cfg"), "w", encoding="utf-8") as out:
            out.write(SCENE % (restitution, observables))

    def measure(self, *more):
        done = self.call("cost", "gas.cfg", "--seeds", "2", "--json", *more)
        self.assertEqual(done.returncode, 0, done.stderr)
        return {point["setting"]: point for point in json.loads(done.stdout)["points"]}

    def test_an_elastic_gas_keeps_its_energy_in_every_model_of_free_grains(self):
        self.write()
        points = self.measure()
        # Hard discs lose nothing; single precision of DSMC some 1e-7 a collision.
        self.assertLess(points["ed ed.t_c=*100"]["error"], 1e-9)
        self.assertLess(points["dsmc"]["error"], 1e-4)
        # In the mean soft discs spend a share of the time in contact, and have the energy there.
        self.assertLess(points["md"]["error"], 0.05)
        # The reference has no error, and something is on the front.
        reference = points["ed ed.t_c=*0.1"]
        self.assertEqual(reference["error"], 0)
        self.assertTrue(reference["reference"])
        self.assertTrue(any(point["front"] for point in points.values()))
        with open(os.path.join(self.folder, "gas-cost", "cost.csv"), encoding="utf-8") as table:
            rows = list(csv.DictReader(table))
        self.assertEqual(len(rows), len(points))

    def test_a_lossy_gas_without_losses_by_the_cut_off_time_is_far_off(self):
        # With t_c longer than the time between collisions all but the first are elastic.
        self.write("0.6")
        points = self.measure("-s", "ed.t_c=1e-3")
        self.assertGreater(points["ed ed.t_c=*1000"]["error"], 0.2)
        self.assertLess(points["ed ed.t_c=*10"]["error"], points["ed ed.t_c=*1000"]["error"])

    def test_run_takes_the_fastest_setting_that_is_near_enough(self):
        self.write()
        points = self.measure()
        done = self.call("run", "gas.cfg", "--accuracy", "1%", "-o", "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        near = {name: point for name, point in points.items()
                if max(point["error"], point["error_noise"]) <= 0.01}
        fastest = min(near, key=lambda name: near[name]["wall_seconds"])
        self.assertIn(f"cost.json: {fastest},", done.stderr)
        with open(os.path.join(self.folder, "out", "manifest.json"), encoding="utf-8") as text:
            manifest = json.load(text)
        self.assertEqual(manifest["model"], fastest.split()[0])
        self.assertIn("friction", manifest["effects_left_out"])
        parts = manifest["seconds"]
        for part in "core", "measure", "draw", "encode", "files", "total":
            self.assertGreaterEqual(parts[part]["per_simulated_time"], 0)
            self.assertGreaterEqual(parts[part]["per_step"], 0)
        self.assertGreater(parts["core"]["per_step"], 0)
        self.assertAlmostEqual(parts["core"]["per_simulated_time"] * 4, parts["core"]["wall"], 3)

    def test_run_tells_what_comes_nearest_when_nothing_is_near_or_fast_enough(self):
        self.write("0.6")
        same = ("-s", 'measure.settings=["ed ed.t_c=*1000"]', "-s", "ed.t_c=1e-3")
        points = self.measure(*same)
        told = {name: max(point["error"], point["error_noise"]) for name, point in points.items()}
        done = self.call("run", "gas.cfg", "--accuracy", "1e-9%", "-o", "no", *same)
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn(f"the nearest is '{min(told, key=told.get)}',", done.stderr)
        fastest = min(points, key=lambda name: points[name]["wall_seconds"])
        done = self.call("run", "gas.cfg", "--budget", "1e-9s", "-o", "no", *same)
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn(f"the fastest is '{fastest}',", done.stderr)
        self.assertFalse(os.path.exists(os.path.join(self.folder, "no")))

    def test_a_table_without_a_setting_that_runs_is_told_and_drawn_all_the_same(self):
        self.write("0.6")
        self.measure("-s", 'measure.settings=["ed ed.t_c=no"]')
        self.assertTrue(os.path.exists(os.path.join(self.folder, "gas-cost", "picture.png")))

    def test_a_reference_is_kept_and_a_spoilt_one_is_not_believed(self):
        self.write("0.6")
        few = ("-s", 'measure.settings=["ed ed.t_c=*1000"]', "-s", "ed.t_c=1e-3")
        first, again = self.measure(*few), self.measure(*few)
        self.assertFalse(first["ed ed.t_c=*0.1"]["cached"])
        self.assertTrue(again["ed ed.t_c=*0.1"]["cached"])
        self.assertEqual([point["error"] for point in first.values()],
                         [point["error"] for point in again.values()])
        kept = os.path.join(self.cache, "sandreel")
        runs = [name for name in os.listdir(kept) if name.startswith("run-")]
        self.assertEqual(len(runs), 2)                          # one a seed
        with open(os.path.join(kept, runs[0]), "r+b") as file:
            file.seek(100)
            byte = file.read(1)[0]
            file.seek(100)
            file.write(bytes([byte ^ 1]))
        spoilt = self.measure(*few)
        self.assertFalse(spoilt["ed ed.t_c=*0.1"]["cached"])
        self.assertEqual(spoilt["ed ed.t_c=*1000"]["error"], first["ed ed.t_c=*1000"]["error"])
        # Another scene has another reference.
        self.write("0.7")
        self.assertFalse(self.measure(*few)["ed ed.t_c=*0.1"]["cached"])

    def test_the_kink_of_a_contact_has_the_second_order_and_a_jump_the_first(self):
        # Verlet is of second order where the force is smooth; where it sets in with a kink, nobody
        # gains by a higher order, and where it jumps (losses) all have the first.  Fits over a
        # factor of 32 in the step scatter by a sixth.
        kink = os.path.join(os.environ["SOURCE_ROOT"], "docs", "examples", "kink.cfg")
        for restitution, order in ("1", 2), ("0.8", 1):
            done = self.call("cost", kink, "--seeds", "8", "--json", "-o", "kink" + restitution,
                             "-s", f"grains.[0].restitution={restitution}")
            self.assertEqual(done.returncode, 0, done.stderr)
            orders = {entry["setting"]: entry for entry in json.loads(done.stdout)["orders"]}
            for setting in "md, verlet", "md, gear":
                self.assertGreaterEqual(orders[setting]["points"], 4)
                self.assertAlmostEqual(orders[setting]["power"], order, delta=0.5)

    def test_run_finds_a_table_from_another_folder_but_not_that_of_another_scene(self):
        self.write()
        self.measure("-s", 'measure.settings=["ed"]')
        os.rename(os.path.join(self.folder, "gas-cost"), os.path.join(self.folder, "away"))
        done = self.call("run", "gas.cfg", "--budget", "60s", "-o", "one")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(os.path.join("cache", "sandreel"), done.stderr)
        os.rename(os.path.join(self.folder, "away"), os.path.join(self.folder, "gas-cost"))
        done = self.call("run", "gas.cfg", "--budget", "60s", "-o", "two", "-s", "until=3")
        self.assertEqual(done.returncode, 2)
        self.assertIn("another form of the scene", done.stderr)

    def test_run_asks_for_a_measurement_that_is_not_there(self):
        self.write()
        done = self.call("run", "gas.cfg", "--budget", "60s")
        self.assertEqual(done.returncode, 2)
        self.assertIn("sandreel cost gas.cfg", done.stderr)

    def test_an_observable_that_does_not_exist_is_an_error_of_the_scene(self):
        self.write(observables='["enegry"]')
        done = self.call("cost", "gas.cfg")
        self.assertEqual(done.returncode, 3)
        self.assertIn("enegry", done.stderr)


unittest.main()
