#!/usr/bin/env python3
"""A haptic device in a page of Python: remote_device_client.py SOCKET [SECONDS]. It moves a hand that
nobody holds down to 5 mm below z = 0 and up again, tilted by 0.2 rad to and fro, some hundred times a
second, and tells the largest force and torque (docs/remote_device.md). Standard library only."""

import math
import os
import socket
import struct
import sys
import tempfile
import time

STATE = struct.Struct("<4sHHQd3d3dII4d3dd")
FORCE = struct.Struct("<4sHHQQd3d3dd")
LEAVING, TORQUE, CLOSING = 2, 8, 2


def newest_force(link, seen):
    """The newest good packet that waits: (sequence, flags, force and torque and grip), or None."""
    found = None
    while True:
        try:
            data = link.recv(FORCE.size + 1)
        except BlockingIOError:
            return found
        if len(data) != FORCE.size:
            continue
        magic, version, flags, sequence, _, _, *wrench = FORCE.unpack(data)
        good = magic == b"plpF" and version == 2 and all(map(math.isfinite, wrench))
        if good and sequence > (found[0] if found else seen):
            found = sequence, flags, wrench


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    path, seconds = sys.argv[1], float(sys.argv[2]) if len(sys.argv) > 2 else 2
    mine = tempfile.mktemp(prefix="palpate-client-")
    link = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
    link.bind(mine)
    link.setblocking(False)
    start = heard = time.monotonic()
    sequence, seen, leaving = 0, 0, False
    applied = largest = (0.0, 0.0)  # N, N m
    try:
        while not leaving:
            t = time.monotonic() - start
            found = newest_force(link, seen)
            if found:
                seen, flags, wrench = found
                heard = time.monotonic()
                if flags & CLOSING:
                    break
                applied = math.hypot(*wrench[:3]), math.hypot(*wrench[3:6])
            if time.monotonic() - heard > 0.1:  # silence: a motor gets nothing
                applied = 0.0, 0.0
            largest = tuple(map(max, largest, applied))  # here a real device drives its motors
            leaving = t >= seconds
            sequence += 1
            z = 5e-3 * (abs(4 * min(t / seconds, 1) - 2) - 1)
            half = 0.1 * math.sin(2 * math.pi * t / seconds)  # of the turn about y
            try:
                link.sendto(STATE.pack(b"plpS", 2, TORQUE | (LEAVING if leaving else 0), sequence, 1 + t, 0, 0, z,
                                       0, 0, 0, 0, 0, math.cos(half), 0, math.sin(half), 0, 0, 0, 0, 0), path)
            except BlockingIOError:  # it does not read just now: the next state will do
                pass
            except OSError as error:
                sys.exit(f"{path}: {error}; palpate touch CLOUD --device remote:{path} makes it")
            time.sleep(1e-3)
    finally:
        os.unlink(mine)
    print(f"{sequence} states, {seen} forces, largest {largest[0]:.3f} N, {largest[1]:.4f} N m")
    return 0 if seen else 1


sys.exit(main())
