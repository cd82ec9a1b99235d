#!/usr/bin/env python3
"""The meshes of scene/meshes/: make_meshes.py [FOLDER]

Writes cushion.obj: two square panels, sewn together along their sides. The texture coordinates are those of the flat
panels, side by side; the border of each panel is the group "piping".
"""

import os
import sys

QUADS = 40  # along a side; even
SIDE = 0.45  # [m]
APART = 0.01  # of the panels in their middle, from which pressure blows them up [m]
GAP = 0.1  # between the panels in the texture


def write_cushion(path):
    n = QUADS + 1
    vertices, lines = [], []
    number = {}  # of (panel, i, j), from 1

    for panel in (0, 1):
        for j in range(n):
            for i in range(n):
                seam = i in (0, QUADS) or j in (0, QUADS)
                if panel == 1 and seam:
                    number[1, i, j] = number[0, i, j]
                    continue
                x, y = i / QUADS, j / QUADS
                z = (1 - 2 * panel) * APART * 8 * x * (1 - x) * y * (1 - y)
                vertices.append((SIDE * (x - 0.5), SIDE * (y - 0.5), z))
                number[panel, i, j] = len(vertices)

    texture = {}
    coordinates = []
    for panel in (0, 1):
        for j in range(n):
            for i in range(n):
                # The back is seen from behind, so it is mirrored.
                coordinates.append((i / QUADS if panel == 0 else 2 + GAP - i / QUADS, j / QUADS))
                texture[panel, i, j] = len(coordinates)

    faces = {}
    for panel in (0, 1):
        for j in range(QUADS):
            for i in range(QUADS):
                a, b, c, d = (i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)
                # Each diagonal runs from outside inwards: else the panels' corners would be the same triangles.
                inwards = (i < QUADS / 2) == (j < QUADS / 2)
                for corners in ((a, b, c), (a, c, d)) if inwards else ((a, b, d), (b, c, d)):
                    corners = corners if panel == 0 else corners[::-1]
                    border = i in (0, QUADS - 1) or j in (0, QUADS - 1)
                    name = "piping" if border else ("front", "back")[panel]
                    face = " ".join(f"{number[(panel, *p)]}/{texture[(panel, *p)]}" for p in corners)
                    faces.setdefault(name, []).append("f " + face)

    lines.append("# A cushion; written by tools/make_meshes.py")
    lines += [f"v {x:.6g} {y:.6g} {z:.6g}" for x, y, z in vertices]
    lines += [f"vt {u:.6g} {v:.6g}" for u, v in coordinates]
    for name in ("front", "back", "piping"):
        lines.append(f"g {name}")
        lines += faces[name]
    with open(path, "w", encoding="ascii", newline="\n") as file:
        file.write("\n".join(lines) + "\n")


def main():
    if len(sys.argv) > 2:
        print(__doc__.strip(), file=sys.stderr)
        return 2
    root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    folder = sys.argv[1] if len(sys.argv) == 2 else os.path.join(root, "scene", "meshes")
    os.makedirs(folder, exist_ok=True)
    write_cushion(os.path.join(folder, "cushion.obj"))
    return 0


if __name__ == "__main__":
    sys.exit(main())
