#!/usr/bin/env python3
# test_live.py PROGRAM - live sessions without a terminal: commands, log, replay.
#
# SPDX-License-Identifier: GPL-3.0-or-later
"""Each test is a sentence about a session; the references are what `frame`, `run` and `replay`
make of the same scene."""
import csv
import json
import os
import re
import subprocess
import sys
import tempfile

PROGRAM = os.path.abspath(sys.argv[1])

# A gas under gravity that every grain-following model computes in no time; two seconds of it.
SCENE = """
until = 2.0; box = [0.0, 0.0, 18.0, 18.0]; gravity = (0.0, -1.0);
grains = ({ radius = 0.5; restitution = 0.9; stiffness = 10000.0; });
placements = ({ kind = "square"; region = [0.0, 4.0, 18.0, 18.0]; spacing = 1.8;
                temperature = 1.0; });
walls = ({ shape = "segment"; points = ((0.0, 3.0), (9.0, 3.0)); opens = 1.5; },
         { shape = "segment"; points = ((9.0, 3.0), (18.0, 3.0)); });
view = { size = (320, 240); };
output = { frames = 0.1; frame_rate = 10.0; };
%s
"""
ED = SCENE % 'model = "ed"; ed = { t_c = 0.001; };'
MODELS = {"md": SCENE % 'model = "md";', "ed": ED, "dsmc": SCENE % 'model = "dsmc";'}
# Lattices cannot be pushed.
STEERABLE = dict(MODELS, lga=SCENE % 'model = "lga";')


def sandreel(*arguments, code=0):
    done = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=300)
    if done.returncode != code:
        raise AssertionError("%s: exit %d, not %d\n%s%s" % (" ".join(arguments), done.returncode,
                                                           code, done.stdout, done.stderr))
    return done


def write(name, text):
    with open(name, "w") as out:
        out.write(text)
    return name


def read(name):
    with open(name, "rb") as data:
        return data.read()


def live(folder, commands, scene=SCENE % "", code=0, options=()):
    write("scene.cfg", scene)
    write("commands", commands)
    return sandreel("live", "scene.cfg", "--commands", "commands", "-o", folder, "--force",
                    *options, code=code)


def end_of(folder):
    words = read(folder + "/session.log").decode().splitlines()[-1].split()
    assert words[:2] == ["#", "end"], words
    return float(words[2]), int(words[3]), words[4]


def test_a_saved_picture_is_the_one_that_frame_makes():
    for model, scene in MODELS.items():
        live("a", "go until 0.5\nframe p\ncolor spin\nmap density\nzoom 2 2 12 12\nframe q\n",
             scene)
        sandreel("frame", "scene.cfg", "-t", "0.5", "-o", "p.png", "--progress", "none", "--force")
        sandreel("frame", "scene.cfg", "-t", "0.5", "-o", "q.png", "--progress", "none", "--force",
                 "--color", "spin", "--map", "density", "--zoom", "2,2,12,12")
        assert read("p.png") == read("a/p.png"), model
        assert read("q.png") == read("a/q.png"), model
        assert read("p.png") != read("q.png"), model


def test_watching_changes_nothing():
    for model, scene in MODELS.items():
        live("a", "go until 1\n", scene)
        live("b", "go until 0.2\nframe p\nstep 7\nget energy\ninspect 5 5\ngo until 0.7\n"
             "color spin\nzoom 2\nmovie m.gif start\npause\ngo until 1\nmovie stop\n", scene)
        assert end_of("a") == end_of("b"), (model, end_of("a"), end_of("b"))


STEERED = """go until 0.25
set gravity (2, -9)
frame one
step 5
push 4 5 3 2 2
push 12 5 -3 2
go until 0.5
gate open
tilt 10
pour 6
set grains.restitution 0.5
go until 0.8
gate open 1
go until 1.2
back
step
follow 3
pan 0.1 0.1
frame two
movie film.gif start
go until 1.5
movie film.gif stop
checkpoint state
expect grains > 1
"""


def steered(model):
    return STEERED if model != "lga" else re.sub("(?m)^(push|step).*\n", "", STEERED)


def test_a_session_repeats_bit_for_bit():
    for model, scene in STEERABLE.items():
        live("a", steered(model), scene)
        done = sandreel("replay", "a", "-o", "b", "--force")
        assert "same last state" in done.stderr, done.stderr
        for name in ("session.log", "scene.cfg", "one.png", "two.png", "film.gif",
                     "state.checkpoint"):
            assert read("a/" + name) == read("b/" + name), (model, name)


def test_the_scene_of_a_session_runs_to_the_same_state():
    for model, scene in STEERABLE.items():
        live("a", steered(model), scene)
        time, _, digest = end_of("a")
        sandreel("run", "a/scene.cfg", "-o", "b", "--force", "--until", repr(time),
                 "--progress", "none")
        made = json.loads(read("b/manifest.json"))["state_digest"]
        assert made == digest, (model, made, digest)


