"""test_faults.py - what goes wrong in the world is told in a sentence, or does not matter.

    test_faults.py PROGRAM FAULTY SHIM STRIDE

Every STRIDE'th system call that needs space fails as on a full disk, every STRIDE'th allocation of
the program fails (1: each in turn); the rest of the table in docs/faults.md once.

SPDX-License-Identifier: GPL-3.0-or-later
"""
import glob
import os
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest

import rundir

PROGRAM, FAULTY, SHIM = (os.path.abspath(path) for path in sys.argv[1:4])
STRIDE = int(sys.argv[4])
del sys.argv[1:5]
SKIPPED = 77
QUIET = ["-j1", "--progress", "none"]
SHORT = ["--until", "0.2", "-s", "phases=()", "-s", "output.checkpoint=0.1", "-s", "output.maps=0.2"]
CRASHES = range(128, 200)       # a shell's way to tell of a signal


class Faults(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        memory = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
        cls.folder = tempfile.mkdtemp(prefix="sandreel-faults-", dir=memory)
        rundir.write_scenes(cls.folder)
        done = cls.call("run", rundir.DISCS_FILE, "-o", "kept", *QUIET, *SHORT, "-s",
                        "output.dump=true")
        if done.returncode != 0:
            raise AssertionError(done.stderr)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    @classmethod
    def call(cls, *words, before=(), timeout=120, cwd=None, **settings):
        environment = {"OMP_WAIT_POLICY": "passive", **os.environ, **settings}
        return subprocess.run([*before, PROGRAM, *words], cwd=cwd or cls.folder, env=environment,
                              capture_output=True, text=True, errors="replace", timeout=timeout,
                              check=False)

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def clean(self, *names):
        for name in names:
            shutil.rmtree(self.path(name), ignore_errors=True)
            if os.path.exists(self.path(name)):
                os.unlink(self.path(name))

    def assert_told(self, done, code, *words):
        """It ended with this code and said these words, in one sentence at the end."""
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertTrue(done.stderr.rstrip().splitlines()[-1].startswith("sandreel: "), done.stderr)
        for word in words:
            self.assertIn(word, done.stderr)

    def assert_nothing_half_written(self, where):
        for name in glob.glob(self.path(where, "**", "*"), recursive=True):
            self.assertFalse(name.endswith(".partial"), name)
            with open(name, "rb") if os.path.isfile(name) else open(os.devnull, "rb") as file:
                data = file.read()
            if name.endswith(".png"):
                self.assertEqual(data[-8:-4], b"IEND", name)
            if name.endswith((".csv", ".json", ".cfg")) and data:
                self.assertEqual(data[-1:], b"\n", name)

    # Disks

    def full_disk_at_every_call(self, name, words, goes_on):
        call, ended = 1, 1
        while ended != 0:
            self.clean(name)
            done = self.call(*words, before=[FAULTY, "count", str(call), "full"])
            ended = done.returncode
            if ended == SKIPPED:
                self.skipTest("the kernel lets nobody play a full disk")
            if ended != 0:
                self.assert_told(done, 1)
                self.assertRegex(done.stderr, "No space left on device|is the disk full")
                self.assert_nothing_half_written(name)
                self.assertEqual(glob.glob(self.path(name + "*.partial")), [])
            if ended != 0 and goes_on and os.path.exists(self.path(name)):
                again = self.call(*words, "--resume")
                self.assertEqual(again.returncode, 0, f"call {call}: {again.stderr}")
                self.assertEqual(rundir.differences(self.path("kept"), self.path(name)), [], call)
            call += STRIDE
        self.clean(name)

    def test_a_run_whose_disk_is_full_says_so_and_goes_on_when_there_is_room(self):
        self.full_disk_at_every_call("full", ["run", rundir.DISCS_FILE, "-o", "full", *QUIET, *SHORT,
                                              "-s", "output.dump=true"], True)

    def test_a_picture_or_map_or_table_on_a_full_disk_is_whole_or_not_there(self):
        self.full_disk_at_every_call("x.png", ["frame", "kept", "-o", "x.png", *QUIET], False)
        self.full_disk_at_every_call("maps", ["map", "kept", "-o", "maps", *QUIET], False)
        self.full_disk_at_every_call("csv", ["export", "kept", "-o", "csv"], False)

    def test_a_directory_that_vanishes_ends_the_run_and_does_not_come_back(self):
        with subprocess.Popen([PROGRAM, "run", rundir.DISCS_FILE, "-o", "gone", *QUIET, "-s",
                               "md.dt=1e-5"], cwd=self.folder, stdout=subprocess.DEVNULL,
                              stderr=subprocess.PIPE, text=True) as child:
            while child.poll() is None and not os.path.exists(self.path("gone", "frames")):
                time.sleep(0.002)
            os.rename(self.path("gone"), self.path("elsewhere"))        # all of it at once
            told = child.communicate(timeout=120)[1]
        self.assertEqual(child.returncode, 1, told)
        self.assertIn("No such file or directory", told)
        self.assertFalse(os.path.exists(self.path("gone")))

    def test_what_is_there_already_is_kept_unless_force_is_given(self):
        self.call("frame", "kept", "-o", "mine.png", *QUIET)
        for words in (["frame", "kept", "-o", "mine.png"], ["movie", "kept", "-o", "mine.gif"],
                      ["map", "kept", "-o", "mymaps"], ["export", "kept", "-o", "mycsv"],
                      ["plot", "kept", "--of", "energy", "-o", "myplots"],
                      ["figure", "cooperative-11", "--quick", "-o", "myfigures"]):
            first = self.call(*words)
            if words[0] == "movie" and not shutil.which("ffmpeg"):
                continue
            self.assertIn(first.returncode, (0, 2), first.stderr)
            self.assert_told(self.call(*words), 2, "--force", words[-1])
            self.assertEqual(self.call(*words, "--force").returncode, 0)

    def test_a_table_that_no_study_left_is_not_overwritten_by_one(self):
        os.mkdir(self.path("mine"))
        with open(self.path("mine", "results.csv"), "w", encoding="ascii") as out:
            out.write("precious\n")
        study = ["sweep", rundir.DISCS_FILE, "--vary", "grains.restitution=0.5,0.6", "--until",
                 "0.01", "-o", "mine"]
        self.assert_told(self.call(*study), 2, "--force", "results.csv")
        with open(self.path("mine", "results.csv"), encoding="ascii") as file:
            self.assertEqual(file.read(), "precious\n")
        self.assertEqual(self.call(*study, "--force").returncode, 0)

    # Memory

    def bytes_of(self, name):
        """All that a command left under this name, but for wall times."""
        if os.path.isdir(self.path(name)):
            return rundir.everything(self.path(name))
        with open(self.path(name), "rb") as file:
            return file.read()

    def every_allocation(self, name, words, quiet=tuple(QUIET), stride=STRIDE):
        count, whole = self.path("count"), "straight-" + name
        settings = {"LD_PRELOAD": SHIM, "SHIM_COUNT": count}
        self.clean(whole, name)
        straight = self.call(*words, "-o", whole, *quiet, **settings)
        self.assertEqual(straight.returncode, 0, straight.stderr)
        with open(count, encoding="ascii") as file:
            total = int(file.read())
        self.assertGreater(total, 20)
        for number in range(1, total + 1, stride):
            self.clean(name)
            done = self.call(*words, "-o", name, *quiet, SHIM_ALLOCATION=str(number), **settings)
            where = f"allocation {number} of {total}: {done.returncode} {done.stderr}"
            with self.subTest(words=words, number=number):
                self.assertIn(done.returncode, (0, 1, 3), where)
                if done.returncode != 0:
                    self.assertIn("memory", done.stdout + done.stderr, where)
                    self.assertNotIn("(null)", done.stdout + done.stderr, where)
                    self.assert_nothing_half_written(name)
                else:
                    self.assertEqual(self.bytes_of(whole), self.bytes_of(name), where)
        self.clean(whole, name)

    def test_every_allocation_of_a_run_may_fail(self):
        for model in ("md", "ed"):
            self.every_allocation("poor", ["run", rundir.DISCS_FILE, "--model", model, *SHORT, "-s",
                                           "output.dump=true", "-s", "output.contacts=true"])
        self.every_allocation("poor", ["run", "obstacle", "--quick", "--model", "dsmc", "--until",
                                       "0.003", "--size", "160x120", "-s", "output.maps=0.001"])
        self.every_allocation("poor", ["run", "pile", "--quick", "--model", "lga", "--until", "1000",
                                       "--size", "160x120", "-s", "output.checkpoint=400"])

    def test_every_allocation_of_the_other_commands_may_fail(self):
        self.every_allocation("poor.png", ["frame", "kept", "--forces", "--arrows", "--map",
                                           "density"])
        self.every_allocation("poor-maps", ["map", "kept", "--as", "png,npy,vti,csv"])
        for kind in ("csv", "vti", "lammps", "extxyz"):
            self.every_allocation("poor-" + kind, ["export", "kept", "--to", kind], [])

    SESSION = """pause
step 3
set gravity (2, -9)
go until 0.02
push 8 6 1 2 2
map density
color spin
follow 1
inspect 1
frame shot
checkpoint kept
movie film.gif start
pour 2
tilt 10
go until 0.04
movie film.gif stop
expect grains > 10
back 0.02
"""

    def test_every_allocation_of_films_sessions_studies_and_figures_may_fail(self):
        with open(self.path("session.txt"), "w", encoding="ascii") as out:
            out.write(self.SESSION if shutil.which("ffmpeg") else self.SESSION.replace("movie", "#"))
        if shutil.which("ffmpeg"):
            self.every_allocation("poor.gif", ["movie", "kept"])
            self.every_allocation("poor.gif", ["movie", rundir.DISCS_FILE, "--until", "0.1",
                                               "--model", "md,ed", "--side-by-side"])
        self.every_allocation("poor-live", ["live", rundir.DISCS_FILE, "--commands", "session.txt",
                                            "-s", "output.frames=0.01", "-s", "output.log=0.01"],
                              stride=STRIDE if STRIDE == 1 else 6 * STRIDE)
        self.every_allocation("poor-study", ["sweep", rundir.DISCS_FILE, "--vary",
                                             "grains.restitution=0.5,0.6", "--until", "0.1"])
        self.every_allocation("poor-figure", ["figure", "cooperative-3", "--quick"])
        self.every_allocation("poor-figure", ["figure", "cooperative-11", "--quick"])
        self.every_allocation("poor-plot.png", ["plot", "kept", "--of", "energy"])

    # Programs, libraries, fonts

    def test_what_is_not_installed_is_named_with_its_package(self):
        nowhere = {"PATH": "/nonexistent"}
        self.assert_told(self.call("movie", "kept", "-o", "no.mp4", **nowhere), 1, "apt install ffmpeg")
        self.assert_told(self.call("frame", "kept", "-o", "no.png", LD_PRELOAD=SHIM,
                                   SHIM_NO_LIBRARY="lib"), 1, "libosmesa6", "libegl1")
        self.assert_told(self.call("frame", "kept", "-o", "no.png", SANDREEL_FONT="/nowhere.ttf"), 1,
                         "/nowhere.ttf", "SANDREEL_FONT")
        os.mkfifo(self.path("pipe.ttf"))
        self.assert_told(self.call("frame", "kept", "-o", "no.png",
                                   SANDREEL_FONT=self.path("pipe.ttf")), 1, "pipe.ttf")
        self.assert_told(self.call("frame", "kept", "-o", "no.png", SANDREEL_GL="vulkan"), 2,
                         "osmesa or egl")
        self.assertEqual(glob.glob(self.path("no.*")), [])

    def test_without_drawing_a_run_needs_neither_gl_nor_fonts(self):
        done = self.call("run", rundir.DISCS_FILE, "-o", "bare", *SHORT, "-s", "output.frames=0", "-s",
                         "output.maps=0", LD_PRELOAD=SHIM, SHIM_NO_LIBRARY="lib")
        self.assertEqual(done.returncode, 0, done.stderr)

    def fake_ffmpeg(self, script):
        folder = self.path("programs")
        os.makedirs(folder, exist_ok=True)
        with open(os.path.join(folder, "ffmpeg"), "w", encoding="ascii") as out:
            out.write("#!/bin/sh\n" + script)
        os.chmod(os.path.join(folder, "ffmpeg"), 0o755)
        return {"PATH": folder + ":" + os.environ["PATH"]}

    def test_an_ffmpeg_that_ends_early_is_told_with_what_it_said(self):
        for script in ("echo no such codec >&2; exit 1\n", "head -c 100 > /dev/null\n"):
            done = self.call("movie", "kept", "-o", "b.mp4", **self.fake_ffmpeg(script))
            self.assert_told(done, 1, "ffmpeg could not write")
        self.assertIn("no such codec", self.call("movie", "kept", "-o", "b.mp4", **self.fake_ffmpeg(
            "echo no such codec >&2; exit 1\n")).stderr)
        self.assertEqual(glob.glob(self.path("b.mp4*")), [])

    def test_a_slow_reader_only_takes_longer(self):
        slow = "for a; do last=${a#file:}; done\nsleep 0.3\ncat > \"$last\"\nsleep 0.3\n"
        done = self.call("movie", "kept", "-o", "s.mp4", **self.fake_ffmpeg(slow))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(os.path.getsize(self.path("s.mp4")), 3 * 4 * 160 * 120)

    def test_an_ffmpeg_that_hangs_does_not_outlive_an_interruption(self):
        path = self.fake_ffmpeg("trap '' TERM INT\nexec sleep 1000\n")["PATH"]
        with subprocess.Popen([PROGRAM, "run", rundir.DISCS_FILE, "-o", "hung", *QUIET, *SHORT, "-s",
                               "output.movie=a.mp4", "-s", "view.range=(0,5)", "-s", "md.dt=1e-6"],
                              cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                              env={**os.environ, "PATH": path}, text=True) as child:
            while child.poll() is None and not os.path.exists(self.path("hung", "scene.cfg")):
                time.sleep(0.01)
            time.sleep(0.2)     # by now it most likely waits for ffmpeg; if not, all the better
            child.send_signal(signal.SIGINT)
            told = child.communicate(timeout=120)[1]
        self.assertEqual(child.returncode, 130, told)

    # Streams

    def test_standard_streams_that_are_closed_or_full_or_broken(self):
        def shell(line):
            return subprocess.run(["sh", "-c", line.replace("@", f"'{PROGRAM}'")], cwd=self.folder,
                                  capture_output=True, text=True, timeout=120, check=False)
        self.assertIn("standard output", shell("@ help keys > /dev/full").stderr)
        self.assertEqual(shell("@ help keys > /dev/full").returncode, 1)
        for streams in ("< /dev/null >&- 2>&-", ">&-", "2>&-", "2> /dev/full"):
            self.clean("closed")
            shell(f"@ run {rundir.DISCS_FILE} -o closed -j1 {' '.join(repr(w) for w in SHORT)} "
                  f"-s output.dump=true {streams}")
            self.assertEqual(rundir.differences(self.path("kept"), self.path("closed")), [], streams)

    def test_a_reader_that_left_ends_the_program_without_a_word_and_ends_no_run(self):
        # As any program in a pipe: by SIGPIPE, which shells call 141.
        for words in (["scenes"], ["help", "keys"],
                      ["run", rundir.DISCS_FILE, "-o", "unread", "-j1", *SHORT, "-s",
                       "output.dump=true"]):
            reader, writer = os.pipe()
            os.close(reader)
            done = subprocess.run([PROGRAM, *words], cwd=self.folder, stdout=writer, text=True,
                                  stderr=subprocess.PIPE, timeout=120, check=False)
            os.close(writer)
            self.assertEqual(done.returncode, -signal.SIGPIPE, done.stderr)
            self.assertNotIn("sandreel:", done.stderr)
        self.assertEqual(rundir.differences(self.path("kept"), self.path("unread")), [])

    # Places, words, clocks

    def test_a_path_may_hold_any_letters(self):
        for name in ("ein Weg – mit ü", "a'b\"c", "100%s:x", "-dash", "new\nline", "comma,[0]=1;"):
            folder = self.path(name)
            os.makedirs(folder)
            shutil.copy(self.path(rundir.DISCS_FILE), os.path.join(folder, "d.cfg"))
            run = os.path.join(folder, "a run")
            done = self.call("run", os.path.join(folder, "d.cfg"), "-o", run, *QUIET, *SHORT)
            self.assertEqual(done.returncode, 0, done.stderr)
            again = self.call("run", run, "--resume", *QUIET)
            self.assertEqual(again.returncode, 0, again.stderr)
            words = [["frame", run, "-o", os.path.join(folder, "x.png")]]
            if shutil.which("ffmpeg"):
                words.append(["movie", run, "-o", os.path.join(folder, "x.gif")])
            for call in words:
                done = self.call(*call, *QUIET)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertTrue(os.path.exists(call[-1]))

    def test_a_name_that_is_not_utf8_does_not_stop_a_run(self):
        name = os.path.join(os.fsencode(self.folder), b"d\xfcne.cfg")
        shutil.copy(self.path(rundir.DISCS_FILE), name)
        done = subprocess.run([PROGRAM, "run", name, "-o", "latin", *QUIET, *SHORT], cwd=self.folder,
                              capture_output=True, timeout=120, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_locale_with_a_comma_changes_no_byte(self):
        if not shutil.which("localedef"):
            self.skipTest("no localedef")
        # Of a locale only what says how numbers are written: the rest takes seconds to compile.
        with open(self.path("comma.src"), "w", encoding="ascii") as out:
            out.write('LC_NUMERIC\ndecimal_point ","\nthousands_sep "."\ngrouping 3;3\n'
                      'END LC_NUMERIC\n')
        made = subprocess.run(["localedef", "-c", "-i", self.path("comma.src"), "-f", "UTF-8",
                               self.path("de_DE.UTF-8")], capture_output=True, check=False)
        if not os.path.exists(self.path("de_DE.UTF-8")):
            self.skipTest("cannot make a locale: " + made.stderr.decode())
        done = self.call("run", rundir.DISCS_FILE, "-o", "comma", *QUIET, *SHORT, "-s",
                         "output.dump=true", LOCPATH=self.folder, LC_ALL="de_DE.UTF-8",
                         LANG="de_DE.UTF-8", LC_NUMERIC="de_DE.UTF-8")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(rundir.differences(self.path("kept"), self.path("comma")), [])

    def test_a_date_that_jumps_changes_nothing(self):
        done = self.call("run", rundir.DISCS_FILE, "-o", "jumps", *QUIET, *SHORT, "-s",
                         "output.dump=true", "--time-limit", "3600", LD_PRELOAD=SHIM, SHIM_CLOCK="1")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(rundir.differences(self.path("kept"), self.path("jumps")), [])

    # Checkpoints that do not fit

    def forge(self, change):
        """A copy of the kept run whose checkpoints were changed and hashed anew."""
        self.clean("forged")
        shutil.copytree(self.path("kept"), self.path("forged"))
        for name in glob.glob(self.path("forged", "checkpoint", "*.checkpoint")):
            with open(name, "rb") as file:
                data = bytearray(file.read())
            change(data)
            self.rehash(data)
            with open(name, "wb") as file:
                file.write(data)
        return self.call("run", "forged", "--resume", *QUIET)

    # Ways to bend a word: none, huge, an index far off or off by one, no number, a huge number.
    WAYS = (lambda word: 0, lambda word: 2**64 - 1, lambda word: word ^ 1 << 33,
            lambda word: word ^ 1, lambda word: 0x7ff8000000000000, lambda word: 0x7e37e43c8800759c)

    def part_names(self):
        """What belongs to no model: how far each output is, and what is gathered; and the numbers of
        the grains, by which it is gathered."""
        names = ["run.checkpoint_next", "run.next", "run.maps", "run.wall", "log.size", "log.rows",
                 "log.time_last", "log.impulse_last", "log.stress_last", "map.snapshots", "map.from",
                 "map.to", "stress.from", "stress.snapshots", "stress.before", "stress.moments",
                 "tally.bodies", "tally.mass_in", "tally.mass_out", "tally.impact", "tally.stress",
                 "tally.stress_total", "source.0", "ed.id"]
        names += ["histograms." + name for name in (
            "from", "impact.size", "impact.rows", "collisions.size", "collisions.rows", "before",
            "known_count", "known")]
        return {rundir.fnv(name.encode()): name for name in names}

    def test_forged_records_of_a_run_are_refused_or_it_goes_on(self):
        with open(self.path("rich.cfg"), "w", encoding="utf-8") as out:
            out.write(rundir.DISCS + """
count_max = 400;
sources = ({ position = (4.0, 11.4); rate = 20.0; });
measure = { impact_parameters = true; impact_bins = 4; collision_counts = true; stress = true;
            average = (0.0, 0.3); cell = 4.0; fields = ["density"]; };
""")
        words = ["rich.cfg", *QUIET, "--model", "ed", "--until", "0.2", "-s", "output.frames=0", "-s",
                 "output.checkpoint=0.1", "-s", "output.tallies=0.1", "-s", "phases=()"]
        done = self.call("run", *words, "-o", "rich")
        self.assertEqual(done.returncode, 0, done.stderr)
        names, met, tries = self.part_names(), set(), 0
        newest = self.path("rich", "checkpoint", "1.checkpoint")
        with open(newest, "rb") as file:
            whole = file.read()
        fields = rundir.CHECKPOINT_HEADER.unpack_from(whole)
        at = rundir.CHECKPOINT_HEADER.size + fields[5]
        while at < len(whole):
            name, width, count = struct.unpack_from("<QQQ", whole, at)
            size = (width * count + 7) // 8 * 8
            if name in names and size > 0:
                met.add(names[name])
                word = at + 24 + 8 * (tries % (size // 8))
                for way in self.WAYS if STRIDE == 1 else [self.WAYS[len(met) % len(self.WAYS)]]:
                    self.try_forged(whole, word, way, names[name], words)
                    tries += 1
            at += 24 + size
        self.assertGreater(len(met), 15, met)

    def try_forged(self, whole, at, way, name, words):
        self.clean("forged")
        shutil.copytree(self.path("rich"), self.path("forged"))
        os.unlink(self.path("forged", "checkpoint", "0.checkpoint"))
        data = bytearray(whole)
        struct.pack_into("<Q", data, at, way(struct.unpack_from("<Q", data, at)[0]))
        self.rehash(data)
        with open(self.path("forged", "checkpoint", "1.checkpoint"), "wb") as file:
            file.write(data)
        # In bounded memory: what asks for much is to be refused, not given.
        done = self.call("run", *words, "-o", "forged", "--until", "0.3", "--resume",
                         before=["prlimit", "--as=4000000000"])
        self.assertIn(done.returncode, (0, 1), f"{name}: {done.returncode} {done.stderr}")
        if done.returncode:
            self.assert_told(done, 1)

    @staticmethod
    def rehash(data):
        at = rundir.CHECKPOINT_HEADER.size - 8
        data[at - 8:at] = struct.pack("<Q", rundir.fnv(data[at + 8:]))
        data[at:at + 8] = struct.pack("<Q", rundir.fnv(data[:at]))

    def test_a_checkpoint_of_another_version_or_scene_is_refused_with_what_differs(self):
        self.assertEqual(self.forge(lambda data: None).returncode, 0)

        def older(data):
            data[16:40] = b"0.0.9".ljust(24, b"\0")
        self.assert_told(self.forge(older), 2, "0.0.9", "this is ")

        def layout(data):
            data[8:12] = struct.pack("<I", 1)
        self.assert_told(self.forge(layout), 1, "another version")

        def scene(data):
            at = data.index(b"seed = 1;")
            data[at:at + 9] = b"seed = 7;"
        self.assert_told(self.forge(scene), 2, "seed: 7 there, 1 here")
        done = self.call("run", rundir.DISCS_FILE, "-o", "kept", "--resume", *QUIET, *SHORT, "-s",
                         "output.dump=true", "-s", "grains.radius=0.39", "--seed", "3")
        self.assert_told(done, 2, "seed: 1 there, 3 here", "grains.[0].radius: (0.4, 0.4) there, "
                         "(0.39, 0.39) here")


if __name__ == "__main__":
    program = unittest.main(exit=False, verbosity=1)
    sys.exit(0 if program.result.wasSuccessful() else 1)
