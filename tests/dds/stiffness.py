"""Is the delay of a device that another process owns measured right? stiffness.py HAND_NODE WALL_OVER_DDS.

A simulated device at 500 Hz and 1 kHz sends its poses 1 and 3 ms late, and its forces act as much later. With the stiffness that palpate chooses for the delay that it
measures (0.8 of Colgate and Schenkel's condition) the wall is stable; with twice that it is not. Run in a network namespace of its own
(unshare -rn), on an idle machine: this is about real time.
"""

import itertools
import os
import re
import subprocess
import sys

from matrix import network

DAMPING = 1  # of the device, N s/m
STABLE, UNSTABLE = 1, 5  # mm


def moved(hand_node, wall, rate, delay, factor):
    node = subprocess.Popen([hand_node, str(rate), str(delay), "14", str(DAMPING)], stdout=subprocess.PIPE, text=True)
    told = subprocess.run([wall, "13", str(factor)], env={**os.environ, "DAMPING": str(DAMPING)}, capture_output=True,
                          text=True, timeout=60)
    output = node.communicate(timeout=60)[0]
    print(f"{rate} Hz, {delay} ms late, factor {factor}: {told.stdout.splitlines()[:1]} {output.strip()}", flush=True)
    return [float(mm) for mm in re.findall(r"([\d.]+) mm", output)]


def main():
    try:
        network(False)
    except (subprocess.CalledProcessError, FileNotFoundError):
        print("no network namespace can be set up here")
        sys.exit(77)
    wrong = 0
    for rate, delay in itertools.product((1000, 500), (1, 3)):
        wrong += moved(*sys.argv[1:3], rate, delay, 0.8)[1] > STABLE
        wrong += moved(*sys.argv[1:3], rate, delay, 1.6)[0] < UNSTABLE
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
