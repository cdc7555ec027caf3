"""verdict.py - runs the tests of the program that imports it, and says how many passed in the words
of cmocka, which tests/count.py adds up.

SPDX-License-Identifier: GPL-3.0-or-later
"""
import sys
import unittest


def run():
    result = unittest.main(exit=False, verbosity=1).result
    failed = len(result.failures) + len(result.errors)
    for test, reason in result.skipped:
        print(f"skipped {test.id().rsplit('.', 1)[-1]}: {reason}")
    print(f"[  PASSED  ] {result.testsRun - failed - len(result.skipped)} test(s).")
    if failed:
        print(f"[  FAILED  ] {failed} test(s).")
    sys.exit(1 if failed else 0)
