"""test_kill.py - a run that is killed and resumed, as often as it may be, leaves the same
directory as one that was never disturbed.

    test_kill.py PROGRAM FAULTY [moments MOMENTS | calls STRIDE]

`moments`: kill -9 at random moments over all models and methods, one case after the other, each
resumed on another number of threads (and killed again with probability 1/3).  The moments come
from a fixed seed; which instruction they hit is chance.

`calls`: kill -9 at every STRIDE'th system call that changes a file, which leaves no gap between two
files untried (faulty.c; skipped where the kernel does not offer it).

SPDX-License-Identifier: GPL-3.0-or-later
"""
import json
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time

import rundir

PROGRAM = os.path.abspath(sys.argv[1])
FAULTY = os.path.abspath(sys.argv[2])
MODE = sys.argv[3] if len(sys.argv) > 3 else "moments"
NUMBER = int(sys.argv[4]) if len(sys.argv) > 4 else 15
SKIPPED = 77


def is_done(run):
    try:
        with open(os.path.join(run, "manifest.json"), encoding="utf-8") as file:
            return json.load(file)["status"] == "done"
    except OSError:
        return False


class Trial:
    def __init__(self, folder, case):
        self.name, self.scene, self.options = case
        self.folder = folder
        self.straight = os.path.join(folder, self.name + "-straight")
        start = time.monotonic()
        self.call([PROGRAM, *self.words(self.straight, 1)], check=True)
        self.seconds = time.monotonic() - start

    def words(self, run, threads, resume=False):
        words = ["run", self.scene, "-o", run, "-j", str(threads), "--progress", "none",
                 *self.options]
        return words + ["--resume"] if resume else words

    def call(self, words, check=False):
        done = subprocess.run(words, cwd=self.folder, capture_output=True, text=True, timeout=300,
                              check=False)
        if check and done.returncode != 0:
            raise SystemExit(f"{self.name}: {words} ended with {done.returncode}:\n{done.stderr}")
        return done.returncode

    def kill(self, words, moment):
        with subprocess.Popen([PROGRAM, *words], cwd=self.folder, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL) as child:
            try:
                child.wait(moment)
            except subprocess.TimeoutExpired:
                child.kill()
        return child.returncode

    def judge(self, torn, how):
        """Resumes and compares; the number of failures (0 or 1).  What was killed between its
        last word and its end, and keeps no checkpoints, is done and needs no more."""
        if is_done(torn) and not os.path.exists(os.path.join(torn, "checkpoint")):
            pass
        elif os.path.exists(torn):
            self.call([PROGRAM, *self.words(torn, 2, resume=True)], check=True)
        else:
            self.call([PROGRAM, *self.words(torn, 2)], check=True)
        found = rundir.differences(self.straight, torn)
        shutil.rmtree(torn)
        if not found:
            return 0
        print(f"{self.name}, killed {how}: {found[:5]}")
        return 1


def try_moments(folder, moments):
    dice = random.Random(7)
    trials = [Trial(folder, case) for case in rundir.cases(PROGRAM)[:max(1, moments)]]
    killed = failed = 0
    for k in range(moments):
        trial = trials[k % len(trials)]
        torn = os.path.join(folder, "torn")
        moment = dice.random() * trial.seconds
        killed += trial.kill(trial.words(torn, 1 + k % 2), moment) < 0
        if dice.random() < 1 / 3 and os.path.exists(torn):
            again = dice.random() * trial.seconds
            killed += trial.kill(trial.words(torn, 2 - k % 2, resume=True), again) < 0
        failed += trial.judge(torn, f"after {moment:.3f} s")
    print(f"{moments} runs, {killed} kills, {failed} directories that differ")
    return 1 if failed else 0


# Short runs with all that a run writes: frames that wait for their colours and go through dumps,
# and dumps with frames at once; maps, log and checkpoints in both.
SHORT = ["--until", "0.3", "-s", "output.maps=0.2", "-s", "output.checkpoint=0.1"]
CALL_CASES = [("late", rundir.DISCS_FILE, SHORT),
              ("dumped", rundir.DISCS_FILE, [*SHORT, "-s", "output.dump=true", "-s",
                                             "view.range=(0, 5)", "--model", "ed"])]


# Of a trajectory the library writes many pieces a frame, and more grains than there were take more
# room in it; nothing else is written, so that the calls are spent on it.
GROWING = ("growing", "growing.cfg", ["--until", "0.12", "-s", "output.trajectory=0.01", "-s",
                                      "output.checkpoint=0.03", "-s", "output.frames=0", "-s",
                                      "output.maps=0", "-s", "phases=()"])


def try_calls(folder, stride):
    failed = tried = 0
    count = os.path.join(folder, "count")
    with open(os.path.join(folder, GROWING[1]), "w", encoding="utf-8") as out:
        out.write(rundir.DISCS + "count_max = 900;\n"
                  "sources = ({ position = (4.0, 11.4); rate = 300.0; });\n")
    for case in CALL_CASES + ([GROWING] if rundir.has_hdf5(PROGRAM) else []):
        trial = Trial(folder, case)
        torn = os.path.join(folder, "torn")
        ended, call = 1, 1
        while ended != 0:
            ended = trial.call([FAULTY, count, str(call), "kill", PROGRAM, *trial.words(torn, 1)])
            if ended == SKIPPED:
                return SKIPPED
            failed += trial.judge(torn, f"at call {call}")
            tried += ended != 0
            call += stride
    print(f"{tried} kills, {failed} directories that differ")
    return 1 if failed else 0


def main():
    # In memory where possible: every file is synced, which costs most of the time on a disk.
    memory = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
    with tempfile.TemporaryDirectory(prefix="sandreel-kill-", dir=memory) as folder:
        rundir.write_scenes(folder)
        os.environ["OMP_WAIT_POLICY"] = "passive"
        return {"moments": try_moments, "calls": try_calls}[MODE](folder, NUMBER)


if __name__ == "__main__":
    sys.exit(main())
