"""Counts what the last test runs of the given build folders said: cmocka's sentences one by one,
other tests as one each.  Prints what was skipped and why, then `N passed, N failed`."""
import json
import re
import sys

passed = failed = 0
skipped = []
for folder in sys.argv[1:]:
    with open(folder + "/meson-logs/testlog.json", encoding="utf-8") as log:
        for line in log:
            test = json.loads(line)
            text = (test.get("stdout") or "") + (test.get("stderr") or "")
            skipped += re.findall(r"^skipped .*", text, re.M)
            good = sum(map(int, re.findall(r"PASSED\s+\] (\d+) test", text)))
            bad = sum(map(int, re.findall(r"FAILED\s+\] (\d+) test", text)))
            ended_well = test["result"] in ("OK", "EXPECTEDFAIL", "SKIP")
            if ended_well and good == 0 and test["result"] != "SKIP":
                good = 1
            if not ended_well and bad == 0:
                bad = 1
            passed += good
            failed += bad
for line in dict.fromkeys(skipped):
    print(line)
print(f"{passed} passed, {failed} failed")
