"""A camera or a hand on one machine, palpate on another: two_machines.py PALPATE FOLDER [SECONDS].

Two network namespaces stand for the machines; slow_link between them delays packets and loses some. FOLDER has the programs of tests/dds.
Prints what crosses and what arrives, as tables. Without SECONDS it is a short test. Run in a network namespace of its own (unshare -rn).
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

from matrix import network

TOPIC = "/camera/depth/image_rect_raw"
SUBNET = {**os.environ, "ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"}


class Machines:
    """This namespace is palpate's machine, 10.77.1.1; the other's is 10.77.1.2."""

    def __init__(self, slow_link):
        self.slow_link = slow_link
        network(False)
        self.namespaces = [subprocess.Popen(["unshare", "-n", "sleep", "infinity"]) for _ in range(2)]
        time.sleep(0.2)
        between, other = self.namespaces
        for name, owner, address in (("one", None, "10.77.1.1"), ("two", other, "10.77.1.2")):
            self.call("ip", "link", "add", name, "type", "veth", "peer", "name", f"{name}s")
            self.call("ip", "link", "set", f"{name}s", "netns", str(between.pid))
            self.call("ip", "link", "set", f"{name}s", "up", inside=between)
            if owner:
                self.call("ip", "link", "set", name, "netns", str(owner.pid))
            self.call("ip", "addr", "add", f"{address}/24", "dev", name, inside=owner)
            self.call("ip", "link", "set", name, "up", inside=owner)
            self.call("ip", "route", "add", "default", "dev", name, inside=owner)
        self.call("ip", "link", "set", "lo", "up", inside=other)
        # Of datagrams that lost a piece the others would fill the kernel's memory for 30 s.
        pathlib.Path("/proc/sys/net/ipv4/ipfrag_time").write_text("3", encoding="ascii")

    def call(self, *command, inside=None):
        subprocess.run([*self.enter(inside), *command], check=True)

    def enter(self, process):
        return ["nsenter", "-t", str(process.pid), "-n"] if process else []

    def link(self, delay, loss):
        return subprocess.Popen([*self.enter(self.namespaces[0]), self.slow_link, "ones", "twos", str(delay), str(loss), "1"])

    def other(self, *command):
        """A program on the other machine."""
        return subprocess.Popen([*self.enter(self.namespaces[1]), *map(str, command)], env=SUBNET, stdout=subprocess.PIPE, text=True)

    def close(self):
        for process in self.namespaces:
            process.kill()
            process.wait()


def traffic():
    """Bytes and packets that have come and gone over palpate's link."""
    lines = pathlib.Path("/proc/self/net/dev").read_text(encoding="ascii").splitlines()
    values = list(map(int, next(line for line in lines if "one:" in line).split(":")[1].split()))
    return values[0] + values[8], values[1] + values[9]


def stopped(process):
    process.kill()
    process.wait()


def camera(machines, palpate, folder, kind, delay, loss, seconds):
    link = machines.link(delay, loss)
    node = machines.other(folder / "camera_node", "simulated:still,loop=30", TOPIC, seconds + 4, kind)
    time.sleep(1)
    before, begun = traffic(), time.monotonic()
    with tempfile.TemporaryDirectory() as place:
        report = pathlib.Path(place) / "report.json"
        run = subprocess.run([palpate, "touch", f"ros:{TOPIC}", "--no-view", "--duration", str(seconds), "--json", report], env=SUBNET,
                             capture_output=True, text=True)
        found = json.loads(report.read_text(encoding="utf-8")) if report.exists() else None
    after, lasted = traffic(), time.monotonic() - begun
    sent = int(node.communicate()[0].split()[3])
    stopped(link)
    if found is None:
        return {"failed": run.stderr[-300:]}
    source = found["sources"][0]
    return {"MB/s": (after[0] - before[0]) / 1e6 / lasted, "packets/s": (after[1] - before[1]) / lasted, "sent": sent,
            "arrived": source["frames"], "told lost": source["drops"]["garbage"], "age p50, ms": 1e3 * source["latency_s"]["p50"],
            "p99": 1e3 * source["latency_s"]["p99"], "contact, %": 100 * found["contact_share"]}


def hand(machines, folder, rate, delay, loss, factor, seconds):
    link = machines.link(delay, loss)
    node = machines.other(folder / "hand_node", rate, 0, seconds + 1, 1)
    time.sleep(0.5)
    before, begun = traffic(), time.monotonic()
    told = subprocess.run([folder / "wall_over_dds", str(seconds), str(factor)], env={**SUBNET, "DAMPING": "1"}, capture_output=True, text=True)
    after, lasted = traffic(), time.monotonic() - begun
    moved = float(re.search(r"moved ([\d.]+) mm", node.communicate()[0])[1])
    stopped(link)
    found = re.search(r"delay ([\d.]+) ms, stiffness (\d+)", told.stdout)
    return {"MB/s": (after[0] - before[0]) / 1e6 / lasted, "packets/s": (after[1] - before[1]) / lasted,
            "delay told, ms": float(found[1]) if found else told.stderr[-200:], "stiffness, N/m": float(found[2]) if found else 0, "moved, mm": moved}


def table(rows):
    names = list(rows[0][1])
    print("| | " + " | ".join(names) + " |\n|---|" + "---|" * len(names))
    for title, row in rows:
        print(f"| {title} | " + " | ".join(f"{value:.4g}" if isinstance(value, float) else str(value) for value in row.values()) + " |", flush=True)


def main():
    palpate, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    seconds = int(sys.argv[3]) if len(sys.argv) > 3 else 0
    try:
        machines = Machines(folder / "slow_link")
    except (subprocess.CalledProcessError, OSError, StopIteration) as error:
        print("no network namespaces can be set up here:", error)
        sys.exit(77)
    try:
        if seconds == 0:
            seen = camera(machines, palpate, folder, "compressed", 1, 0, 6)
            print(seen)
            sys.exit("failed" in seen or seen["arrived"] < 60 or seen["contact, %"] < 5)
        links = ((0, 0), (1, 0), (5, 0), (20, 0), (1, 0.01), (1, 0.1), (1, 1))
        table([(f"{kind}, {delay} ms, {loss} % lost", camera(machines, palpate, folder, kind, delay, loss, seconds))
               for kind in ("32FC1", "16UC1", "compressed") for delay, loss in links])
        table([(f"{rate} Hz, {delay} ms, {loss} % lost, factor {factor}", hand(machines, folder, rate, delay, loss, factor, 13))
               for rate, delay, loss, factor in ((1000, 0, 0, 0.8), (1000, 0, 0, 1.6), (1000, 1, 0, 0.8), (1000, 1, 0, 1.6), (1000, 5, 0, 0.8),
                                                 (1000, 5, 0, 1.6), (1000, 1, 1, 0.8), (500, 1, 0, 0.8))])
    finally:
        machines.close()


if __name__ == "__main__":
    main()
