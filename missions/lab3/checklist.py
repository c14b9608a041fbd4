"""What of the lab is in these records?  One line an item; exit code 1 where one is missing.

    python missions/lab3/checklist.py logs/*.mcap

The records of a student are taken together.  Each must be reproduced by `gcs log audit`: what is
looked at is what the gate decided, and not what somebody wrote into the file.
"""

import json
import subprocess
import sys
from itertools import pairwise

GCS = (sys.executable, "-m", "gcs")


def lines(*words):
    """The JSON lines that a gcs command prints."""
    ended = subprocess.run((*GCS, *words), capture_output=True, text=True, check=False)
    return [json.loads(line) for line in ended.stdout.splitlines() if line.startswith("{")]


def messages(record, topic):
    return [each["fields"] for each in lines("topic", "echo", topic, "--log", record, "--json")]


def found_in(record):
    """The items that this record shows."""
    audits = lines("log", "audit", record, "--json")
    if not (audits and audits[0]["good"] and audits[0]["ended"]):
        print(f"not counted: {record}: gcs log audit does not reproduce it")
        return {}
    log = [each["text"] for each in messages(record, "/log")]
    gate = messages(record, "/gate/decision")
    states = [each["state"] for each in messages(record, "/vehicle/1/fsa")]
    gotos = [each for each in gate if each["word"] == "goto"]
    verdicts = [each for each in gotos if each["phase"] == "verdict"]
    codes = [each.get("code", "") for each in verdicts]
    busy = [each["sentence"] for each in verdicts if each.get("code") == "BUSY"]
    reached = [each for each in gotos if each["outcome"] == "complete"]
    flown_to = [each["goal"] for each in verdicts if each["outcome"] == "accepted"]
    outside = [at for at in flown_to if max(abs(at["east_m"]), abs(at["north_m"])) > 5]
    keys = sum(text.startswith("Keyboard: ") for text in log)
    holds = [now for before, now in pairwise(states) if before == "MOVING"]
    shown = {
        "keyboard manager: keys change the pending goal, and send nothing": keys
        > log.count("Sending Position")
        > 0,
        "state machine: VERIFYING is entered and left": "Current State: VERIFYING" in log,
        "position tracking: a goal is reached": len(reached) > 0,
        "a second goal is reached after it": len(reached) > 1,
        "a goal outside the cage is refused": "OUTSIDE_FENCE" in codes,
        "a goal while MOVING is refused": any("MOVING" in each for each in busy),
        "a goal while a picture is taken is refused": any(
            "TAKING_PICTURE" in each for each in busy
        ),
        "with the cage off, the goal outside is flown": bool(outside),
        "an abort while MOVING leads to HOLDING": "HOLDING" in holds,
        "own rule: it refuses": "OWN_RULE" in codes,
        "own rule: it permits": any(text.endswith(".py permits") for text in log),
        "own node: a second program flies to a goal": any(
            each["source"] != "operator" for each in reached
        ),
    }
    return {item: bool(there) for item, there in shown.items()}


def main(records):
    if not records:
        raise SystemExit(__doc__)
    items = {}
    for record in records:
        for item, there in found_in(record).items():
            items[item] = items.get(item, False) or there
    for item, there in items.items():
        print(f"{'yes' if there else 'NO '}  {item}")
    print(f"{sum(items.values())} of {len(items)}")
    raise SystemExit(0 if items and all(items.values()) else 1)


if __name__ == "__main__":
    main(sys.argv[1:])
