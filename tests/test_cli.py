"""test_cli.py - the program as its users meet it: every command, exit code and file.

Called with the path of the binary.  Runs are small (a hundred soft discs, a small lattice gas), so
that all of it takes about a minute; nothing depends on how fast the machine is.

SPDX-License-Identifier: GPL-3.0-or-later
"""
import csv
import glob
import json
import os
import re
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest

import rundir
import verdict

PROGRAM = os.path.abspath(sys.argv.pop(1))

# A hundred discs fall on the floor; the first touch it after about 0.6.
DISCS = """
title = "discs that fall";
model = "md";
until = 1.2;
box = (0.0, 0.0, 16.0, 12.0);
gravity = (0.0, -10.0);
grains = ({ radius = 0.4; restitution = 0.5; density = 1.0; });
placements = ({ region = (3.0, 2.0, 13.0, 11.0); jitter = 0.5; spacing = 1.1; });
obstacles = ({ shape = "disc"; center = (8.0, 1.0); radius = 0.7; });
view = { size = (160, 120); };
output = { frames = 0.1; log = 0.05; maps = 0.4; checkpoint = 0.2; checkpoint_wall = 0.0; };
"""
FIXED = ["-s", "view.range=(0, 5)"]


class Sandreel(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        # In memory where possible: every file is synced, which costs most of the time on a disk.
        memory = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
        cls.folder = tempfile.mkdtemp(prefix="sandreel-test-", dir=memory)
        cls.scene = os.path.join(cls.folder, "discs.cfg")
        with open(cls.scene, "w", encoding="utf-8") as out:
            out.write(DISCS)
        cls.kept = os.path.join(cls.folder, "kept")
        cls.say("run", cls.scene, "-o", cls.kept, "-s", "output.dump=true", "-s",
                "output.contacts=true", "-j1")

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    @classmethod
    def call(cls, *arguments, env=None, limit=None):
        def restrict():
            if limit:
                resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
        return subprocess.run([PROGRAM, *arguments], cwd=cls.folder, capture_output=True, text=True,
                              env=env, preexec_fn=restrict, timeout=300, check=False)

    @classmethod
    def say(cls, *arguments):
        """Calls the program, which must succeed; returns what it printed."""
        done = cls.call(*arguments)
        if done.returncode != 0:
            raise AssertionError(f"{arguments} ended with {done.returncode}: {done.stderr}")
        return done.stdout

    def refuse(self, code, *arguments, words=(), **keywords):
        """Calls the program, which must end with this code and say these words."""
        done = self.call(*arguments, **keywords)
        self.assertEqual(done.returncode, code, done.stderr)
        for word in words:
            self.assertIn(word, done.stderr)
        return done

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def manifest(self, run):
        with open(self.path(run, "manifest.json"), encoding="utf-8") as text:
            return json.load(text)

    @staticmethod
    def rows(path):
        with open(path, encoding="utf-8") as text:
            return list(csv.DictReader(line for line in text if not line.startswith("#")))

    def assert_same_run(self, one, other):
        """The same bytes of every file, but for wall times, checkpoints and manifests."""
        def files(run):
            found = glob.glob(self.path(run, "**", "*"), recursive=True)
            names = [os.path.relpath(name, self.path(run)) for name in found if os.path.isfile(name)]
            return sorted(name for name in names
                          if not name.startswith("checkpoint") and name != "manifest.json")
        self.assertEqual(files(one), files(other))
        for name in files(one):
            if name == "log.csv":
                logs = [self.rows(self.path(run, name)) for run in (one, other)]
                for row in logs[0] + logs[1]:
                    del row["wall_seconds"]
                self.assertEqual(*logs)
                continue
            with open(self.path(one, name), "rb") as a, open(self.path(other, name), "rb") as b:
                self.assertEqual(a.read(), b.read(), name)
        self.assertEqual(self.manifest(one)["state_digest"], self.manifest(other)["state_digest"])

    def assert_no_partial_files(self, *under):
        found = glob.glob(self.path(*under, "**", "*.partial*"), recursive=True)
        self.assertEqual(found, [])

    # Wrong use

    def test_wrong_words_get_the_nearest_right_one_and_exit_code_2(self):
        self.refuse(2, "rum", words=["did you mean 'run'"])
        self.refuse(2, "run", "--modle", "md", self.scene, words=["did you mean '--model'"])
        self.refuse(2, "run", words=["needs SCENE"])
        self.refuse(2, "run", self.scene, "second", words=["one word too many"])
        self.refuse(2, "frame", self.scene, "-t", "soon", words=["not a number"])
        self.refuse(2, "run", self.scene, "--time-limit", "never", words=["--time-limit"])
        self.refuse(2, "movie", self.scene, "-o", "x.avi", words=[".mp4, .webm or .gif"])
        self.refuse(2, "map", self.kept, "--as", "jpg", words=["png, npy, vti, csv"])
        self.refuse(2, "help", "restituton", words=["did you mean 'restitution'"])
        self.refuse(2, "bench", "pgn", words=["did you mean 'png'"])

    def test_all_mistakes_of_a_scene_are_told_with_their_lines_and_exit_code_3(self):
        bad = self.path("bad.cfg")
        with open(bad, "w", encoding="utf-8") as out:
            out.write(DISCS.replace("restitution = 0.5", "restituton = 0.5")
                      .replace("until = 1.2", "until = -1.2"))
        for command in ("check", "run", "frame"):
            done = self.refuse(3, command, bad, words=["did you mean 'restitution'"])
            self.assertRegex(done.stderr, r"bad\.cfg:4: error: .*until")
            self.assertRegex(done.stderr, r"bad\.cfg:7: error: .*restituton")
        self.assertFalse(os.path.exists(self.path("bad-md")))
        self.refuse(3, "check", self.path("absent.cfg"))
        self.refuse(3, "run", self.scene, "-s", "gravty=(0,1)", words=["did you mean 'gravity'"])
        self.refuse(3, "check", self.scene, "--model", "mdd", words=["md"])

    def test_check_simulates_nothing_and_explains_the_effects(self):
        told = self.say("check", self.scene, "--explain")
        self.assertRegex(told, r"grains: \d+ at the start")
        self.assertRegex(told, r"(?s)effects that are on:.*gravity.*effects that are off:.*friction")
        plan = self.say("run", self.scene, "--dry-run", "-o", self.path("never"))
        self.assertIn("13 frames, 25 log rows", plan)
        self.assertFalse(os.path.exists(self.path("never")))

    def test_check_draws_the_walls_as_the_lattice_has_them(self):
        scene = self.path("lattice.cfg")
        with open(scene, "w", encoding="utf-8") as out:
            out.write("""model = "lga"; until = 1.0; box = (0.0, 0.0, 72.0, 48.0);
left = "periodic"; right = "periodic";
grains = ({ radius = 0.5; restitution = 1.0; }); placements = ({ count = 1; });
lga = { spacing = 0.5; };
walls = ({ shape = "disc"; center = (20.0, 24.0); radius = 10.0; },
         { shape = "segment"; points = ((50.0, 13.0), (50.0, 48.0)); });""")
        rows = re.findall(r"^ +\|(.*)\|$", self.say("check", scene), re.M)
        self.assertEqual({len(row) for row in rows}, {72})
        self.assertEqual(len(rows), 24)         # a character is 1 x 2, the box 72 x 48
        for row, text in enumerate(rows):
            y = 47 - 2 * row
            for column, found in enumerate(text):
                # Wall nodes lie at most a spacing (0.5) from the wall; what touches a character
                # fills it, half its diagonal (1.12) from its middle.
                x, reach = column + 0.5, 0.5 + 1.12
                floor = min(y, 48 - y)
                nearest = min(((x - 20) ** 2 + (y - 24) ** 2) ** 0.5 - 10,
                              ((x - 50) ** 2 + max(13 - y, 0) ** 2) ** 0.5, floor)
                if nearest > reach:
                    self.assertEqual(found, " ", (x, y))
                elif nearest < -reach:
                    self.assertEqual(found, "#", (x, y))
            self.assertEqual("#" in text[48:52], y > 12 or y < 2, y)

    # What a run writes

    def test_a_run_leaves_what_its_output_asks_for_and_nothing_unfinished(self):
        manifest = self.manifest("kept")
        self.assertEqual(manifest["status"], "done")
        self.assertEqual(manifest["counts"]["frames"], 13)      # 0, 0.1 .. 1.2
        self.assertEqual(len(glob.glob(self.path("kept/frames/??????.png"))), 13)
        self.assertEqual(len(glob.glob(self.path("kept/maps/density_??????.npy"))), 4)
        log = self.rows(self.path("kept/log.csv"))
        self.assertEqual(len(log), 25)
        for k, row in enumerate(log):           # to within half a time step, some 1e-5
            self.assertAlmostEqual(float(row["time"]), 0.05 * k, delta=1e-4)
        self.assertTrue(log[0]["obstacle0_fy"])
        self.assert_no_partial_files("kept")
        with open(self.path("kept/frames/000003.png"), "rb") as png:
            head = png.read(2000)
        self.assertEqual(struct.unpack(">II", head[16:24]), (160, 120))
        self.assertIn(b"discs", head)

    def test_the_obstacle_feels_the_grains_only_once_they_have_fallen_on_it(self):
        # Free fall over 0.1 to 0.2 is 0.05 to 0.2; the obstacle's top is 0.3 below the grains.
        log = self.rows(self.path("kept/log.csv"))
        self.assertEqual(float(log[2]["obstacle0_fy"]), 0)
        self.assertLess(min(float(row["obstacle0_fy"]) for row in log), 0)

    def test_only_the_directory_goes_to_stdout(self):
        self.assertEqual(self.say("run", self.scene, "-o", "here", "--until", "0.1").strip(), "here")
        done = self.call("run", self.scene, "--until", "0.1", "--progress", "none")
        self.assertEqual((done.stdout.strip(), done.stderr), ("discs-md", ""))
        again = self.call("run", self.scene, "--until", "0.1")
        self.assertEqual(again.stdout.strip(), "discs-md-2")

    def test_an_earlier_run_is_never_overwritten_without_force(self):
        self.say("run", self.scene, "-o", "mine", "--until", "0.3")
        with open(self.path("mine/notes.txt"), "w", encoding="utf-8") as out:
            out.write("keep me")
        self.refuse(2, "run", self.scene, "-o", "mine", words=["--force", "--resume"])
        self.say("run", self.scene, "-o", "mine", "--until", "0.1", "--force")
        self.assertEqual(len(glob.glob(self.path("mine/frames/*.png"))), 2)
        self.assertTrue(os.path.exists(self.path("mine/notes.txt")))

    # The same bytes

    def test_threads_and_watching_change_no_byte(self):
        one = self.undisturbed(*FIXED, "-j", "1")
        self.say("run", self.scene, "-o", "two", "-j", "2", *FIXED)
        self.assert_same_run(one, "two")
        self.say("run", self.scene, "-o", "unwatched", "-s", "output.frames=0", "-s", "output.log=0",
                 "-s", "output.maps=0", "-s", "output.checkpoint=0")
        self.assertEqual(self.manifest("unwatched")["state_digest"],
                         self.manifest(one)["state_digest"])

    def test_the_resolved_scene_reproduces_the_run(self):
        self.say("run", self.scene, "-o", "first", "--until", "0.4")
        self.say("run", "first/scene.cfg", "-o", "again")
        self.assertEqual(self.manifest("first")["state_digest"],
                         self.manifest("again")["state_digest"])

    def interrupt(self, run, rows, sent, *options):
        """Starts a run and sends a signal once its log has so many lines; returns the exit code."""
        log = self.path(run, "log.csv")
        with subprocess.Popen([PROGRAM, "run", self.scene, "-o", run, *options], cwd=self.folder,
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as child:
            while child.poll() is None:
                if os.path.exists(log):
                    with open(log, encoding="utf-8") as text:
                        if text.read().count("\n") >= rows:
                            child.send_signal(sent)
                            break
                time.sleep(0.002)
            errors = child.communicate(timeout=120)[1]
        return child.returncode, errors

    def undisturbed(self, *options):
        """A whole run with these options, made once for all that are compared with it."""
        name = "straight-" + str(abs(hash(options)))
        if not os.path.exists(self.path(name)):
            self.say("run", self.scene, "-o", name, *options)
        return name

    def check_interruption(self, torn, sent, code, *options):
        name = self.undisturbed(*options)
        ended, errors = self.interrupt(torn, 12, sent, *options)
        self.assertEqual(ended, code, errors)
        self.assertIn("--resume", errors)
        self.assertEqual(self.manifest(torn)["status"], "interrupted")
        self.assert_no_partial_files(torn)
        self.say("run", torn, "--resume")
        self.assert_same_run(name, torn)

    # Enough steps that the signal finds the run still at work.
    LONG = ["-s", "md.dt=2e-5"]

    def test_a_run_that_is_interrupted_and_resumed_is_like_one_that_was_not(self):
        self.check_interruption("live", signal.SIGINT, 130, *self.LONG, *FIXED)

    def test_frames_that_wait_for_their_colours_survive_an_interruption(self):
        self.check_interruption("late", signal.SIGTERM, 143, *self.LONG, "-s", "output.dump=true")

    def test_a_mean_map_survives_an_interruption(self):
        self.check_interruption("mean", signal.SIGINT, 130, *self.LONG, *FIXED, "-s",
                                "measure.average=(0.1, 1.1)", "-s", "output.maps=0.05")
        self.assertTrue(os.path.exists(self.path("mean/maps/density_mean.npy")))

    def test_the_time_limit_keeps_a_checkpoint_and_a_longer_until_goes_on(self):
        self.refuse(5, "run", self.scene, "-o", "brief", "--time-limit", "0.05", *self.LONG, *FIXED,
                    words=["--resume"])
        self.assertEqual(self.manifest("brief")["status"], "stopped")
        self.say("run", "brief", "--resume", "--until", "1.2")
        self.assert_same_run("brief", self.undisturbed(*self.LONG, *FIXED))

    def test_a_torn_checkpoint_is_noticed_and_the_one_before_it_used(self):
        whole = self.undisturbed(*FIXED, "-j", "1")
        shutil.copytree(self.path(whole), self.path("damaged"))
        files = sorted(glob.glob(self.path("damaged/checkpoint/*.checkpoint")), key=os.path.getmtime)
        self.assertEqual(len(files), 2)
        with open(files[-1], "r+b") as newest:
            newest.truncate(os.path.getsize(files[-1]) - 9)
        self.say("run", "damaged", "--resume")
        self.assert_same_run(whole, "damaged")
        for name in glob.glob(self.path("damaged/checkpoint/*.checkpoint")):
            with open(name, "r+b") as file:
                file.seek(300)
                file.write(b"x")
        self.refuse(1, "run", "damaged", "--resume", words=["checkpoint"])

    def test_a_run_is_not_continued_with_other_settings(self):
        self.say("run", self.scene, "-o", "settled", "--until", "0.3")
        self.refuse(2, "run", self.scene, "-o", "settled", "--resume", "--seed", "7",
                    words=["only 'until' and 'count_max' may differ"])
        self.refuse(1, "run", self.scene, "-o", "nowhere", "--resume")
        self.say("run", self.scene, "-o", "settled", "--resume", "--until", "0.5")
        self.assertEqual(len(glob.glob(self.path("settled/frames/*.png"))), 6)

    def test_a_run_with_sources_is_made_longer_with_room_for_what_they_bring(self):
        scene = self.path("pouring.cfg")
        with open(scene, "w", encoding="utf-8") as out:
            out.write(DISCS.replace("placements", "sources = ({ position = (4.0, 11.0); "
                                    "rate = 40.0; "
                                    "velocity = (0.0, -8.0); });\nplacements"))
        words = [scene, *FIXED, "-s", "output.maps=0", "-s", "placements=()", "-s",
                 "grains.radius=0.1"]
        self.say("run", *words, "-o", "poured", "--until", "0.2")
        self.say("run", *words, "-o", "poured", "--until", "1.2", "--resume")
        self.say("run", *words, "-o", "poured-once", "--until", "1.2")
        self.assert_same_run("poured-once", "poured")
        rows = self.rows(self.path("poured/log.csv"))
        self.assertGreater(int(rows[-1]["grains"]), 12)     # more than 0.2 of the source need
        self.assertEqual(self.manifest("poured")["state_digest"],
                         self.manifest("poured-once")["state_digest"])

    def test_a_run_that_is_done_is_not_done_again(self):
        self.say("run", self.scene, "-o", "ended", "--until", "0.3", "-s", "output.checkpoint=0")
        before = rundir.everything(self.path("ended"))
        self.assertNotIn("checkpoint", os.listdir(self.path("ended")))
        for words in (["ended"], [self.scene, "-o", "ended", "--until", "0.3", "-s",
                                  "output.checkpoint=0"]):
            done = self.call("run", *words, "--resume")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("done already", done.stderr)
        self.refuse(2, "run", "ended", "--resume", "--until", "0.5",
                    words=["kept no checkpoint", "--force"])
        self.assertEqual(rundir.everything(self.path("ended")), before)

    # Errors of the world

    def test_an_unwritable_place_is_told_and_left_clean(self):
        with open(self.path("plain"), "w", encoding="utf-8"):
            pass
        self.refuse(1, "run", self.scene, "-o", "plain/run", words=["plain"])
        self.refuse(1, "frame", self.kept, "-o", "plain/x.png", words=["plain/x.png"])
        self.refuse(1, "movie", self.kept, "-o", "absent/x.mp4", words=["absent/x.mp4"])
        self.refuse(1, "map", self.kept, "-o", "plain/maps", words=["plain"])

    def test_a_file_that_may_not_grow_leaves_no_half_file(self):
        done = self.refuse(1, "run", self.scene, "-o", "small", *FIXED, limit=1500)
        self.assertIn("small", done.stderr)
        self.assert_no_partial_files("small")
        self.refuse(1, "frame", self.kept, "-o", "limited.png", limit=500, words=["limited.png"])
        self.assertEqual(glob.glob(self.path("limited.png*")), [])

    def test_a_full_disk_is_told_and_leaves_no_half_file(self):
        disk = self.path("disk")
        os.mkdir(disk)
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=200k", "tmpfs", disk],
                                 capture_output=True, check=False)
        if mounted.returncode != 0:
            self.skipTest("may not mount a small disk here")
        try:
            done = self.refuse(1, "run", self.scene, "-o", "disk/run", *FIXED)
            self.assertRegex(done.stderr, "No space left|disk full")
            self.assert_no_partial_files("disk")
            log = self.path("disk/run/log.csv")
            if os.path.exists(log) and os.path.getsize(log) > 0:
                with open(log, encoding="utf-8") as text:
                    self.assertTrue(text.read().endswith("\n"))
            with open(self.path("disk/filler"), "wb", buffering=0) as filler:
                try:
                    while filler.write(b"x" * 4096):
                        pass
                except OSError:
                    pass
            self.refuse(1, "movie", self.kept, "-o", "disk/x.mp4", "--size", "640x480")
            self.assertEqual(glob.glob(self.path("disk/x.mp4*")), [])
        finally:
            subprocess.run(["umount", disk], check=True)

    def test_a_state_that_breaks_leaves_a_checkpoint_and_a_picture(self):
        done = self.refuse(1, "run", self.scene, "-o", "broken", "-s", "overlap_limit=1e-9")
        self.assertRegex(done.stderr, "grain")
        self.assertTrue(os.path.exists(self.path("broken/broken.png")))
        self.assertTrue(os.path.exists(self.path("broken/checkpoint/broken.checkpoint")))
        self.assertEqual(self.manifest("broken")["status"], "failed")

    # Pictures, movies, maps and numbers of a run

    def test_a_frame_drawn_again_from_the_dumps_has_the_same_bytes(self):
        self.say("frame", self.kept, "-t", "0.5", "-o", "again.png")
        with open(self.path("again.png"), "rb") as a:
            with open(self.path("kept/frames/000005.png"), "rb") as b:
                self.assertEqual(a.read(), b.read())
        self.say("frame", self.kept, "-o", "other.png", "--size", "200x100", "--color", "pressure",
                 "--forces", "--zoom", "0,0,8,6", "--theme", "dark", "--map", "density")
        with open(self.path("other.png"), "rb") as png:
            self.assertEqual(struct.unpack(">II", png.read(24)[16:24]), (200, 100))
        self.refuse(2, "frame", self.kept, "--seed", "2", words=["would change what was simulated"])

    def test_a_frame_simulated_on_the_fly_shows_the_same_grains(self):
        for name, source in (("fly.png", self.scene), ("kept.png", self.kept)):
            self.say("frame", source, "-t", "0.3", "-o", name, "--range", "0,5")
        with open(self.path("fly.png"), "rb") as a, open(self.path("kept.png"), "rb") as b:
            self.assertEqual(a.read(), b.read())

    def test_a_movie_has_every_frame_and_even_sides(self):
        if not shutil.which("ffmpeg"):
            self.skipTest("no ffmpeg")
        def probe(name):
            told = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-select_streams", "v",
                                   "-show_entries", "stream=width,height,nb_read_frames,codec_name",
                                   "-of", "json", self.path(name)], capture_output=True, check=True)
            return json.loads(told.stdout)["streams"][0]
        self.say("movie", self.kept, "-o", "film.mp4", "--size", "161x121")
        film = probe("film.mp4")
        self.assertEqual((film["codec_name"], film["width"], film["height"],
                          film["nb_read_frames"]), ("h264", 162, 122, "13"))
        self.say("movie", self.scene, "-o", "film.webm", "--until", "0.3")
        self.assertEqual(probe("film.webm")["nb_read_frames"], "4")
        self.say("movie", self.kept, "-o", "film.gif", *FIXED)
        self.assertEqual(probe("film.gif")["codec_name"], "gif")
        self.say("movie", self.scene, "--model", "md,lga", "--side-by-side", "-o", "pair.mp4",
                 "--until", "0.5", "-s", "obstacles=()")
        pair = probe("pair.mp4")
        self.assertEqual((pair["width"], pair["height"], pair["nb_read_frames"]), (320, 120, "6"))
        self.say("run", self.scene, "-o", "filmed", "--until", "0.3", "-s", "output.movie=film.mp4")
        self.assertEqual(probe("filmed/film.mp4")["nb_read_frames"], "4")
        self.assertEqual(glob.glob(self.path("*.grains")) + glob.glob(self.path("*.partial")), [])

    def test_without_ffmpeg_a_movie_says_how_to_install_it(self):
        empty = dict(os.environ, PATH="/nonexistent")
        self.refuse(1, "movie", self.kept, "-o", "none.mp4", env=empty,
                    words=["ffmpeg", "apt install"])
        self.refuse(1, "run", self.scene, "-o", "unfilmed", "-s", "output.movie=a.mp4", env=empty,
                    words=["ffmpeg"])

    def test_the_colours_of_a_lattice_end_at_the_one_speed_of_its_grains(self):
        """A node in a tick of 0.7; the histogram's bin that holds it would end them 0.2 % below."""
        self.say("run", "pile", "--quick", "-o", "pile", "-s", "lga.tick=0.7", "-s",
                 "output.frames=850")
        with open(self.path("pile/frames/000001.png"), "rb") as frame:
            told = re.search(rb"Range\0speed 0 \.\. ([0-9.]+)", frame.read())
        self.assertAlmostEqual(float(told.group(1)), 1 / 0.7, delta=1e-6)

    def test_a_density_map_counts_every_grain(self):
        self.say("map", self.kept, "-t", "0.6", "--field", "density,velocity", "--cell", "1", "--as",
                 "png,npy,vti,csv", "-o", "maps", "--kernel", "box")
        for ending in ("png", "npy", "vti", "csv"):
            self.assertEqual(len(glob.glob(self.path("maps", "*." + ending))), 2)
        table = glob.glob(self.path("maps/density_*.csv"))[0]
        count = sum(float(row["density"]) for row in self.rows(table))       # cells of area 1
        placed = int(re.search(r"grains: (\d+)", self.say("check", self.scene)).group(1))
        self.assertAlmostEqual(count, placed, delta=1e-6 * placed)
        self.say("map", self.kept, "--average", "0.2:0.8", "-o", "means", "--as", "npy")
        self.assertTrue(glob.glob(self.path("means/temperature_mean_*.npy")))
        self.refuse(2, "map", self.kept, "--average", "0.8:0.2")

    def test_info_tells_of_a_grain_and_the_contacts_that_carry_it(self):
        told = json.loads(self.say("info", self.kept, "--frame", "12", "--at", "8,0.4", "--json"))
        self.assertEqual(told["frame"], 12)
        self.assertAlmostEqual(told["radius"], 0.4)
        for contact in told["contacts"]:
            self.assertRegex(contact["with"], r"^(grain|wall) \d+$")
        same = json.loads(self.say("info", self.kept, "--grain", str(told["id"]), "--json"))
        self.assertEqual((same["x"], same["y"]), (told["x"], told["y"]))
        self.assertIn("status", self.say("info", self.kept))
        self.assertEqual(json.loads(self.say("info", self.kept, "--json"))["dumps"]["frames"], 13)
        self.refuse(2, "info", self.kept, "--grain", "999999", words=["no grain"])
        self.refuse(2, "info", self.kept, "--frame", "99", "--grain", "1", words=["0 to 12"])

    def test_export_writes_one_line_a_grain(self):
        self.say("export", self.kept, "--to", "csv", "--frame", "4", "-o", "tables")
        rows = self.rows(self.path("tables/grains_000004.csv"))
        placed = int(re.search(r"grains: (\d+)", self.say("check", self.scene)).group(1))
        self.assertEqual(len(rows), placed)
        self.assertEqual(list(rows[0]), "id,x,y,vx,vy,spin,radius,collision_rate,species".split(","))

    # Help and tables

    def test_help_explains_every_command_and_key(self):
        commands = re.findall(r"^  ([a-z]+) ", self.say("help"), re.M)
        for command in ("run", "frame", "movie", "map", "check", "scenes", "info", "bench"):
            self.assertIn(command, commands)
            self.assertIn("usage: sandreel " + command, self.say("help", command))
            self.assertIn("usage: sandreel " + command, self.say(command, "--help"))
        self.assertIn("0 to 1", self.say("help", "grains.restitution"))
        self.assertIn("md.dt", self.say("help", "md"))

    def test_tables_can_be_read_by_programs(self):
        version = json.loads(self.say("version", "--json"))
        self.assertEqual(set(version["models"]) >= {"md", "lga"}, True)
        for scene in json.loads(self.say("scenes", "--json")):
            self.assertIn(scene["model"], scene["models"])
        table = self.say("bench", "png", "--json", "-o", "bench.json")
        self.assertEqual(json.loads(table)["cases"][0]["name"], "png")
        self.assertRegex(self.say("bench", "png", "--against", "bench.json"), r"\d\.\d\d x")


if __name__ == "__main__":
    verdict.run()
