#!/usr/bin/env python3
"""The meshes of scene/meshes/: make_meshes.py [FOLDER]

cushion.obj    two square panels, sewn together along their sides. The texture coordinates are those of the flat panels,
               side by side; the border of each panel is the group "piping"
knot_a.obj     a hose laid as one half of a loose reef knot; its rims are the group "ends"
knot_b.obj     the other half
tube.obj       a hose along x; its rims are the groups "left" and "right"
funnel.obj     a solid funnel around y, its throat at y = 0
body.obj       a solid dressmaker's form around y, from the neck to the knees
dress.obj      a dress of 10,000 vertices around it, which hangs on the shoulders
cape.obj       a cape around it, open in front; its upper edge is the group "collar"
towel.obj      a towel folded into three; its texture coordinates are the flat towel
warp.obj       six ribbons along x, woven with those of weft.obj; what is clamped is the group "ends"
weft.obj       six ribbons along z
"""

import math
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


def write_mesh(path, title, vertices, groups, texture=None):
    """Vertices, faces by group with corners counted from 0, and one texture coordinate per vertex."""
    lines = [f"# {title}; written by tools/make_meshes.py"]
    lines += ["v " + " ".join(f"{round(c, 5) + 0.0:.5g}" for c in v) for v in vertices]
    lines += [f"vt {u:.5g} {v:.5g}" for u, v in texture or ()]
    for name, faces in groups.items():
        lines.append(f"g {name}")
        lines += ["f " + " ".join(f"{c + 1}/{c + 1}" if texture else f"{c + 1}" for c in face) for face in faces]
    with open(path, "w", encoding="ascii", newline="\n") as file:
        file.write("\n".join(lines) + "\n")


