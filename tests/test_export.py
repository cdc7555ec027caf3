"""test_export.py - what other programs find in the files that sandreel writes for them.

Called with the path of the binary, by a Python with h5py, numpy, VTK and ASE where there is one;
what is missing is skipped, with the reason.  The reference is always the run's own dump, read by
numpy: every format must hold the same numbers, bit for bit where it can.

SPDX-License-Identifier: GPL-3.0-or-later
"""
import glob
import importlib
import json
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

# Discs of two species fall; a source brings more, and the box does not begin at the origin.
DISCS = """
title = "discs that fall";
model = "md";
units = "cgs";
until = 0.6;
box = (-2.0, 1.0, 14.0, 13.0);
left = "periodic"; right = "periodic";
gravity = (0.0, -10.0);
grains = ({ name = "a"; radius = (0.3, 0.4); restitution = 0.5; friction = 0.3; },
          { name = "b"; radius = 0.3; restitution = 0.5; friction = 0.3; density = 2.0; });
placements = ({ grains = "a"; region = (1.0, 3.0, 11.0, 7.0); spacing = 1.1; temperature = 2.0; },
              { grains = "b"; region = (1.0, 7.0, 11.0, 10.0); spacing = 1.2; });
sources = ({ grains = "b"; position = (6.0, 11.0); rate = 20.0; from = 0.2; });
md = { dt = 2e-5; };
output = { frames = 0.1; log = 0.05; dump = true; trajectory = 0.02; checkpoint = 0.2;
           checkpoint_wall = 0.0; };
view = { size = (64, 48); range = (0, 5); };
measure = { fields = ["density", "velocity"]; cell = 2.0; };
"""


def module(name):
    """The module, or None where it is not installed."""
    try:
        return importlib.import_module(name)
    except ImportError:
        return None


numpy = module("numpy")


class Shared(unittest.TestCase):
    """One run with dumps, and what it is exported to."""

    @classmethod
    def setUpClass(cls):
        if numpy is None:
            raise unittest.SkipTest("no python3-numpy")
        memory = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
        cls.folder = tempfile.mkdtemp(prefix="sandreel-export-", dir=memory)
        cls.scene = os.path.join(cls.folder, "discs.cfg")
        with open(cls.scene, "w", encoding="utf-8") as out:
            out.write(DISCS)
        cls.say("run", "discs.cfg", "-o", "kept", "-j1")
        cls.hdf5 = os.path.exists(os.path.join(cls.folder, "kept", "trajectory.h5"))
        cls.say("export", "kept", "-o", "out", "--to", "csv,npy,vtp,vti,lammps,extxyz,h5md")
        # The reference: the dumps in the order of the ids.
        cls.frames = []
        for name in sorted(glob.glob(os.path.join(cls.folder, "kept/dump/??????.npy"))):
            grains = numpy.load(name)
            cls.frames.append(grains[numpy.argsort(grains["id"])])
        cls.times = numpy.genfromtxt(os.path.join(cls.folder, "kept/dump/index.csv"), delimiter=",",
                                     names=True)["time"]

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder, ignore_errors=True)

    @classmethod
    def call(cls, *arguments):
        return subprocess.run([PROGRAM, *arguments], cwd=cls.folder, capture_output=True, text=True,
                              timeout=300, check=False)

    @classmethod
    def say(cls, *arguments):
        done = cls.call(*arguments)
        if done.returncode != 0:
            raise AssertionError(f"{arguments} ended with {done.returncode}: {done.stderr}")
        return done.stdout

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def need(self, name, package):
        found = module(name)
        if found is None:
            self.skipTest(f"{package} is not installed")
        return found

    def same(self, found, expected):
        numpy.testing.assert_array_equal(numpy.asarray(found), expected)



