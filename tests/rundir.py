"""rundir.py - what the tests of whole runs share: small runs of every model and method, and the
comparison of two run directories, byte for byte but for wall times.

SPDX-License-Identifier: GPL-3.0-or-later
"""
import csv
import json
import os
import shutil
import struct
import subprocess

# Discs that fall on an obstacle; friction, a phase that changes a key, and a gate that opens.
DISCS = """
model = "md";
until = 1.2;
box = (0.0, 0.0, 16.0, 12.0);
gravity = (0.0, -10.0);
grains = ({ radius = 0.4; restitution = 0.5; density = 1.0; friction = 0.3; });
placements = ({ region = (3.0, 2.0, 13.0, 11.0); jitter = 0.5; spacing = 1.1; });
obstacles = ({ shape = "disc"; center = (8.0, 1.0); radius = 0.7; });
phases = ({ time = 0.5; set = ("gravity=(1.0, -9.0)"); });
view = { size = (160, 120); };
output = { frames = 0.1; log = 0.05; maps = 0.4; checkpoint = 0.15; checkpoint_wall = 0.0; };
"""

# More grains than one strip of md has, so that threads share the loops and the list.
CROWD = """
model = "md";
until = 0.03;
box = (0.0, 0.0, 80.0, 80.0);
gravity = (0.0, -10.0);
grains = ({ radius = 0.5; restitution = 0.8; friction = 0.3; });
placements = ({ spacing = 1.05; temperature = 4.0; });
view = { size = (160, 160); range = (0.0, 5.0); };
output = { frames = 0.01; log = 0.005; maps = 0.0; checkpoint = 0.004; checkpoint_wall = 0.0; };
"""

_QUICK = ["--quick", "--size", "160x120", "-s", "output.checkpoint_wall=0"]
DISCS_FILE, CROWD_FILE = "discs.cfg", "crowd.cfg"

# Movies are bytes of ffmpeg, which makes the same of the same frames on any number of threads.
_FILM = ["-s", "output.movie=film.mp4"] if shutil.which("ffmpeg") else []

# name, scene, options.  Together they have every model and method, and every kind of output:
# frames coloured by the whole run and at once, dumps with contacts, maps, mean maps, screens,
# movies; trajectories by cases().
CASES = [
    ("md-linear-verlet", DISCS_FILE, _FILM),
    ("md-hertz-verlet", DISCS_FILE, ["-s", "md.force=hertz", "-s", "output.dump=true",
                                 "-s", "output.contacts=true", "-s", "view.forces=true"]),
    ("md-linear-gear", DISCS_FILE, ["-s", "md.integrator=gear", "-s", "view.range=(0, 5)"]),
    ("md-hertz-gear", DISCS_FILE, ["-s", "md.integrator=gear", "-s", "md.force=hertz", "-s",
                               "measure.average=(0.1, 1.1)", "-s", "output.maps=0.05"]),
    ("md-stream", "obstacle", [*_QUICK, "--model", "md", "--until", "0.004", "-s",
                               "output.frames=0.001", "-s", "output.checkpoint=0.0008"]),
    ("ed-tc", "cooling", [*_QUICK, "--model", "ed", "--until", "30", "-s", "output.checkpoint=4"]),
    ("ed-walls", DISCS_FILE, ["--model", "ed", "-s", "view.range=(0, 5)", "-s", "output.dump=true",
                              *_FILM]),
    ("ed-plain", "cooling", [*_QUICK, "--model", "ed", "--until", "20", "-s", "ed.t_c=0", "-s",
                             "output.checkpoint=3", "-s", "view.range_from=frame"]),
    ("dsmc-dense", "obstacle", [*_QUICK, "--model", "dsmc", "-s", "output.checkpoint=0.004",
                                "-s", "output.maps=0.001", "-s", "measure.average=(0.01, 0.03)"]),
    ("dsmc-plain", "cooling", [*_QUICK, "--model", "dsmc", "--method", "plain", "--until", "30",
                               "-s", "output.checkpoint=4", "-s", "view.map=density"]),
    ("dsmc-hsmc", "heap", [*_QUICK, "--model", "dsmc", "--method", "hsmc", "--until", "6", "-s",
                           "output.checkpoint=1", "-s", "output.maps=2"]),
    ("lga-gmlg", "hourglass", [*_QUICK, "--model", "lga", "--until", "0.15", "-s",
                               "output.checkpoint=0.02"]),
    ("lga-fhp2", "cooling", [*_QUICK, "--model", "lga", "--method", "fhp2", "--until", "20", "-s",
                             "output.checkpoint=3"]),
    ("lga-sandpile", "pile", [*_QUICK, "--model", "lga", "--method", "sandpile", "-s",
                              "output.dump=true"]),
    ("md-many", CROWD_FILE, []),
]


