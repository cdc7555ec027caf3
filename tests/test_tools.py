"""test_tools.py - completion and manual pages know every command and option that the parser knows.

Called with the path of the binary; shells that are not installed are skipped, with the reason.

SPDX-License-Identifier: GPL-3.0-or-later
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import verdict

PROGRAM = os.path.abspath(sys.argv.pop(1))


def say(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=60,
                          check=True).stdout


COMMANDS = re.findall(r"^  ([a-z]+) ", say("help").split("\nTry:")[0], re.M)


class Tools(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="sandreel-tools-")
        self.addCleanup(shutil.rmtree, self.folder)

    def script(self, shell):
        if not shutil.which(shell):
            self.skipTest(f"{shell} is not installed")
        name = os.path.join(self.folder, "script")
        with open(name, "w", encoding="utf-8") as out:
            out.write(say("completion", shell))
        return name

    def run_shell(self, *arguments):
        done = subprocess.run(arguments, cwd=self.folder, capture_output=True, text=True,
                              timeout=60, check=False, env=dict(os.environ, HOME=self.folder))
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_bash_completes_commands_options_values_scenes_and_keys(self):
        script = self.script("bash")

        def complete(*words):
            line = " ".join(f"'{word}'" for word in words)
            return self.run_shell("bash", "-c", f". {script}; compopt() {{ :; }}; COMP_WORDS=({line});"
                                  f"COMP_CWORD={len(words) - 1}; _sandreel;"
                                  "printf '%s\\n' \"${COMPREPLY[@]}\"").split()
        self.assertEqual(sorted(complete("sandreel", "")), sorted(COMMANDS))
        self.assertEqual(complete("sandreel", "run", "--mod"), ["--model"])
        self.assertEqual(complete("sandreel", "run", "--model", "e"), ["ed"])
        self.assertEqual(complete("sandreel", "frame", "--color", "sp"),
                         ["speed", "spin", "species"])
        self.assertEqual(complete("sandreel", "export", "--to", "h5"), ["h5md"])
        self.assertEqual(complete("sandreel", "run", "hourgl"), ["hourglass"])
        self.assertEqual(complete("sandreel", "run", "-s", "grains.resti"), ["grains.restitution="])

    def test_fish_completes_commands_options_and_values(self):
        script = self.script("fish")

        def complete(line):
            told = self.run_shell("fish", "-c", f"source {script}; complete -C '{line}'")
            return [one.split("\t")[0] for one in told.splitlines()]
        self.assertEqual(complete("sandreel swe"), ["sweep"])
        self.assertEqual(complete("sandreel run --mod"), ["--model"])
        self.assertIn("lga", complete("sandreel run --model "))
        self.assertIn("hourglass", complete("sandreel run hourgl"))

    def test_zsh_takes_the_script_and_it_names_every_option(self):
        script = self.script("zsh")
        self.run_shell("zsh", "-n", script)
        with open(script, encoding="utf-8") as text:
            words = text.read()
        for command in COMMANDS:
            self.assertIn(f"'{command}:", words)
        self.assertIn("'--model[", words)
        told = self.run_shell("zsh", "-f", "-c", f"autoload -U compinit; compinit -u -D; . {script};"
                              "print $_comps[sandreel]")
        self.assertEqual(told.strip(), "_sandreel")

    def test_the_manual_pages_have_every_command_option_and_key(self):
        if not shutil.which("scdoc"):
            self.skipTest("scdoc is not installed")

        def page(*words):
            done = subprocess.run(["scdoc"], input=say("manual", *words), capture_output=True,
                                  text=True, timeout=60, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            return done.stdout.replace("\\-", "-").replace("\\_", "_")
        commands = page()
        for command in COMMANDS:
            self.assertTrue(f".SS sandreel {command}" in commands, command)
            for option in re.findall(r"(--[a-z-]+)", say("help", command).split("\n\n", 1)[1]):
                self.assertTrue(option in commands, option)
        keys = page("keys")
        for key in ("restitution", "trajectory", "collision_window"):
            self.assertTrue(f"\\fB{key}\\fR" in keys, key)


if __name__ == "__main__":
    verdict.run()
