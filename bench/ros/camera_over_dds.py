#!/usr/bin/env python3
"""From a camera to a force: over DDS from another process, beside the same camera in palpate's own, in turns.

    unshare -rn bench/ros/camera_over_dds.py PALPATE CAMERA_NODE [--pairs N] [--seconds S] [--camera NAME]

Prints how old the surface is when it can be felt, what a servo's step computes, what frames became, and how much
memory palpate has after a fifth of the run and at its end (MB): medians of the pairs and all values. In a network
namespace of its own.
"""

import argparse
import json
import pathlib
import statistics
import subprocess
import tempfile
import time

TOPIC = "/camera/depth/image_rect_raw"


def resident(pid):
    pages = int(pathlib.Path(f"/proc/{pid}/statm").read_text(encoding="ascii").split()[1])
    return pages * 4096 / 1e6


def touch(arguments, source, folder):
    report = folder / "report.json"
    with subprocess.Popen([arguments.palpate, "touch", source, "--no-view", "--duration", str(arguments.seconds), "--json", report],
                          stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as run:
        memory = []
        while run.poll() is None:
            time.sleep(1)
            if run.poll() is None:
                memory.append(resident(run.pid))
    found = json.loads(report.read_text(encoding="utf-8"))
    camera = found["sources"][0]
    return {**{f"age {at}, ms": 1e3 * camera["latency_s"][at] for at in ("p50", "p99", "max")},
            **{f"step {at}, us": found["computing_us"][at] for at in ("p50", "p99", "p99.9", "max")},
            "contact, %": 100 * found["contact_share"],
            "frames": camera["frames"], "felt": camera["frames_touchable"], "dropped, told": sum(camera["drops"].values()),
            "stalls": camera["stalls"],
            "memory early": memory[len(memory) // 5], "memory late": memory[-1]}


def touch_node(arguments, folder):
    with subprocess.Popen([arguments.camera_node, arguments.camera.removeprefix("camera:"), TOPIC, str(arguments.seconds + 4), "16UC1"],
                          stdout=subprocess.PIPE, text=True) as node:
        time.sleep(0.5)
        found = touch(arguments, f"ros:{TOPIC}", folder)
        found["sent while it listened"] = int(node.communicate()[0].split()[3])
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("palpate")
    parser.add_argument("camera_node")
    parser.add_argument("--pairs", type=int, default=6)
    parser.add_argument("--seconds", type=float, default=15)
    parser.add_argument("--camera", default="camera:simulated:still,loop=30")
    arguments = parser.parse_args()
    subprocess.run(["ip", "link", "set", "lo", "up"], check=True)
    own, node = [], []
    with tempfile.TemporaryDirectory() as folder:
        for i in range(arguments.pairs):
            for in_process in (i % 2 == 0, i % 2 != 0):
                if in_process:
                    own.append(touch(arguments, arguments.camera, pathlib.Path(folder)))
                else:
                    node.append(touch_node(arguments, pathlib.Path(folder)))
    print("| | in process | over DDS |\n|---|---|---|")
    for name in node[0]:
        cells = []
        for runs in (own, node):
            values = [run[name] for run in runs if name in run]
            cells.append(f"{statistics.median(values):.4g} ({', '.join(f'{value:.4g}' for value in values)})" if values else "")
        print(f"| {name} | {' | '.join(cells)} |")


if __name__ == "__main__":
    main()