def logged(folder):
    """The rows of log.csv by their columns, without the seconds, which are each session's own."""
    with open(folder + "/log.csv") as text:
        rows = list(csv.DictReader(line for line in text if line[0] != "#"))
    for row in rows:
        del row["wall_seconds"]
    return rows


def test_a_session_logs_what_the_run_of_its_scene_logs():
    for model, scene in STEERABLE.items():
        scene = scene.replace("output = { ", "output = { log = 0.04; ")
        live("a", steered(model), scene)
        time, _, _ = end_of("a")
        sandreel("run", "a/scene.cfg", "-o", "b", "--force", "--until", repr(time), "--progress",
                 "none", "-s", "output.frames=0")
        session, run = logged("a"), logged("b")
        assert len(session) == int(time / 0.04 + 1e-9) + 1, (model, len(session))
        assert session == run, (model, [pair for pair in zip(session, run) if pair[0] != pair[1]])
        sandreel("replay", "a", "-o", "b", "--force")
        assert logged("b") == session, model


def test_the_log_of_a_session_follows_it_back_and_beyond_the_end():
    scene = ED.replace("output = { ", "output = { log = 0.1; ")
    live("a", "go until 1\n", scene)
    live("b", "go until 0.73\nset gravity (3, 3)\ngo until 0.9\nback 0.42\ngo until 1\n", scene)
    assert logged("a") == logged("b") and len(logged("a")) == 11
    live("b", "set gravity (3, 3)\ngo until 0.9\nreset\ngo until 1\n", scene)
    assert logged("a") == logged("b")
    live("b", "go\ngo until 2.25\n", scene)
    assert [float(row["time"]) for row in logged("b")][-3:] == [2.0, 2.1, 2.2]
    # From a checkpoint on, the first row is the first that is due.
    write("scene.cfg", scene)
    sandreel("run", "scene.cfg", "-o", "r", "--force", "--until", "0.55", "--progress", "none",
             "-s", "output.checkpoint=0.5", "-s", "output.frames=0")
    write("commands", "go until 1\n")
    sandreel("live", "r", "--commands", "commands", "-o", "b", "--force")
    start = [row["time"] for row in logged("b")].index(logged("a")[6]["time"])
    assert logged("b")[start:] == logged("a")[6:]


def test_a_changed_log_is_noticed():
    live("a", "go until 0.25\nset gravity (2, -9)\ngo until 0.5\n")
    log = read("a/session.log").decode()
    write("a/session.log", log.replace("(2, -9)", "(2, -8)"))
    done = sandreel("replay", "a", "-o", "b", "--force", code=4)
    assert "another state" in done.stderr
    write("a/session.log", log[:log.index("# end")])
    done = sandreel("replay", "a", "-o", "b", "--force")
    assert "cut off" in done.stderr


def test_steering_does_what_it_says():
    done = live("a", """go until 0.2
get momentum_x
set gravity (5, 0)
get gravity
go until 0.3
get momentum_x
tilt 90
get gravity
pour 3
go until 1.4
get grains_in
set grains.[0].restitution 0.25
get grains.restitution
get view.color
color spin
get view.color
""")
    lines = done.stdout.splitlines()
    mass = 3.14159265 * 0.25
    grains = json.loads(read("a/manifest.json"))  # the run's own count is in the log
    assert grains["status"] == "done"
    count = round(float(live("b", "get grains\n").stdout.splitlines()[0]))
    # 5 along x for 0.1 s; what walls and their contacts take in that time is less than a tenth.
    gained = float(lines[2]) - float(lines[0])
    assert abs(gained - count * mass * 0.5) < 0.1 * count * mass * 0.5, (gained, count)
    assert lines[1] == "(5.0, 0.0)", lines[1]
    gx, gy = [float(word) for word in lines[3].strip("()").split(",")]
    assert abs(gx - 5) < 1e-12 and abs(gy) < 1e-12
    assert lines[4] in ("1", "2", "3") and lines[5] == "0.25", lines
    assert lines[6] == '"speed"' and lines[7] == '"spin"'


def test_gates_open_and_close():
    # What lies below the plates: nothing before the gate opens, something afterwards.
    done = live("a", "go until 1\ninspect 4 0\ngate open\ngo until 2\ninspect 4 0\n")
    before, after = [json.loads(line)["y"] for line in done.stdout.splitlines()[:2]]
    assert before > 3 and after < 3, (before, after)
    done = live("a", "go until 1\ngate open\ngate close\ngo until 2\ninspect 4 0\n")
    assert json.loads(done.stdout.splitlines()[0])["y"] > 3


def test_back_and_reset_forget_changes():
    live("a", "go until 1\n")
    live("b", "go until 0.5\nset gravity (3, 3)\ngo until 0.7\nback 0.4\ngo until 1\n")
    assert end_of("a") == end_of("b")
    live("b", "set gravity (3, 3)\ngo until 0.7\nreset\ngo until 1\n")
    assert end_of("a") == end_of("b")
    live("b", "set gravity (3, 3)\ngo until 1\n")
    assert end_of("a") != end_of("b")
    live("c", "go until 1\n", options=("-s", "gravity=(3, 3)"))
    assert end_of("b") == end_of("c")


