"""A robot in another process follows the proxy on a ball: robot.py PALPATE ROBOT_NODE SEED [SECONDS [BOX]].

BOX is a tool such as 20x30x10. The target, and all of that tool there, is never more than 0.1 mm inside the ball, and it stops when palpate has ended; palpate's report
tells of as many targets or more. Run in a network namespace of its own (unshare -rn).
"""

import json
import re
import subprocess
import sys

from matrix import network

DEEPEST = 0.1  # mm
FARTHEST = 5   # mm, after the last target: what is left of a lag of 50 ms


def main():
    palpate, robot_node, seed = sys.argv[1:4]
    seconds = int(sys.argv[4]) if len(sys.argv) > 4 else 10
    box = sys.argv[5] if len(sys.argv) > 5 else ""
    try:
        network(False)
    except (subprocess.CalledProcessError, FileNotFoundError):
        print("no network namespace can be set up here")
        sys.exit(77)
    robot = subprocess.Popen([robot_node, str(seconds + 6), *box.split("x") * bool(box)], stdout=subprocess.PIPE, text=True)
    run = subprocess.run([palpate, "touch", "synthetic:sphere", "--device", "simulated", "--robot", "crisp", "--no-view",
                          "--duration", str(seconds), "--seed", seed, "--json", "-", *["--tool", "box:" + box] * bool(box)], capture_output=True, text=True)
    told = robot.communicate()[0]
    print(told, run.stderr if run.returncode else "")
    count, depth, after = re.search(r"^(\d+) targets; target at most (\S+) mm deep, .*; (\S+) mm after", told).groups()
    report = json.loads(run.stdout)["robot"] if run.returncode == 0 else {"told": 0}
    good = int(count) <= report["told"] <= 250 * seconds + 10 and int(count) > 100 * seconds and float(depth) <= DEEPEST and float(after) < FARTHEST
    sys.exit(not good)


if __name__ == "__main__":
    main()
