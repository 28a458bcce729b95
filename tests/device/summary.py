# SPDX-License-Identifier: MIT
"""Prints the table of a run of the rig and ends with its status: summary.py LOG SECONDS."""
import re
import sys

log_path, host_seconds = sys.argv[1], sys.argv[2]
with open(log_path, encoding="utf-8", errors="replace") as log_file:
    log = log_file.read()

announced = re.search(r"Running (\d+) tests?", log)
results = re.findall(r"^\[ +(OK|FAILED|SKIPPED) +\] (\S+?)(?:, where .*)? \((\d+) ms\)", log, re.M)


def words(name):
    """"Vivid/DeviceRate.NoGap/YUYV_640x480" -> "No gap (YUYV 640x480)"."""
    parts = name.split(".", 1)[1].split("/")
    sentence = re.sub(r"(?<=[a-z])(?=[A-Z])|(?<=A)(?=[A-Z][a-z])", " ", parts[0]).capitalize()
    return sentence + (f" ({parts[1].replace('_', ' ')})" if len(parts) > 1 else "")


width = max((len(words(name)) for _, name, _ in results), default=20)
print(f"\n{'check':{width}}  {'result':8}  rig's time")
rig_seconds = 0.0
for outcome, name, milliseconds in results:
    rig_seconds += int(milliseconds) / 1000
    result = {"OK": "passed", "FAILED": "FAILED", "SKIPPED": "skipped"}[outcome]
    print(f"{words(name):{width}}  {result:8}  {int(milliseconds) / 1000:7.2f} s")

passed = sum(outcome == "OK" for outcome, _, _ in results)
expected = int(announced.group(1)) if announced else 0
complete = "rig: device tests ended with status 0" in log
print(f"\n{passed} of {expected} checks passed: {rig_seconds:.0f} s of the rig's time, {host_seconds} s of this machine's")
if not complete or passed == 0 or passed != expected:
    sys.exit(f"scripts/test-v4l2: not every check passed; {log_path} tells why")
