"""test_example_effect.py - the worked example of a new effect (docs/extending.md) is applied, built
and run.

Called with the compiler's words, then `--`, then the build directory.  The patch is applied to a
copy of what lies below the models, which is all that its example needs: seconds of compiling.

SPDX-License-Identifier: GPL-3.0-or-later
"""
import glob
import os
import shutil
import subprocess
import sys
import tempfile

SKIPPED = 77
SOURCE = os.environ["SOURCE_ROOT"]


def run(*words, **keywords):
    done = subprocess.run(words, capture_output=True, text=True, timeout=300, check=False,
                          **keywords)
    if done.returncode != 0:
        sys.exit(f"{words[0]} ended with {done.returncode}:\n{done.stdout}{done.stderr}")
    return done


def main():
    split = sys.argv.index("--")
    compiler, build = sys.argv[1:split], sys.argv[split + 1]
    if not shutil.which("patch"):
        print("skipped the example of an effect: patch is not installed")
        sys.exit(SKIPPED)
    with tempfile.TemporaryDirectory() as folder:
        for part in ("src", "docs/examples"):
            shutil.copytree(os.path.join(SOURCE, part), os.path.join(folder, part))
        run("patch", "-p1", "--batch", "-i", "docs/examples/drag.patch", cwd=folder)
        sources = [name for part in ("src/base/*.c", "src/scene/*.c", "src/model/grains.c",
                                     "src/model/field.c", "docs/examples/d*.c")
                   for name in sorted(glob.glob(os.path.join(folder, part)))]
        run(*compiler, "-std=c11", "-D_GNU_SOURCE", "-O0", "-Wall", "-Wextra", "-Werror", "-fopenmp",
            "-I", os.path.join(folder, "src"), "-o", os.path.join(folder, "drag"), *sources,
            os.path.join(build, "embedded.c"), "-lconfig", "-lm")
        print(run(os.path.join(folder, "drag")).stdout, end="")


main()
