"""test_deb.py - `./bootstrap deb` builds a package with Debian's tools, and what is in it works.

The package is unpacked rather than installed, so nobody has to be root.  Takes a whole build.

SPDX-License-Identifier: GPL-3.0-or-later
"""
import glob
import os
import shutil
import subprocess
import tempfile
import unittest

import verdict

SOURCE = os.environ["SOURCE_ROOT"]


def call(*words, **keywords):
    done = subprocess.run(words, capture_output=True, text=True, timeout=3000, check=False,
                          **keywords)
    if done.returncode != 0:
        raise AssertionError(f"{words}: {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if not shutil.which("dpkg-buildpackage") or not shutil.which("dh"):
            raise unittest.SkipTest("debhelper is not installed")
        call("./bootstrap", "deb", cwd=SOURCE)
        cls.package = glob.glob(os.path.join(SOURCE, "build-deb/sandreel_*.deb"))[0]
        cls.folder = tempfile.mkdtemp(prefix="sandreel-deb-")
        call("dpkg-deb", "-x", cls.package, os.path.join(cls.folder, "root"))

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder, ignore_errors=True)

    def test_the_hourglass_runs_from_the_files_of_the_package_in_an_empty_directory(self):
        empty = os.path.join(self.folder, "empty")
        os.mkdir(empty)
        call(os.path.join(self.folder, "root/usr/bin/sandreel"), "run", "hourglass", "-s",
             "quick=true", "--until", "0.1", cwd=empty, env={"PATH": "/usr/bin:/bin", "HOME": empty})
        self.assertTrue(glob.glob(empty + "/hourglass-md/frames/*.png"))

    def test_pages_and_completions_lie_where_debian_looks_for_them(self):
        for name in ("man/man1/sandreel.1.gz", "man/man5/sandreel-scene.5.gz",
                     "bash-completion/completions/sandreel.bash",
                     "zsh/vendor-completions/_sandreel", "fish/vendor_completions.d/sandreel.fish",
                     "sandreel/scenes/hourglass.cfg", "doc/sandreel/copyright"):
            self.assertTrue(os.path.exists(os.path.join(self.folder, "root/usr/share", name)), name)

    def test_lintian_has_nothing_to_say_but_that_the_address_of_the_authors_is_none(self):
        if not shutil.which("lintian"):
            self.skipTest("lintian is not installed")
        done = subprocess.run(["lintian", "--allow-root", self.package], capture_output=True,
                              text=True, timeout=600, check=False)
        told = [line for line in done.stdout.splitlines() if line.startswith(("E:", "W:"))]
        self.assertEqual([line for line in told if "bogus-mail-host" not in line], [])


if __name__ == "__main__":
    verdict.run()
