"""test_frames.py - frames as references: the same bytes from run to run and from both renderers, and
`frame --against`, which tells when they are not.

SPDX-License-Identifier: GPL-3.0-or-later
"""
import glob
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest

import rundir

try:
    import yaml
except ImportError:
    yaml = None

PROGRAM = os.path.abspath(sys.argv.pop(1))
CI_PAGE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "docs", "ci.md")
LOOK = ["-t", "0.1", "--size", "160x120", "--forces", "--arrows", "--map", "density", "--theme",
        "dark", "--force", "--progress", "none"]


class Frames(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="sandreel-frames-")
        rundir.write_scenes(cls.folder)
        done = cls.frame("reference.png")
        if done.returncode != 0:
            raise AssertionError(done.stderr)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    @classmethod
    def frame(cls, name, *options, **settings):
        return subprocess.run([PROGRAM, "frame", rundir.DISCS_FILE, "-o", name, *LOOK, *options],
                              cwd=cls.folder, capture_output=True, text=True, timeout=120,
                              env={**os.environ, **settings}, check=False)

    def bytes_of(self, name):
        with open(os.path.join(self.folder, name), "rb") as file:
            return file.read()

    def test_a_frame_is_the_same_from_run_to_run_and_on_any_number_of_threads(self):
        for threads in ("1", "2"):
            self.frame("again.png", "-j", threads)
            self.assertEqual(self.bytes_of("again.png"), self.bytes_of("reference.png"))

    def test_both_renderers_draw_the_same_bytes(self):
        for renderer in ("osmesa", "egl"):
            done = self.frame(renderer + ".png", SANDREEL_GL=renderer)
            if "not installed" in done.stderr or "cannot draw" in done.stderr:
                self.skipTest(done.stderr)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(self.bytes_of(renderer + ".png"), self.bytes_of("reference.png"))

    def test_the_same_picture_passes_and_another_ends_with_4_and_a_picture_of_the_difference(self):
        done = self.frame("now.png", "--against", "reference.png")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertFalse(os.path.exists(os.path.join(self.folder, "now-difference.png")))
        done = self.frame("now.png", "--against", "reference.png", "--tolerance", "3",
                          "--colormap", "inferno")
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn("of 19200 pixels differ", done.stderr)
        self.assertIn("now-difference.png", done.stderr)
        self.assertEqual(self.bytes_of("now-difference.png")[:4], b"\x89PNG")
        # No two pixels are further apart than 255, so this tolerance lets everything pass.
        done = self.frame("now.png", "--against", "reference.png", "--tolerance", "255",
                          "--colormap", "inferno")
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_what_cannot_be_compared_is_told(self):
        for words, code, told in ((["--against", "absent.png"], 1, "absent.png"),
                                  (["--against", rundir.DISCS_FILE], 1, "PNG"),
                                  (["--tolerance", "3"], 2, "--against"),
                                  (["--against", "reference.png", "--tolerance", "256"], 2, "255"),
                                  (["--against", "now2.png"], 2, "overwrite"),
                                  (["--against", "reference.png", "--size", "80x60"], 4, "160x120")):
            done = self.frame("now2.png", *words)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertIn(told, done.stderr)

    def examples(self):
        """The two pipelines of docs/ci.md: their commands, and the files kept when one fails."""
        with open(CI_PAGE, encoding="utf-8") as page:
            github, gitlab = map(yaml.safe_load, re.findall(r"```yaml\n(.*?)```", page.read(), re.S))
        job = github["jobs"]["figures"]
        self.assertIn("runs-on", job)
        self.assertIn(True, github, "'on', which YAML 1.1 takes for true")
        steps = job["steps"]
        for step in steps:
            self.assertEqual(len({"uses", "run"} & set(step)), 1, step)
        kept = [step for step in steps if step.get("if") == "failure()"]
        yield [step["run"] for step in steps if "run" in step], [kept[0]["with"]["path"]]
        job = gitlab["figures"]
        self.assertIn("image", job)
        self.assertEqual(job["artifacts"]["when"], "on_failure")
        yield job["script"], job["artifacts"]["paths"]

    @unittest.skipIf(yaml is None, "no python3-yaml: the examples of docs/ci.md are not tried")
    def test_the_examples_of_pipelines_do_what_they_say(self):
        for script, kept in self.examples():
            self.assertEqual(script[0], "./bootstrap --yes build")
            words = shlex.split(script[1])
            self.assertEqual(words[0], "build/sandreel")
            with tempfile.TemporaryDirectory(dir=self.folder) as place:
                with open(os.path.join(place, "scene.cfg"), "w", encoding="utf-8") as out:
                    out.write(rundir.DISCS)
                os.mkdir(os.path.join(place, "figures"))
                pipe = {"cwd": place, "capture_output": True, "text": True, "timeout": 120,
                        "check": False}
                subprocess.run([PROGRAM, "frame", "scene.cfg", "-t", "0.5", "-o",
                                "figures/scene.png"], **pipe)
                done = subprocess.run([PROGRAM, *words[1:]], **pipe)
                self.assertEqual(done.returncode, 0, done.stderr)
                os.unlink(os.path.join(place, "now.png"))
                with open(os.path.join(place, "scene.cfg"), "a", encoding="utf-8") as out:
                    out.write("seed = 2;\n")
                done = subprocess.run([PROGRAM, *words[1:]], **pipe)
                self.assertEqual(done.returncode, 4, done.stderr)
                found = {name for path in kept for name in glob.glob(path, root_dir=place)}
                self.assertEqual(found, {"now.png", "now-difference.png"})


if __name__ == "__main__":
    program = unittest.main(exit=False, verbosity=1)
    sys.exit(0 if program.result.wasSuccessful() else 1)