class Export(Shared):
    def test_the_reference_is_worth_comparing_with(self):
        self.assertEqual(len(self.frames), 7)
        self.assertGreater(len(self.frames[-1]), len(self.frames[0]))       # the source has begun
        self.assertEqual(set(self.frames[0]["species"]), {0, 1})
        self.assertGreater(numpy.ptp(self.frames[0]["radius"]), 0.05)
        self.assertGreater(numpy.abs(self.frames[-1]["spin"]).max(), 0)

    def test_numpy_reads_the_tables(self):
        for k, frame in enumerate(self.frames):
            self.same(numpy.load(self.path(f"out/grains_{k:06d}.npy")), frame)
            table = numpy.genfromtxt(self.path(f"out/grains_{k:06d}.csv"), delimiter=",", names=True)
            for name in ("id", "x", "y", "vx", "vy", "spin", "radius", "species"):
                self.same(table[name], frame[name])
            self.same(table["collision_rate"].astype("f4"), frame["collision_rate"])

    def check_h5md(self, h5py, name, times, frames):
        with h5py.File(self.path(name), "r") as file:
            self.same(file["h5md"].attrs["version"], [1, 1])
            self.assertEqual(file["h5md/creator"].attrs["name"].decode(), "sandreel")
            group = file["particles/all"]
            self.same(group["box/edges"], [16, 12])
            self.same(group["box"].attrs["boundary"], [b"periodic", b"none"])
            self.assertEqual(group["velocity/value"].attrs["unit"].decode(), "cm s-1")
            numpy.testing.assert_allclose(group["position/time"], times, atol=1e-4)
            for element in ("position", "velocity", "id"):      # one pair for all, linked
                self.assertEqual(group[element]["time"], group["position/time"])
            for k, frame in frames:
                n = len(frame)
                self.same(group["position/value"][k, :n], numpy.stack([frame["x"], frame["y"]], 1))
                self.same(group["velocity/value"][k, :n],
                          numpy.stack([frame["vx"], frame["vy"]], 1))
                for element, field in (("id", "id"), ("mass", "mass"), ("radius", "radius"),
                                       ("species", "species"), ("angular_velocity", "spin"),
                                       ("angle", "angle"), ("collision_rate", "collision_rate")):
                    self.same(group[element]["value"][k, :n], frame[field])
                self.assertTrue((group["id/value"][k, n:] == 0xffffffff).all())
                self.assertTrue(numpy.isnan(group["position/value"][k, n:]).all())

    def test_h5py_reads_the_h5md_file_and_the_trajectory_written_while_running(self):
        h5py = self.need("h5py", "python3-h5py")
        if not self.hdf5:
            self.skipTest("built without HDF5")
        self.check_h5md(h5py, "out/trajectory.h5", self.times, list(enumerate(self.frames)))
        # Every fifth frame of the trajectory is a frame of the dumps.
        self.check_h5md(h5py, "kept/trajectory.h5", numpy.arange(31) * 0.02,
                        [(5 * k, frame) for k, frame in enumerate(self.frames)])

    def bare(self, run, name):
        """A run that kept nothing but its trajectory."""
        os.makedirs(self.path(name))
        for file in ("scene.cfg", "manifest.json", "trajectory.h5"):
            shutil.copy(self.path(run, file), self.path(name, file))

    def test_pictures_maps_and_movies_come_from_a_trajectory_as_from_dumps(self):
        if not self.hdf5:
            self.skipTest("built without HDF5")
        self.bare("kept", "bare")
        for run in ("kept", "bare"):
            self.say("frame", run, "-t", "0.4", "-o", run + "-p.png", "--color", "spin")
            self.say("map", run, "-t", "0.5", "-o", run + "-maps", "--as", "npy")
            self.say("export", run, "-t", "0.3", "-o", run + "-table", "--to", "csv,npy")
        # The grains come in another order, and sums over them are rounded otherwise.
        self.say("frame", "bare", "-t", "0.4", "-o", "bare-q.png", "--color", "spin", "--against",
                 "kept-p.png", "--tolerance", "1")
        maps = sorted(os.path.basename(name) for name in glob.glob(self.path("kept-maps/*.npy")))
        self.assertGreater(len(maps), 1)
        for name in maps:
            one, other = (numpy.load(self.path(run + "-maps", name)) for run in ("kept", "bare"))
            numpy.testing.assert_allclose(one, other, rtol=1e-9, atol=1e-9)
        tables = [numpy.load(glob.glob(self.path(run + "-table/*.npy"))[0])
                  for run in ("kept", "bare")]
        for field in ("id", "x", "y", "vx", "vy", "angle", "spin", "radius", "mass", "species"):
            self.same(tables[1][field], tables[0][field])
        grain = json.loads(self.say("info", "bare", "--frame", "20", "--grain", "5", "--json"))
        row = self.frames[4][self.frames[4]["id"] == 5][0]
        self.assertAlmostEqual(grain["x"], row["x"], delta=1e-8 * abs(row["x"]))
        if shutil.which("ffmpeg"):
            self.say("movie", "bare", "-o", "bare.gif", "--every", "0.1")
            with open(self.path("bare.gif"), "rb") as film:
                self.assertEqual(film.read(6), b"GIF89a")
        # What it does not know is refused, and so is what is no trajectory.
        done = self.call("frame", "bare", "-o", "never.png", "--forces")
        self.assertEqual(done.returncode, 2)
        self.assertIn("no contacts", done.stderr)
        with open(self.path("kept/trajectory.h5"), "rb") as data:
            whole = data.read()
        for torn in (whole[:len(whole) // 2], whole[:100], b"", b"x" * 5000):
            with open(self.path("bare/trajectory.h5"), "wb") as out:
                out.write(torn)
            done = self.call("frame", "bare", "-o", "never.png")
            self.assertEqual(done.returncode, 1, done.stderr)
            self.assertIn("trajectory.h5", done.stderr)
        self.assertFalse(os.path.exists(self.path("never.png")))

    def same_trajectory(self, h5py, one, other):
        with h5py.File(self.path(one), "r") as a, h5py.File(self.path(other), "r") as b:
            names = []
            a.visititems(lambda name, item: names.append(name))
            self.assertGreater(len(names), 20)
            for name in names:
                if isinstance(a[name], h5py.Dataset):
                    self.same(a[name], b[name])

    def interrupted(self, h5py, sent, name):
        """Stops a run by a signal once its trajectory has ten frames and a checkpoint is there, goes
        on, and compares with the run that was left alone."""
        trajectory = self.path(name, "trajectory.h5")
        with subprocess.Popen([PROGRAM, "run", "discs.cfg", "-o", name, "-j1"], cwd=self.folder,
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as child:
            while child.poll() is None:
                try:
                    with h5py.File(trajectory, "r", swmr=True) as file:     # while it grows
                        frames = file["particles/all/position/step"].shape[0]
                except (OSError, KeyError):
                    frames = 0
                if frames >= 12 and glob.glob(self.path(name, "checkpoint", "*.checkpoint")):
                    child.send_signal(sent)
                    break
                time.sleep(0.005)
        self.assertNotEqual(child.returncode, 0, "it had ended before the signal came")
        with h5py.File(trajectory, "r", swmr=True) as file:
            ids = file["particles/all/id/value"]
            self.same(ids[3, :len(self.frames[0])], self.frames[0]["id"])
        # What is there so far can be drawn, as the whole run's picture of that time.
        self.bare(name, name + "-bare")
        self.say("frame", "kept", "-t", "0.2", "-o", name + "-kept.png", "-s",
                 'view.range_from="frame"')
        self.say("frame", name + "-bare", "-t", "0.2", "-o", name + "-early.png", "-s",
                 'view.range_from="frame"', "--against", name + "-kept.png", "--tolerance", "1")
        self.say("run", name, "--resume")
        self.same_trajectory(h5py, name + "/trajectory.h5", "kept/trajectory.h5")

    def test_a_trajectory_survives_an_interruption_and_a_killed_program(self):
        h5py = self.need("h5py", "python3-h5py")
        if not self.hdf5:
            self.skipTest("built without HDF5")
        os.environ["HDF5_USE_FILE_LOCKING"] = "FALSE"       # of the reader, for killed writers
        self.interrupted(h5py, signal.SIGTERM, "stopped")
        self.interrupted(h5py, signal.SIGKILL, "killed")

    def test_what_never_changes_costs_a_trajectory_next_to_nothing(self):
        h5py = self.need("h5py", "python3-h5py")
        if not self.hdf5:
            self.skipTest("built without HDF5")
        with h5py.File(self.path("kept/trajectory.h5"), "r") as file:
            values = file["particles/all/species/value"]
            # Two runs of equal numbers: some 20 bytes of deflate in place of 428.
            self.assertLess(values.id.get_storage_size(), values.size * values.dtype.itemsize / 4)

    def test_vtk_reads_the_grains_and_the_maps(self):
        vtk = self.need("vtk", "python3-vtk9")
        support = self.need("vtk.util.numpy_support", "python3-vtk9")
        for k, frame in enumerate(self.frames):
            reader = vtk.vtkXMLPolyDataReader()
            reader.SetFileName(self.path(f"out/grains_{k:06d}.vtp"))
            reader.Update()
            data = reader.GetOutput()
            self.assertEqual(data.GetNumberOfVerts(), len(frame))
            points = support.vtk_to_numpy(data.GetPoints().GetData())
            self.same(points, numpy.stack([frame["x"], frame["y"], 0 * frame["x"]], 1))
            arrays = {data.GetPointData().GetArrayName(n):
                      support.vtk_to_numpy(data.GetPointData().GetArray(n))
                      for n in range(data.GetPointData().GetNumberOfArrays())}
            self.same(arrays["velocity"][:, 1], frame["vy"])
            for name in ("radius", "mass", "angle", "spin", "collision_rate", "id", "species"):
                self.same(arrays[name], frame[name])
            reader = vtk.vtkXMLImageDataReader()
            reader.SetFileName(self.path(f"out/density_{k:06d}.vti"))
            reader.Update()
            image = reader.GetOutput()
            density = support.vtk_to_numpy(image.GetCellData().GetArray("density"))
            # Cells of area 4; the smooth kernel shares every grain out over the box.
            self.assertAlmostEqual(4 * density.sum(), len(frame), delta=1e-6 * len(frame))
            self.assertEqual(image.GetOrigin()[:2], (-2, 1))
            when = image.GetFieldData().GetArray("TimeValue").GetValue(0)
            self.assertEqual(when, self.times[k])

    def test_ase_reads_extended_xyz_and_the_lammps_dump(self):
        self.need("ase", "python3-ase")
        read = self.need("ase.io", "python3-ase").read
        for k, atoms in enumerate(read(self.path("out/grains.xyz"), ":")):
            frame = self.frames[k]
            self.same(atoms.positions[:, 0], frame["x"])
            self.same(atoms.positions[:, 1], frame["y"])
            self.same(atoms.arrays["velo"][:, 0], frame["vx"])
            for name, field in (("radius", "radius"), ("mass", "mass"), ("spin", "spin"),
                                ("angle", "angle"), ("id", "id"), ("type", "species")):
                self.same(atoms.arrays[name], frame[field])
            self.same(atoms.cell.lengths()[:2], [16, 12])
            self.same(atoms.pbc, [True, False, False])
            self.assertEqual(atoms.info["Time"], self.times[k])
        self.assertEqual(k, len(self.frames) - 1)
        dumped = read(self.path("out/grains.lammpstrj"), ":", format="lammps-dump-text")
        self.assertEqual(len(dumped), len(self.frames))
        for atoms, frame in zip(dumped, self.frames):
            # ASE moves the box to the origin by way of fractions, so the last bits are lost.
            self.same(atoms.numbers, frame["species"] + 1)
            numpy.testing.assert_allclose(numpy.diff(atoms.positions[:, 0]), numpy.diff(frame["x"]),
                                          atol=1e-12)

    def test_lammps_reads_the_dump(self):
        lammps = shutil.which("lmp") or shutil.which("lammps")
        if not lammps:
            self.skipTest("lammps is not installed")
        with open(self.path("kept/dump/index.csv"), encoding="utf-8") as text:
            steps = [line.split(",")[2] for line in text if line[0].isdigit()]
        with open(self.path("in.read"), "w", encoding="utf-8") as out:
            out.write(f"""
dimension 2
atom_style sphere
boundary p f p
region all block -2 14 1 13 -0.4 0.4
create_box 2 all
read_dump out/grains.lammpstrj {steps[-1]} x y vx vy box yes add keep purge yes replace no
dump back all custom 1 back.txt id type x y vx vy
dump_modify back sort id format float %.17g
run 0 pre no post no
""")
        done = subprocess.run([lammps, "-in", "in.read", "-log", "none"], cwd=self.folder,
                              capture_output=True, text=True, timeout=120, check=False,
                              env=dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1",
                                       OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1"))
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        back = numpy.loadtxt(self.path("back.txt"), skiprows=9)
        frame = self.frames[-1]
        self.assertEqual(len(back), len(frame))
        self.same(back[:, 0], frame["id"] + 1)      # LAMMPS refuses an atom 0
        self.same(back[:, 1], frame["species"] + 1)
        # LAMMPS folds x into its periodic box.
        numpy.testing.assert_allclose((back[:, 2] - frame["x"] + 8) % 16 - 8, 0, atol=1e-12)
        self.same(back[:, 3], frame["y"])
        self.same(back[:, 4], frame["vx"])
        self.same(back[:, 5], frame["vy"])

    def test_an_unknown_format_and_a_lone_frame(self):
        done = self.call("export", "kept", "--to", "csv,hdf")
        self.assertEqual(done.returncode, 2)
        self.assertIn("unknown format 'hdf'", done.stderr)
        self.say("export", "kept", "--to", "extxyz", "--frame", "2", "-o", "lone")
        with open(self.path("lone/grains.xyz"), encoding="utf-8") as text:
            self.assertEqual(sum(1 for line in text), len(self.frames[2]) + 2)


# The species of DISCS, with room for every radius; the grains come from a file.
IMPORTED = """
model = "md";
until = 0.1;
box = (-2.0, 1.0, 14.0, 13.0);
left = "periodic"; right = "periodic";
grains = ({ name = "a"; radius = (0.3, 0.4); restitution = 0.5; friction = 0.3; },
          { name = "b"; radius = 0.3; restitution = 0.5; friction = 0.3; density = 2.0; });
placements = ({ kind = "file"; file = "FILE"; });
md = { dt = 2e-5; };
output = { frames = 0.1; dump = true; };
view = { size = (64, 48); range = (0, 5); };
"""


class Import(Shared):
    """Grains that another program, or an earlier run, has written are where a scene begins."""

    def begin(self, name, changes=()):
        """The grains with which a scene begins that takes them from this file."""
        scene = self.path("scenes", os.path.basename(name) + ".cfg")
        os.makedirs(self.path("scenes"), exist_ok=True)
        shutil.copy(self.path(name), self.path("scenes"))
        text = IMPORTED.replace("FILE", os.path.basename(name))
        for old, new in changes:
            text = text.replace(old, new)
        with open(scene, "w", encoding="utf-8") as out:
            out.write(text)
        run = scene[:-4] + "-run"
        self.say("run", scene, "-o", run, "--until", "1e-5", "--force")
        grains = numpy.load(run + "/dump/000000.npy")
        return grains[numpy.argsort(grains["id"])]

    def check(self, found, frame, exact=True):
        self.assertEqual(len(found), len(frame))
        for name in ("x", "y", "vx", "vy", "spin", "radius", "species"):
            if exact and name != "x":
                self.same(found[name], frame[name])
            else:       # x is folded into the periodic box
                difference = found[name] - frame[name]
                if name == "x":
                    difference = (difference + 8) % 16 - 8
                numpy.testing.assert_allclose(difference, 0, atol=1e-12 if exact else 1e-5)

    def test_dsmc_begins_with_the_discs_of_an_earlier_run(self):
        """As docs/exchange.md has it."""
        gas = ("cooling", "-s", "quick=true", "-s", "phases=()", "-s", "output.frames=0.5", "-s",
               "output.dump=true", "-j1", "--force")
        self.say("run", *gas, "--model", "ed", "--until", "2", "-o", "gas")
        self.say("export", "gas", "--to", "csv", "--frame", "4", "-o", "gas")
        self.say("run", *gas, "--model", "dsmc", "--until", "0.1", "-o", "points",
                 "-s", "placements.[0].kind=file", "-s", "placements.[0].file=gas/grains_000004.csv",
                 "-s", "placements.[0].temperature=0", "-s", "grains.[0].restitution=0.8")
        discs, points = (numpy.load(self.path(name)) for name in ("gas/dump/000004.npy",
                                                                  "points/dump/000000.npy"))
        self.assertEqual(len(points), 2500)
        discs, points = (grains[numpy.argsort(grains["id"])] for grains in (discs, points))
        for name, most in (("x", 89), ("y", 89), ("vx", 8), ("vy", 8)):     # single precision
            numpy.testing.assert_allclose(points[name], discs[name], rtol=0, atol=most * 2.0**-24)

    def test_a_run_goes_on_from_the_csv_or_the_lammps_dump_of_another(self):
        self.say("export", "kept", "--to", "csv,lammps", "-o", "last", "-t", "0.6")
        self.check(self.begin("last/grains_000006.csv"), self.frames[-1])
        self.check(self.begin("last/grains.lammpstrj"), self.frames[-1])
        self.check(self.begin("out/grains.lammpstrj"), self.frames[-1])     # its last snapshot
        # The run stands on its own: without the file, its resolved scene gives the same grains.
        run = self.path("scenes/grains.lammpstrj-run")
        os.remove(self.path("scenes/grains.lammpstrj"))
        self.say("run", run + "/scene.cfg", "-o", "again")
        with open(run + "/dump/000000.npy", "rb") as a, open(self.path("again/dump/000000.npy"),
                                                             "rb") as b:
            self.assertEqual(a.read(), b.read())

    def test_a_data_file_that_lammps_wrote_is_read(self):
        lammps = shutil.which("lmp") or shutil.which("lammps")
        if not lammps:
            self.skipTest("lammps is not installed")
        with open(self.path("in.write"), "w", encoding="utf-8") as out:
            out.write("""
dimension 2
atom_style sphere
boundary p f p
region all block -2 14 1 13 -0.4 0.4
create_box 2 all
lattice sq 1.0
region part block 0 9 3 6 -0.1 0.1
create_atoms 1 region part
create_atoms 2 single 5.0 10.0 0.0 units box
set type 1 diameter 0.7
set type 2 diameter 0.6
velocity all create 1.0 4711 dist gaussian
set type 2 omega 0 0 3.5
write_data written.data
dump now all custom 1 written.dump id type xs ys vx vy omegaz radius
dump_modify now format float %.12g
run 0 pre no post no
""")
        done = subprocess.run([lammps, "-in", "in.write", "-log", "none"], cwd=self.folder,
                              capture_output=True, text=True, timeout=120, check=False,
                              env=dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1",
                                       OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1"))
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        data = self.begin("written.data")
        self.assertEqual(len(data), 41)
        last = data[-1]
        self.assertEqual((last["x"], last["y"], last["radius"], last["species"]), (5, 10, 0.3, 1))
        self.assertAlmostEqual(last["spin"], 3.5)       # LAMMPS keeps the angular momentum
        self.same(data["radius"][:40], numpy.full(40, 0.35))
        self.assertGreater(numpy.abs(data["vx"]).max(), 0)
        self.check(self.begin("written.dump"), data, exact=False)

    def test_what_a_file_may_leave_out_the_scene_says(self):
        with open(self.path("few.csv"), "w", encoding="utf-8") as out:
            out.write("y, x\n2.0, 0.0\n# a comment\n3.0, 4.5\n")
        found = self.begin("few.csv", [('"few.csv"', '"few.csv"; velocity = (1.0, 2.0); grains = "b"')])
        self.same(found["x"], [0, 4.5])
        self.same(found["vy"], [2, 2])
        self.same(found["radius"], [0.3, 0.3])
        self.same(found["species"], [1, 1])

    def test_a_file_that_does_not_fit_its_scene_says_why(self):
        cases = {"x,y,radius\n1,2,0.9\n": "radius 0.9",
                 "x,y\n1,99\n": "outside",
                 "x,y,species\n1,2,7\n": "species 7",
                 "x,y\n1,2\n1.1,2\n": "overlaps another",
                 "x,y\n1,1.01\n": "in a wall",
                 "x,y\n1\n": "too few numbers",
                 "x,y\n1,zwei\n": ":2: a number is malformed",
                 "a,b\n1,2\n": "no columns called x and y",
                 "": "no grain is in it"}
        scene = self.path("bad.cfg")
        with open(scene, "w", encoding="utf-8") as out:
            out.write(IMPORTED.replace("FILE", "bad.csv"))
        for text, words in cases.items():
            with open(self.path("bad.csv"), "w", encoding="utf-8") as out:
                out.write(text)
            done = self.call("run", scene, "-o", "never")
            self.assertEqual(done.returncode, 3, text)
            self.assertIn(words, done.stderr)
            self.assertIn("bad.csv", done.stderr)
        os.remove(self.path("bad.csv"))
        self.assertIn("cannot open", self.call("run", scene, "-o", "never").stderr)


if __name__ == "__main__":
    verdict.run()