def has_hdf5(program):
    told = subprocess.run([program, "version", "--json"], capture_output=True, text=True,
                          check=True).stdout
    return "hdf5" in json.loads(told)


def cases(program):
    """CASES; where the program has HDF5, one of them with a trajectory."""
    if not has_hdf5(program):
        return CASES
    return [(name, scene, options + ["-s", "output.trajectory=0.05"])
            if name == "md-hertz-verlet" else (name, scene, options)
            for name, scene, options in CASES]


def write_scenes(folder):
    for name, text in ((DISCS_FILE, DISCS), (CROWD_FILE, CROWD)):
        with open(os.path.join(folder, name), "w", encoding="utf-8") as out:
            out.write(text)


def fnv(data):
    value = 14695981039346656037
    for byte in data:
        value = (value ^ byte) * 1099511628211 % 2**64
    return value


# What a checkpoint remembers of the clock, and the bytes of the log, which holds wall seconds.
_TIMES = {fnv(b"run.wall"), fnv(b"log.size")}
CHECKPOINT_HEADER = struct.Struct("<8sII24sQQQQQ")


def _checkpoint(data):
    """The turn, the scene's text and every record but those that tell of wall time."""
    fields = CHECKPOINT_HEADER.unpack_from(data)
    turn, scene_size = fields[4], fields[5]
    at = CHECKPOINT_HEADER.size + scene_size
    records = []
    while at < len(data):
        name, width, count = struct.unpack_from("<QQQ", data, at)
        size = (width * count + 7) // 8 * 8
        if name not in _TIMES:
            records.append((name, width, count, data[at + 24:at + 24 + size]))
        at += 24 + size
    return turn, data[CHECKPOINT_HEADER.size:CHECKPOINT_HEADER.size + scene_size], records


def _manifest(data):
    told = json.loads(data)
    for key in ("seconds", "written"):
        told.pop(key, None)
    return told


def _without(column, data):
    rows = list(csv.reader(data.decode().splitlines()))
    at = rows[0].index(column)
    return [row[:at] + row[at + 1:] for row in rows]


def _contents(path):
    with open(path, "rb") as file:
        data = file.read()
    name = os.path.basename(path)
    if name == "manifest.json":
        return _manifest(data)
    if name == "log.csv":
        return _without("wall_seconds", data)
    if name == "results.csv":
        return _without("run_seconds", data)
    return _checkpoint(data) if name.endswith(".checkpoint") else data


def files(run):
    return sorted(os.path.relpath(os.path.join(where, name), run)
                  for where, _, names in os.walk(run) for name in names)


def everything(run):
    """The contents of every file, but for wall times."""
    return {name: _contents(os.path.join(run, name)) for name in files(run)}


def differences(one, other):
    """The files that only one run has, or whose contents differ in more than wall times."""
    mine, its = set(files(one)), set(files(other))
    found = [name + " is in one only" for name in sorted(mine ^ its)]
    for name in sorted(mine & its):
        if _contents(os.path.join(one, name)) != _contents(os.path.join(other, name)):
            found.append(name + " differs")
    return found
