"""What palpate tells of its topics on the wire, as tshark sees it: wire.py PRINT_TYPES PALPATE_PEER.

Every topic's name, type, reliability and type hash are as they have to be, no description of types is sent, and nothing leaves
the machine. Run in a network namespace of its own (unshare -rn). Exits 77 where there is no tshark or no namespace.
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

from matrix import network, start

RELIABLE = "0x00000002"
TYPE_INFORMATION = "rtps.param.id == 0x0075"


def rows(capture, shown, fields):
    """The fields of what a capture shows; a packet that tells of several topics gives a row for each."""
    command = ["tshark", "-r", capture, "-Y", shown, "-T", "fields", "-E", "separator=|"]
    for field in fields:
        command += ["-e", field]
    output = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    return {row for line in output.splitlines() for row in zip(*(field.split(",") for field in line.split("|")))}


def wait_for_captures(paths):
    """Until each file has its header, which tshark writes once it listens."""
    given_up = time.monotonic() + 60
    while not all(os.path.exists(path) and os.path.getsize(path) for path in paths):
        if time.monotonic() > given_up:
            sys.exit("tshark did not begin to capture within 60 s")
        time.sleep(0.05)


def capture_run(folder, lines, peer):
    """Captures of loopback and of what leaves through the link."""
    paths = {name: str(pathlib.Path(folder) / (name + ".pcap")) for name in ("lo", "link0")}
    sharks = [subprocess.Popen(["tshark", "-q", "-i", name, "-w", path], stderr=subprocess.DEVNULL)
              for name, path in paths.items()]
    wait_for_captures(paths.values())
    reader = start(peer, "read", "reliable", {}, lines)
    writer = start(peer, "write", "reliable", {}, lines)
    reader.stdout.read()
    time.sleep(1)
    for process in (writer, reader, *sharks):
        process.terminate()
        process.wait()
    return paths["lo"], paths["link0"]


def main():
    print_types, peer = sys.argv[1:3]
    if not shutil.which("tshark"):
        print("tshark is not installed")
        sys.exit(77)
    try:
        network(True)
    except (subprocess.CalledProcessError, FileNotFoundError):
        print("no network namespace can be set up here")
        sys.exit(77)
    os.environ.pop("ROS_AUTOMATIC_DISCOVERY_RANGE", None)
    text = subprocess.run([print_types], check=True, capture_output=True, text=True).stdout
    lines = "".join(line + "\n" for line in text.splitlines() if not line.startswith(" "))
    with tempfile.TemporaryDirectory() as folder:
        path, outside = capture_run(folder, lines, peer)
        told = rows(path, "rtps.param.topicName", ["rtps.param.topicName", "rtps.param.typeName", "rtps.param.userData"])
        # What is reliable is told by readers alone: it is what writers are unless they say otherwise.
        kinds = {kind for kind, in rows(path, "rtps.reliability_kind", ["rtps.reliability_kind"])}
        wrong = []
        for line in lines.splitlines():
            name, type_hash, _ = line.split()
            kind = name.replace("/msg/", "::msg::dds_::") + "_"
            topic = "rt/test/" + name.replace("/msg", "")
            data = f"typehash=RIHS01_{type_hash};".encode().hex()
            if (topic, kind, data) not in told:
                wrong.append(f"{topic}: told as {[row for row in told if row[0] == topic]}")
        if kinds != {RELIABLE}:
            wrong.append(f"reliability is told as {kinds}")
        if rows(path, TYPE_INFORMATION, ["frame.number"]):
            wrong.append("a description of types is sent")
        away = rows(outside, "ip", ["ip.dst"])
        if away:
            wrong.append(f"sent to {sorted(away)}")
    print("\n".join(wrong) or f"{len(lines.splitlines())} topics are told as they have to be, and to this machine alone")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
