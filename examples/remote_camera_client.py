#!/usr/bin/env python3
"""A depth camera in a page of Python: remote_camera_client.py SOCKET [SECONDS]. It sends a made-up wall,
0.7 m away, that moves to and fro by 5 mm, 30 times a second (docs/remote_camera.md). `Link` is of use for
real cameras, too. Standard library only."""

import math
import socket
import struct
import sys
import time

HEADER = struct.Struct("<4sHHII18d")
POSE, STAMP, FLOATS = 1, 2, 4


class Link:
    """A connection to palpate. Its socket is palpate's: `palpate touch camera:remote` makes it."""

    def __init__(self, path):
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self.socket.connect(path)

    def send(self, depth, size, lens, unit=1e-3, stamp=None, pose=None, distortion=(0,) * 5, floats=False):
        """A frame. depth: bytes of (width * height) little-endian u16, or f32 if `floats`, row by row;
        lens: (fx, fy, cx, cy) in pixels; unit: metres a step; stamp: s, on a clock that grows; pose:
        (x, y, z, qx, qy, qz, qw), camera to world. Waits until palpate has taken it."""
        flags = (POSE if pose else 0) | (STAMP if stamp is not None else 0) | (FLOATS if floats else 0)
        try:
            self.socket.sendall(HEADER.pack(b"plpD", 1, flags, *size, unit, *lens, *distortion,
                                            stamp or 0, *(pose or (0, 0, 0, 0, 0, 0, 1))))
            self.socket.sendall(depth)
        except OSError as error:  # palpate has closed the connection: it says why, or it has ended
            try:
                why = self.socket.recv(1000).decode().strip()
            except OSError:
                why = ""
            raise ConnectionError(why or "palpate has ended") from error


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    path, seconds = sys.argv[1], float(sys.argv[2]) if len(sys.argv) > 2 else math.inf
    width, height = 320, 240
    lens = (285.0, 285.0, 159.5, 119.5)
    frames = 0
    try:
        link = Link(path)
        start = time.monotonic()
        while (stamp := time.monotonic()) - start < seconds:
            z = 7000 + round(50 * math.sin(2 * math.pi * (stamp - start) / 4))  # steps of 0.1 mm
            link.send(struct.pack("<H", z) * (width * height), (width, height), lens, 1e-4, stamp)
            frames += 1
            time.sleep(1 / 30)
    except OSError as error:
        print(f"{path}: {error}", file=sys.stderr)
        return 1
    print(f"{frames} frames")
    return 0


if __name__ == "__main__":
    sys.exit(main())