def add(a, b, scale=1.0):
    return tuple(x + scale * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    return tuple(x / math.hypot(*a) for x in a)


def band(columns, rows, closed=True, first=0):
    """Triangles of rows of vertices, one row after the other, with diagonals that alternate: (faces of each row)."""
    strips = []
    for j in range(rows - 1):
        strips.append([])
        for i in range(columns if closed else columns - 1):
            right = (i + 1) % columns
            a, b = first + j * columns + i, first + j * columns + right
            c, d = b + columns, a + columns
            strips[-1] += [(a, b, c), (a, c, d)] if (i + j) % 2 == 0 else [(a, b, d), (b, c, d)]
    return strips


def spline(points, spacing):
    """A Catmull-Rom curve through points, cut into equal pieces of about a spacing."""
    fine = []
    for k in range(len(points) - 1):
        p = [points[min(max(k + o, 0), len(points) - 1)] for o in (-1, 0, 1, 2)]
        for t in (s / 64 for s in range(64)):
            weights = ((-t + 2 * t**2 - t**3) / 2, (2 - 5 * t**2 + 3 * t**3) / 2, (t + 4 * t**2 - 3 * t**3) / 2,
                       (t**3 - t**2) / 2)
            fine.append(tuple(sum(w * q[c] for w, q in zip(weights, p)) for c in range(3)))
    fine.append(points[-1])
    way = [0.0]
    for p, q in zip(fine, fine[1:]):
        way.append(way[-1] + math.dist(p, q))
    count, k, cut = round(way[-1] / spacing), 0, []
    for i in range(count + 1):
        at = way[-1] * i / count
        while k < len(fine) - 2 and way[k + 1] < at:
            k += 1
        share = (at - way[k]) / (way[k + 1] - way[k])
        cut.append(add(fine[k], add(fine[k + 1], fine[k], -1), share))
    return cut


def hose(centres, radius, around):
    """Vertices around a curve; from ring to ring the frame turns no more than it must."""
    vertices, side = [], None
    for k, centre in enumerate(centres):
        along = unit(add(centres[min(k + 1, len(centres) - 1)], centres[max(k - 1, 0)], -1))
        side = side or cross(along, (0.0, 0.0, 1.0))
        up = unit(cross(along, side))
        side = cross(up, along)
        for i in range(around):
            angle = 2 * math.pi * i / around
            vertices.append(add(add(centre, side, radius * math.cos(angle)), up, radius * math.sin(angle)))
    return vertices


def write_knot(folder):
    """Each half is a bight: both its legs come from one side and pass through the bight of the other, on its same side."""
    radius, around = 0.012, 12
    leg, wide, bend, lift = 2.2 * radius, 6 * radius, 8 * radius, 1.7 * radius
    half = [(-0.34, leg, 0.0), (-0.2, leg, 0.0), (-bend, leg, lift), (0.0, (leg + wide) / 2, -lift),
            (0.6 * bend, wide, 0.3 * lift), (bend, 0.5 * wide, lift)]
    curve = half + [(1.06 * bend, 0.0, lift)] + [(x, -y, z) for x, y, z in reversed(half)]
    for name, turn in (("a", 1), ("b", -1)):
        centres = spline([(turn * x, y, turn * z) for x, y, z in curve], 2 * math.pi * radius / around)
        strips = band(around, len(centres))
        groups = {"ends": strips[0] + strips[-1], "rope": sum(strips[1:-1], [])}
        write_mesh(os.path.join(folder, f"knot_{name}.obj"), "Half of a reef knot", hose(centres, radius, around), groups)


def write_tube(path):
    radius, length, around, pieces = 0.035, 1.5, 16, 110
    centres = [(length * (k / pieces - 0.5), 0.0, 0.0) for k in range(pieces + 1)]
    strips = band(around, len(centres))
    write_mesh(path, "A hose", hose(centres, radius, around),
               {"left": strips[0], "right": strips[-1], "hose": sum(strips[1:-1], [])})


def lathe(profile, around, depth=1.0):
    """A surface of revolution about y through (radius, height); depth is how flat it is from front to back."""
    vertices = []
    for radius, y in profile:
        for i in range(around):
            angle = 2 * math.pi * i / around
            vertices.append((radius * math.cos(angle), y, -radius * depth * math.sin(angle)))
    return vertices


def write_funnel(path):
    around = 48
    inside = [(0.085, -0.2), (0.085, -0.08), (0.095, 0.0), (0.14, 0.07), (0.56, 0.45)]
    outside = [(0.58, 0.43), (0.16, 0.04), (0.115, -0.02), (0.105, -0.08), (0.105, -0.2)]
    profile = [(r, y) for r, y in outside[::-1]] + inside[::-1]
    rows = len(profile)
    strips = band(around, rows + 1)
    vertices = lathe(profile, around)
    faces = [tuple(c % len(vertices) for c in face) for strip in strips for face in strip]
    write_mesh(path, "A funnel", vertices, {"funnel": faces})


def smooth(points, count):
    """A profile of count points on a curve through (radius, height)."""
    curve = spline([(r, y, 0.0) for r, y in points], 1e-3)
    return [curve[round(k * (len(curve) - 1) / (count - 1))][:2] for k in range(count)]


FORM = [(0.03, 1.56), (0.05, 1.55), (0.055, 1.52), (0.06, 1.47), (0.085, 1.435), (0.15, 1.41), (0.195, 1.36), (0.19, 1.27),
        (0.17, 1.2), (0.135, 1.08), (0.15, 0.98), (0.19, 0.86), (0.19, 0.76), (0.165, 0.6), (0.13, 0.5), (0.06, 0.47)]
DEPTH = 0.66  # of the body, front to back over side to side


def write_body(path):
    around, rows = 40, 44
    vertices = lathe(smooth(FORM[::-1], rows), around, DEPTH)
    faces = sum(band(around, rows), [])
    for y, row, turn in ((0.465, 0, -1), (1.565, rows - 1, 1)):
        vertices.append((0.0, y, 0.0))
        for i in range(around):
            rim = (row * around + i, row * around + (i + 1) % around)
            faces.append((*rim[::turn], len(vertices) - 1))
    write_mesh(path, "A dressmaker's form", vertices, {"form": faces})


def write_dress(path):
    around, rows = 125, 80
    cut = [(0.085, 1.475), (0.115, 1.455), (0.165, 1.435), (0.215, 1.385), (0.22, 1.27), (0.2, 1.16), (0.19, 1.08),
           (0.215, 0.98), (0.26, 0.86), (0.42, 0.45)]
    strips = band(around, rows)
    vertices = lathe(smooth(cut, rows), around, 0.72)
    write_mesh(path, "A dress", vertices, {"dress": [face[::-1] for face in sum(strips, [])]})


def write_cape(path):
    columns, rows = 65, 57
    cut = [(0.105, 1.47), (0.14, 1.45), (0.19, 1.425), (0.225, 1.37), (0.24, 1.27), (0.27, 1.1), (0.4, 0.35)]
    vertices = []
    for radius, y in smooth(cut, rows):
        for i in range(columns):
            angle = math.radians(130) + math.radians(280) * i / (columns - 1)
            vertices.append((radius * math.cos(angle), y, -0.75 * radius * math.sin(angle)))
    turned = [[face[::-1] for face in strip] for strip in band(columns, rows, closed=False)]
    write_mesh(path, "A cape", vertices, {"collar": turned[0], "cape": sum(turned[1:], [])})


def write_towel(path):
    """Its profile goes forth and back in three layers, with round turns between them."""
    width, length, apart, across = 0.36, 0.3, 0.016, 18
    r = apart / 2
    curve = [(-length / 2, 0.0, 0.0), (length / 2 - r, 0.0, 0.0)]
    curve += [(length / 2 - r + r * math.sin(a), r - r * math.cos(a), 0.0) for a in (math.pi / 4, math.pi / 2, 3 * math.pi / 4)]
    curve += [(length / 2 - r, apart, 0.0), (-length / 2 + r, apart, 0.0)]
    curve += [(-length / 2 + r - r * math.sin(a), 3 * r - r * math.cos(a), 0.0)
              for a in (math.pi / 4, math.pi / 2, 3 * math.pi / 4)]
    curve += [(-length / 2 + r, 2 * apart, 0.0), (length / 2, 2 * apart, 0.0)]
    spacing = width / across
    dense = []  # a spline would swing at the turns' ends, where long pieces meet short ones
    for p, q in zip(curve, curve[1:]):
        pieces = max(1, round(math.dist(p, q) / 0.004))
        dense += [add(p, add(q, p, -1), k / pieces) for k in range(pieces)]
    profile = spline(dense + [curve[-1]], 0.6 * spacing)
    columns = across + 1
    vertices = [(x, y, width * (i / across - 0.5)) for x, y, _ in profile for i in range(columns)]
    texture, way = [], 0.0
    for k, p in enumerate(profile):
        way += math.dist(p, profile[k - 1]) if k else 0.0
        texture += [(width * i / across, way) for i in range(columns)]
    write_mesh(path, "A folded towel", vertices, {"towel": sum(band(columns, len(profile), closed=False), [])}, texture)


def write_ribbons(folder):
    """Each ribbon goes over and under those that cross it, in turns."""
    count, pitch, width, lift, across = 6, 0.15, 0.07, 0.012, 4
    spacing, reach = width / across, 0.55
    pieces = round(2 * reach / spacing)
    for name in ("warp", "weft"):
        vertices, ends, ribbons = [], [], []
        for ribbon in range(count):
            middle = pitch * (ribbon - (count - 1) / 2)
            first = len(vertices)
            for k in range(pieces + 1):
                along = 2 * reach * k / pieces - reach
                phase = math.pi * (along / pitch + (count - 1) / 2 + ribbon)
                y = lift * math.cos(phase) * (1 if name == "warp" else -1)
                for i in range(across + 1):
                    side = middle + width * (i / across - 0.5)
                    vertices.append((along, y, side) if name == "warp" else (side, y, along))
            strips = band(across + 1, pieces + 1, closed=False, first=first)
            ends += strips[0] + strips[-1]
            ribbons += sum(strips[1:-1], [])
        write_mesh(os.path.join(folder, f"{name}.obj"), "Woven ribbons", vertices, {"ends": ends, "ribbons": ribbons})


def main():
    if len(sys.argv) > 2:
        print(__doc__.strip(), file=sys.stderr)
        return 2
    root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    folder = sys.argv[1] if len(sys.argv) == 2 else os.path.join(root, "scene", "meshes")
    os.makedirs(folder, exist_ok=True)
    write_cushion(os.path.join(folder, "cushion.obj"))
    write_knot(folder)
    write_tube(os.path.join(folder, "tube.obj"))
    write_funnel(os.path.join(folder, "funnel.obj"))
    write_body(os.path.join(folder, "body.obj"))
    write_dress(os.path.join(folder, "dress.obj"))
    write_cape(os.path.join(folder, "cape.obj"))
    write_towel(os.path.join(folder, "towel.obj"))
    write_ribbons(folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