def test_a_session_goes_on_from_a_run():
    write("scene.cfg", SCENE % "")
    sandreel("run", "scene.cfg", "-o", "r", "--force", "--until", "0.5", "--progress", "none",
             "-s", "output.checkpoint=0.25")
    write("commands", "get time\ngo until 0.6\nset gravity (1, 1)\ngo until 0.8\n")
    done = sandreel("live", "r", "--commands", "commands", "-o", "a", "--force")
    assert abs(float(done.stdout.splitlines()[0]) - 0.5) < 0.01
    assert "same last state" in sandreel("replay", "a", "-o", "b", "--force").stderr
    # The next session in that folder begins at time 0 again, and so does its repetition.
    live("a", "go until 0.1\nset gravity (1, 1)\ngo until 0.2\n")
    assert "same last state" in sandreel("replay", "a", "-o", "b", "--force").stderr


def test_what_cannot_be_is_refused_and_changes_nothing():
    for command, words in {
            "set grains.[0].restituton 1": "did you mean",
            "set grains.[0].restitution 3": "must be 0 to 1",
            "set box [0, 0, 1, 1]": "cannot change 'box'",
            "set view.color blue": "one of", "map nothing": "no map 'nothing'",
            "color blue": "one of", "zoom 0": "greater than 0", "gate open 7": "no such wall",
            "frame ../x": "plain name", "checkpoint .x": "plain name",
            "movie x.txt start": ".mp4", "movie stop": "no film", "inspect 99999": "no grain",
            "get nothing": "no key or total", "go until 0.1": "already", "step 0.5": "whole",
            "pour 0": "whole", "push 1 1 1 1 -1": "radius", "expect grains": "does not hold",
            "expect 1 +": "missing", "speed -1": "greater than 0", "nonsense": "no command",
            "help nonsense": "no command"}.items():
        verdict = 4 if command == "expect grains" else None
        write("scene.cfg", SCENE % "")
        write("commands", "go until 0.2\n%s\n" % command)
        done = subprocess.run([PROGRAM, "live", "scene.cfg", "--commands", "commands", "-o", "a",
                               "--force"], capture_output=True, text=True, timeout=300)
        assert done.returncode != 0, command
        assert verdict is None or done.returncode == verdict
        assert words in done.stderr, (command, done.stderr)
        assert verdict or "commands:2:" in done.stderr, (command, done.stderr)
        assert end_of("a") == PLAIN, command
    assert not os.path.exists("x.png")


EVERY = """help zoom
speed max
go until 0.2
pause
step 3
get time
set gravity (1, -2)
color spin
map density
zoom 2
pan 0.1 0
follow 5
fit
inspect 5
push 9 9 1 0
gate open
tilt 5
pour 2
go until 0.6
frame p
movie f.gif start
go until 0.7
movie stop
checkpoint state
back
expect grains >= 70
reset
quit
get nonsense
"""


def test_every_command_of_the_grammar_is_carried_out():
    verbs = re.findall(r"^([a-z]+)\b", live("a", "help\n").stdout, re.M)
    said = {line.split()[0] for line in EVERY.splitlines()}
    assert len(verbs) > 20 and not set(verbs) - said - {"a"}, set(verbs) - said
    done = live("a", EVERY)
    assert "zoom FACTOR" in done.stdout, done
    for name in ("p.png", "f.gif", "state.checkpoint", "log.csv"):
        assert (name == "log.csv") != os.path.exists("a/" + name), name
    assert end_of("a")[:2] == (0, 0)            # `reset`, and nothing after `quit`
    sandreel("replay", "a", "-o", "b", "--force")
    assert read("a/p.png") == read("b/p.png")


def test_expectations_are_counted():
    done = live("a", "expect grains < 0\nexpect 1 < 2\nexpect grains < 1\n", code=4)
    assert "2 of 3 expectations" in done.stderr, done.stderr


def test_the_page_of_the_manual_lists_the_commands():
    help_lines = live("a", "help\n").stdout.splitlines()[:-1]
    told = [(usage, doc.strip()) for usage, doc in zip(help_lines[::2], help_lines[1::2])]
    with open(os.path.join(os.environ["SOURCE_ROOT"], "docs", "live.md")) as page:
        written = re.findall(r"(?m)^\| `(.*)` \| (.*) \|$", page.read())
    written = [(usage.replace("\\|", "|"), doc) for usage, doc in written]
    assert len(told) > 20
    for row in told:
        assert row in written, row


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        live("a", "go until 0.2\n")
        PLAIN = end_of("a")
        only = sys.argv[2:]
        for name, test in list(globals().items()):
            if name.startswith("test_") and (not only or name in only):
                test()
                print("ok", name, flush=True)
