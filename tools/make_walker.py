#!/usr/bin/env python3
"""A body that walks on the spot: make_walker.py [FOLDER]

Writes walker.obj and walk.pc2 into scene/meshes/ or FOLDER: torso, legs and arms, closed tubes that reach into one another,
1.5 m high on the ground at y = 0, facing +z; and how it stands, begins to walk within a stride, and walks on.
"""

import math
import os
import struct
import sys

RATE = 15  # samples per second
SECONDS = 3
STRIDE = 1.0  # from left foot to left foot [s]
HIP, KNEE = 0.92, 0.48  # heights of the joints [m]
SHOULDER, ELBOW = 1.40, 0.29  # height; and length of the upper arm [m]
SPREAD = 32  # of the arms from the vertical [degree]


def smooth(t):
    t = min(max(t, 0), 1)
    return t * t * (3 - 2 * t)


def lerp_table(table, t):
    """Of rows (t, a, b, ...) ascending by t, smooth from row to row."""
    for low, high in zip(table, table[1:]):
        if t <= high[0]:
            s = smooth((t - low[0]) / (high[0] - low[0]))
            return [a + (b - a) * s for a, b in zip(low[1:], high[1:])]
    return table[-1][1:]


def turn_x(p, degrees):
    """About x; positive moves what hangs down forwards, to +z."""
    s, c = math.sin(math.radians(-degrees)), math.cos(math.radians(-degrees))
    return (p[0], c * p[1] - s * p[2], s * p[1] + c * p[2])


def turn_y(p, degrees):
    s, c = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
    return (c * p[0] + s * p[2], p[1], -s * p[0] + c * p[2])


def turn_z(p, degrees):
    s, c = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
    return (c * p[0] - s * p[1], s * p[0] + c * p[1], p[2])


def add(p, q):
    return tuple(a + b for a, b in zip(p, q))


def tube(rings, around, profile, length):
    """Points of a tube down from the origin with half widths of profile(t), and its triangles; both ends closed."""
    points, triangles = [], []
    for i in range(rings):
        t = i / (rings - 1)
        # Round at the ends: rings crowd there.
        y = length * (0.5 - 0.5 * math.cos(math.pi * t))
        w, d = profile(y / length)
        end = math.sin(math.pi * min(max(t, 0.02), 0.98)) ** 0.5
        for k in range(around):
            angle = 2 * math.pi * k / around
            points.append((w * end * math.cos(angle), -y, d * end * math.sin(angle)))
    for i in range(rings - 1):
        for k in range(around):
            a, b = i * around + k, i * around + (k + 1) % around
            c, d = a + around, b + around
            triangles += [(a, b, c), (b, d, c)]
    top, bottom = len(points), len(points) + 1
    points += [(0, 0.004, 0), (0, -length - 0.004, 0)]
    last = (rings - 1) * around
    for k in range(around):
        triangles.append((top, (k + 1) % around, k))
        triangles.append((bottom, last + k, last + (k + 1) % around))
    return points, triangles


LEG = [(0, 0.082, 0.088), (0.25, 0.076, 0.08), (0.5, 0.052, 0.056), (0.65, 0.052, 0.056), (1, 0.036, 0.04)]
ARM = [(0, 0.048, 0.05), (0.5, 0.036, 0.038), (1, 0.026, 0.026)]
TORSO = [(0, 0.06, 0.055), (0.12, 0.155, 0.095), (0.3, 0.165, 0.115), (0.6, 0.135, 0.1), (0.85, 0.16, 0.115), (1, 0.15, 0.1)]
TORSO_TOP, TORSO_LENGTH = 1.5, 0.68


def strength(time):
    return smooth((time - 0.2) / 0.8)


def move_leg(p, side, time):
    phase = 2 * math.pi * (time / STRIDE + (0 if side > 0 else 0.5))
    hip = strength(time) * (6 + 24 * math.sin(phase))
    knee = strength(time) * (12 + 30 * max(0, math.cos(phase)) ** 2)
    joint = HIP - KNEE
    below = smooth((-p[1] - joint + 0.07) / 0.14)
    q = add((0, -joint, 0), turn_x(add(p, (0, joint, 0)), -knee * below))
    return add(turn_x(q, hip), (side * 0.085, HIP, 0))


def move_arm(p, side, time):
    phase = 2 * math.pi * (time / STRIDE + (0.5 if side > 0 else 0))
    bend = strength(time) * (14 + 8 * math.sin(phase))
    below = smooth((-p[1] - ELBOW + 0.05) / 0.1)
    q = add((0, -ELBOW, 0), turn_x(add(p, (0, ELBOW, 0)), bend * below))
    q = turn_x(turn_z(q, side * SPREAD), strength(time) * 20 * math.sin(phase))
    return add(q, (side * 0.155, SHOULDER, 0))


def move_torso(p, _, time):
    # The shoulders turn against the hips.
    up = 1 + p[1] / TORSO_LENGTH
    return add(turn_y(p, strength(time) * (1 - 2 * up) * 5 * math.sin(2 * math.pi * time / STRIDE)), (0, TORSO_TOP, 0))


def bob(p, time):
    return add(p, (0, 0.015 * strength(time) * math.cos(4 * math.pi * time / STRIDE), 0))


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.join(os.path.dirname(__file__), "..", "scene", "meshes")
    parts = [("torso", 24, 28, TORSO, TORSO_LENGTH, move_torso, (0,)), ("leg", 26, 16, LEG, 0.88, move_leg, (1, -1)),
             ("arm", 20, 12, ARM, 0.54, move_arm, (1, -1))]
    lines, movers = [], []
    for name, rings, around, table, length, move, sides in parts:
        points, triangles = tube(rings, around, lambda t: lerp_table(table, t), length)
        for side in sides:
            first = len(movers) + 1
            movers += [(p, move, side) for p in points]
            lines.append("g " + name + {0: "", 1: "_left", -1: "_right"}[side] + "\n")
            lines += ["f %d %d %d\n" % tuple(v + first for v in t) for t in triangles]
    at = lambda time: [bob(move(p, side, time), time) for p, move, side in movers]
    with open(os.path.join(folder, "walker.obj"), "w") as file:
        file.write("# by tools/make_walker.py\n")
        file.writelines("v %.5f %.5f %.5f\n" % p for p in at(0))
        file.writelines(lines)
    samples = SECONDS * RATE + 1
    with open(os.path.join(folder, "walk.pc2"), "wb") as file:
        file.write(struct.pack("<12siiffi", b"POINTCACHE2\0", 1, len(movers), 0, 1 / RATE, samples))
        for s in range(samples):
            for p in at(s / RATE):
                file.write(struct.pack("<3f", *p))


if __name__ == "__main__":
    main()
