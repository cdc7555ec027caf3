"""test_install.py - what `meson install` leaves works where it was put, and when it is moved.

Called with the path of the binary and the build directory.  The installed tree is moved once, so
nothing can lean on the place that it was installed to, nor on the sources.

SPDX-License-Identifier: GPL-3.0-or-later
"""
import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import verdict

BUILD = os.path.abspath(sys.argv.pop(2))
PROGRAM = os.path.abspath(sys.argv.pop(1))


class Install(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        meson = shutil.which("meson")
        if not meson:
            raise unittest.SkipTest("meson is not on the PATH")
        cls.folder = tempfile.mkdtemp(prefix="sandreel-install-")
        done = subprocess.run([meson, "install", "-C", BUILD, "--no-rebuild", "--quiet", "--destdir",
                               os.path.join(cls.folder, "first")], capture_output=True, text=True,
                              timeout=120, check=False)
        if done.returncode != 0:
            raise AssertionError(done.stdout + done.stderr)
        os.rename(os.path.join(cls.folder, "first"), os.path.join(cls.folder, "moved"))
        cls.program = cls.only("**/bin/sandreel")
        cls.empty = os.path.join(cls.folder, "empty")
        os.mkdir(cls.empty)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder, ignore_errors=True)

    @classmethod
    def only(cls, pattern):
        found = glob.glob(os.path.join(cls.folder, "moved", pattern), recursive=True)
        if len(found) != 1:
            raise AssertionError(f"{pattern}: {found}")
        return found[0]

    def call(self, *arguments, **keywords):
        # Neither the home directory nor the PATH knows of another sandreel.
        environment = dict(os.environ, HOME=self.empty)
        environment.pop("SOURCE_ROOT", None)
        done = subprocess.run(arguments, cwd=self.empty, capture_output=True, text=True,
                              timeout=120, check=False, env=dict(environment, **keywords))
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done

    def need(self, program):
        found = shutil.which(program)
        if not found:
            self.skipTest(f"{program} is not installed")
        return found

    def test_a_built_in_scene_runs_and_is_drawn_from_an_empty_directory(self):
        self.call(self.program, "run", "hourglass", "-s", "quick=true", "--until", "0.02",
                  "-s", "output.frames=0.01", "-o", "run", "--progress", "none")
        frames = glob.glob(os.path.join(self.empty, "run/frames/*.png"))
        self.assertEqual(len(frames), 3)
        self.call(PROGRAM, "run", "hourglass", "-s", "quick=true", "--until", "0.02",
                  "-s", "output.frames=0.01", "-o", "built", "--progress", "none")
        for name in frames:
            with open(name, "rb") as one, open(name.replace("/run/", "/built/"), "rb") as other:
                self.assertEqual(one.read(), other.read(), name)

    def test_every_scene_is_there_as_a_file_too(self):
        scenes = os.path.dirname(self.only("**/share/sandreel/scenes/hourglass.cfg"))
        told = self.call(self.program, "scenes").stdout.splitlines()[1:]
        names = {line.split()[0] for line in told if line and line[0] != " "}
        files = {os.path.relpath(name, scenes)[:-4]
                 for name in glob.glob(scenes + "/**/*.cfg", recursive=True)}
        self.assertTrue(files <= names | {"hard/clock-quick"}, files - names)
        self.assertGreater(len(files), 40)
        self.call(self.program, "check", os.path.join(scenes, "silo.cfg"))

    def test_the_pages_are_there_and_groff_has_nothing_to_say_about_them(self):
        self.only("**/share/doc/sandreel/architecture.md")
        self.only("**/share/sandreel/colormaps/viridis.csv")
        if not glob.glob(os.path.join(self.folder, "moved/**/man1"), recursive=True):
            self.skipTest("built without scdoc")
        groff = self.need("groff")
        for name, word in (("man1/sandreel.1", "SYNOPSIS"), ("man5/sandreel-scene.5", "restitution")):
            done = self.call(groff, "-man", "-ww", "-Tutf8", self.only("**/" + name))
            text = re.sub(".\b", "", done.stdout)       # bold is struck twice
            self.assertTrue(word in text, word)
            self.assertEqual(done.stderr, "")

    def test_bash_takes_the_completion(self):
        script = self.only("**/bash-completion/completions/sandreel.bash")
        done = self.call(self.need("bash"), "-c", f". {script}; complete -p sandreel")
        self.assertIn("_sandreel", done.stdout)

    def test_fish_finds_the_completion_in_the_installed_data(self):
        share = os.path.dirname(self.only("**/share/sandreel"))
        path = os.path.dirname(self.program) + ":" + os.environ["PATH"]
        done = self.call(self.need("fish"), "-c", "complete -C 'sandreel swe'", XDG_DATA_DIRS=share,
                         XDG_CONFIG_HOME=self.empty, PATH=path)
        self.assertEqual(done.stdout.split("\t")[0].strip(), "sweep")

    def test_zsh_finds_the_completion_on_its_path(self):
        place = os.path.dirname(self.only("**/_sandreel"))
        done = self.call(self.need("zsh"), "-f", "-c", f"fpath=({place} $fpath); autoload -U "
                         "compinit; compinit -u -D; print $_comps[sandreel]; autoload +X _sandreel")
        self.assertEqual(done.stdout.strip(), "_sandreel")


if __name__ == "__main__":
    verdict.run()
