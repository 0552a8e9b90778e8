"""Topics of every type between palpate and Fast DDS: matrix.py PRINT_TYPES PALPATE_PEER FAST_PEER.

Both ways, best effort and reliable, told to this machine alone or to the network, either end first. Run in a network namespace
of its own (unshare -rn). Prints a row a case; exits 77 where the namespace cannot be had.
"""

import itertools
import os
import subprocess
import sys
import time

SECONDS = 15  # after which a message is taken for lost


def network(with_address):
    """What a namespace has: loopback, and a link with an address and a default route."""
    commands = ["ip link set lo up"]
    if with_address:
        commands += ["ip link add link0 type veth peer name link1", "ip addr add 10.77.0.1/24 dev link0",
                     "ip link set link0 up", "ip link set link1 up", "ip route add default via 10.77.0.2"]
    for command in commands:
        subprocess.run(command.split(), check=True, stderr=subprocess.DEVNULL)


def start(program, role, reliability, environment, lines):
    process = subprocess.Popen([program, role, reliability, str(SECONDS)], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                               env={**os.environ, **environment}, text=True)
    process.stdin.write(lines)
    process.stdin.close()
    return process


def missing(lines, received):
    """Types whose message did not arrive as it was sent, but for bytes that fill it up to four."""
    got = dict(line.split() for line in received.splitlines())
    sent = dict(line.split()[::2] for line in lines.splitlines())
    return [name for name, told in sent.items()
            if not (got.get(name, "").startswith(told) and len(got[name]) < len(told) + 8)]


def case(writer, reader, reliability, scope, writer_first, lines):
    environment = {"ROS_AUTOMATIC_DISCOVERY_RANGE": scope}
    ends = {}
    order = ["write", "read"] if writer_first else ["read", "write"]
    for role in order:
        ends[role] = start(writer if role == "write" else reader, role, reliability, environment, lines)
        time.sleep(1)
    received = ends["read"].stdout.read()
    ends["read"].wait()
    ends["write"].terminate()
    ends["write"].wait()
    return missing(lines, received)


def main():
    print_types, palpate, fast = sys.argv[1:4]
    try:
        network(True)
    except (subprocess.CalledProcessError, FileNotFoundError):
        print("no network namespace can be set up here")
        sys.exit(77)
    text = subprocess.run([print_types], check=True, capture_output=True, text=True).stdout
    lines = "".join(line + "\n" for line in text.splitlines() if not line.startswith(" "))
    failed = 0
    for ends, reliability, scope, first in itertools.product(
            (("palpate", "fast"), ("fast", "palpate")), ("best_effort", "reliable"), ("LOCALHOST", "SUBNET"), (True, False)):
        programs = [palpate if end == "palpate" else fast for end in ends]
        lost = case(*programs, reliability, scope, first, lines)
        failed += bool(lost)
        print(f"{ends[0]:>7} to {ends[1]:<7} {reliability:<11} {scope:<9} {'writer' if first else 'reader'} first: "
              f"{'lost ' + ', '.join(lost) if lost else f'all {len(lines.splitlines())} types'}", flush=True)
    sys.exit(bool(failed))


if __name__ == "__main__":
    main()
