#!/usr/bin/env python3
# test_live_terminal.py PROGRAM - live sessions in a terminal, which here is the other end of a pty.
#
# SPDX-License-Identifier: GPL-3.0-or-later
import fcntl
import os
import pty
import re
import select
import signal
import struct
import sys
import tempfile
import termios
import time

PROGRAM = os.path.abspath(sys.argv[1])
SKIPPED = 77

SCENE = """
until = 1000.0; box = [0.0, 0.0, 18.0, 18.0]; model = "md";
grains = ({ radius = 0.5; restitution = 1.0; stiffness = 10000.0; });
placements = ({ kind = "square"; spacing = 1.8; temperature = 1.0; });
view = { size = (160, 120); };
"""
ASKS = b"\x1b[c"
LEAVES = b"\x1b[?1049l"
PLAIN, SIXEL, KITTY = b"\x1b[?1;2c", b"\x1b[?62;4;6c", b"\x1b_Gi=31;OK\x1b\\\x1b[?62c"


class Terminal:
    """A program on a terminal of ours."""

    def __init__(self, answer=PLAIN, columns=80, rows=30):
        with open("scene.cfg", "w") as out:
            out.write(SCENE)
        self.child, self.line = pty.fork()
        if self.child == 0:
            os.environ["TERM"] = "xterm-256color"
            signal.signal(signal.SIGHUP, signal.SIG_DFL)    # ignored if the tests were by nohup
            os.execv(PROGRAM, [PROGRAM, "live", "scene.cfg", "-o", "run", "--force"])
        self.seen = b""
        self.modes = termios.tcgetattr(self.line)
        self.size(columns, rows)
        self.wait(ASKS)
        self.type(answer)

    def size(self, columns, rows):
        fcntl.ioctl(self.line, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))

    def type(self, text):
        os.write(self.line, text if isinstance(text, bytes) else text.encode())

    def read(self, seconds):
        """More of what is written there; False at its end."""
        if not select.select([self.line], [], [], seconds)[0]:
            return True
        try:
            more = os.read(self.line, 1 << 16)
        except OSError:
            return False
        self.seen += more
        return bool(more)

    def wait(self, what, seconds=60):
        """Until it has been written, then forgets everything up to there."""
        end = time.time() + seconds
        pattern = what if isinstance(what, re.Pattern) else re.compile(re.escape(what))
        while time.time() < end:
            found = pattern.search(self.seen)
            if found:
                self.seen = self.seen[found.end():]
                return found
            if not self.read(0.1):
                break
        raise AssertionError("never seen: %s in %r" % (pattern.pattern, self.seen[-600:]))

    def status(self):
        """What became of the program."""
        end = time.time() + 60
        while time.time() < end:
            self.read(0.05)
            done, status = os.waitpid(self.child, os.WNOHANG)
            if done:
                return status
        raise AssertionError("it does not end")

    def check_left(self):
        """The other screen is gone and the modes are as they were."""
        self.wait(LEAVES)
        end = time.time() + 20
        while termios.tcgetattr(self.line) != self.modes:
            assert time.time() < end, "the modes of the terminal are not as they were"
            time.sleep(0.02)

    def close(self):
        try:
            os.kill(self.child, signal.SIGKILL)
            os.waitpid(self.child, 0)
        except OSError:
            pass
        os.close(self.line)


def running(terminal):
    terminal.wait(re.compile(rb"at rest"))
    terminal.type(" ")
    terminal.wait(re.compile(rb"t = 0?[1-9.]\S* of 1000 .*running"))


def test_it_runs_and_leaves_the_terminal_as_it_was():
    terminal = Terminal()
    running(terminal)
    assert termios.tcgetattr(terminal.line) != terminal.modes
    terminal.type("q")
    terminal.check_left()
    assert terminal.status() == 0
    terminal.close()


def test_whatever_ends_it_the_terminal_is_set_right():
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGKILL, signal.SIGSEGV, signal.SIGHUP):
        terminal = Terminal()
        terminal.wait(b"at rest")
        os.kill(terminal.child, number)
        status = terminal.status()
        if number in (signal.SIGTERM, signal.SIGINT):
            assert os.WEXITSTATUS(status) == 128 + number, status
        else:
            assert os.WTERMSIG(status) == number, status
        terminal.check_left()
        terminal.close()


def test_commands_are_edited_completed_and_remembered():
    terminal = Terminal()
    terminal.wait(b"at rest")
    terminal.type(":set gravi")
    terminal.type("\t(0, -2)\r")
    time.sleep(0.3)
    terminal.type(":get gravity\r")
    terminal.wait(b"(0.0, -2.0)")
    terminal.type(":")
    time.sleep(0.3)
    terminal.type("\x1b[A\x1b[A")               # two lines up: the one that sets
    terminal.type("\x7f\x7f3)\r")               # -2) becomes -3)
    time.sleep(0.3)
    terminal.type(":get gravity\r")
    terminal.wait(b"(0.0, -3.0)")
    terminal.type(":get grai\t_o\t\r")         # grains, grains_in, grains_out, keys of grains
    terminal.wait(re.compile(rb"\x1b\[30;1H\x1b\[0m\x1b\[K0"))       # none has left
    terminal.type(":nonsense\r")
    terminal.wait(b"there is no command")
    terminal.type(":help\r")
    terminal.wait(b"any key")
    terminal.type("x")
    terminal.wait(b"expect EXPR")
    terminal.type("x")
    terminal.type(":qu\t\r")
    terminal.check_left()
    assert terminal.status() == 0
    terminal.close()


def test_pictures_are_what_the_terminal_says_it_can_show():
    for answer, mark in ((PLAIN, b"\x1b[38;"), (SIXEL, b"\x1bP"), (KITTY, b"\x1b_Ga=T,")):
        terminal = Terminal(answer)
        terminal.wait(mark)
        terminal.type("q")
        terminal.check_left()
        terminal.close()


def test_it_follows_the_size_of_the_window():
    terminal = Terminal(columns=80, rows=30)
    terminal.wait(b"\x1b[28;1H")                # the first line of three
    terminal.size(60, 20)
    terminal.wait(b"\x1b[18;1H")
    terminal.type("q")
    terminal.check_left()
    terminal.close()


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        probe = os.popen("'%s' version" % PROGRAM).read()
        if "chafa" not in probe:
            print("skipped: built without libchafa or libedit")
            sys.exit(SKIPPED)
        only = sys.argv[2:]
        for name, test in list(globals().items()):
            if name.startswith("test_") and (not only or name in only):
                test()
                print("ok", name, flush=True)
