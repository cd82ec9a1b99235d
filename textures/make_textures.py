#!/usr/bin/env python3
"""Makes the textures of the classic shaders and the surroundings that Mirror shows.

    python3 textures/make_textures.py [FOLDER]

Writes texture_1.png .. texture_4.png and cube/*.png into FOLDER (default: beside this script).
Needs the standard library only, and makes the same files every time, to the byte with one version
of zlib. Every texture continues at its opposite edge.
"""

import math
import os
import struct
import sys
import zlib


def clamp(x, low=0.0, high=1.0):
    return low if x < low else high if x > high else x


def mix(a, b, t):
    return tuple(x + (y - x) * t for x, y in zip(a, b))


def smooth(low, high, x):
    t = clamp((x - low) / (high - low))
    return t * t * (3 - 2 * t)


def hash_unit(*key):
    """A well-mixed number in 0..1 for a few integers."""
    h = 0x9E3779B97F4A7C15
    for k in key:
        h = ((h ^ (k & 0xFFFFFFFF)) * 0xBF58476D1CE4E5B9) & 0xFFFFFFFFFFFFFFFF
        h ^= h >> 29
    h = (h * 0x94D049BB133111EB) & 0xFFFFFFFFFFFFFFFF
    return ((h ^ (h >> 31)) >> 11) / float(1 << 53)


def noise2(x, y, period, seed):
    """Smooth noise in 0..1 that repeats after `period` cells."""
    i, j = math.floor(x), math.floor(y)
    u, v = x - i, y - j
    u, v = u * u * (3 - 2 * u), v * v * (3 - 2 * v)
    a = hash_unit(i % period, j % period, seed)
    b = hash_unit((i + 1) % period, j % period, seed)
    c = hash_unit(i % period, (j + 1) % period, seed)
    d = hash_unit((i + 1) % period, (j + 1) % period, seed)
    return (a + (b - a) * u) * (1 - v) + (c + (d - c) * u) * v


def fractal2(u, v, cells, octaves, seed):
    """Noise of several sizes in 0..1 over the unit square, repeating."""
    total, weight, result = 0.0, 1.0, 0.0
    for k in range(octaves):
        n = cells << k
        result += weight * noise2(u * n, v * n, n, seed + k)
        total += weight
        weight *= 0.5
    return result / total


def noise3(x, y, z, seed):
    i, j, k = math.floor(x), math.floor(y), math.floor(z)
    u, v, w = x - i, y - j, z - k
    u, v, w = u * u * (3 - 2 * u), v * v * (3 - 2 * v), w * w * (3 - 2 * w)
    value = 0.0
    for dk, wk in ((0, 1 - w), (1, w)):
        for dj, wj in ((0, 1 - v), (1, v)):
            for di, wi in ((0, 1 - u), (1, u)):
                value += wi * wj * wk * hash_unit(i + di, j + dj, k + dk, seed)
    return value


def fractal3(x, y, z, octaves, seed):
    total, weight, result = 0.0, 1.0, 0.0
    for k in range(octaves):
        result += weight * noise3(x, y, z, seed + k)
        total += weight
        weight *= 0.5
        x, y, z = 2 * x, 2 * y, 2 * z
    return result / total


def paeth(a, b, c):
    p = a + b - c
    da, db, dc = abs(p - a), abs(p - b), abs(p - c)
    return a if da <= db and da <= dc else b if db <= dc else c


def write_png(path, size, channels, pixel):
    """`pixel(x, y)` gives the `channels` (1: grey, 3: colour) values 0..1 of a pixel."""
    previous = bytes(size * channels)
    out = bytearray()
    for y in range(size):
        row = bytearray()
        for x in range(size):
            row += bytes(int(255 * clamp(c) + 0.5) for c in pixel(x, y))
        left = bytes(channels) + bytes(row[:-channels])
        corner = bytes(channels) + previous[:-channels]
        candidates = [
            bytes(row),
            bytes((a - b) & 255 for a, b in zip(row, left)),
            bytes((a - b) & 255 for a, b in zip(row, previous)),
            bytes((a - (b + c) // 2) & 255 for a, b, c in zip(row, left, previous)),
            bytes((a - paeth(b, c, d)) & 255 for a, b, c, d in zip(row, left, previous, corner)),
        ]
        # The usual guess at what compresses best: the smallest sum of absolute differences.
        best = min(range(5), key=lambda f: sum(min(b, 256 - b) for b in candidates[f]))
        out += bytes([best]) + candidates[best]
        previous = bytes(row)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", size, size, 8, 0 if channels == 1 else 2, 0, 0, 0)
    with open(path, "wb") as f:
        f.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(out), 9)) + chunk(b"IEND", b""))
    print(f"{path}: {size} x {size}, {os.path.getsize(path) / 1000:.0f} kB")


def weave(x, y, pitch):
    """Brightness of a plain weave of threads `pitch` pixels wide: who is on top alternates."""
    i, j = x // pitch, y // pitch
    a, b = (x % pitch + 0.5) / pitch - 0.5, (y % pitch + 0.5) / pitch - 0.5
    over = (i + j) % 2 == 0
    across, along = (a, b) if over else (b, a)
    return 1.0 - 0.55 * across * across * 4 * 0.6 - 0.25 * along * along * 4


# --- texture 1: a printed cotton, flowers and dots on indigo --------------------------------------

INDIGO = (0.075, 0.125, 0.33)
CREAM = (0.965, 0.925, 0.83)
CORAL = (0.90, 0.36, 0.27)
OCHRE = (0.93, 0.69, 0.26)
TEAL = (0.20, 0.52, 0.53)


def flower(u, v):
    """Colour and coverage of a flower in a unit cell around (0, 0)."""
    r, angle = math.hypot(u, v), math.atan2(v, u)
    petals = 0.30 + 0.085 * math.cos(6 * angle)
    inner = 0.17 + 0.05 * math.cos(6 * angle + math.pi)
    edge = 0.012
    color, cover = CREAM, 1 - smooth(petals - edge, petals + edge, r)
    color = mix(color, CORAL, 1 - smooth(inner - edge, inner + edge, r))
    color = mix(color, OCHRE, 1 - smooth(0.075 - edge, 0.075 + edge, r))
    return color, cover


def printed_cotton(x, y, size):
    cells = 4
    u, v = x / size * cells, y / size * cells
    color = INDIGO
    # Flowers on the corners and the middles of the cells, the latter smaller and turned.
    fu, fv = u - round(u), v - round(v)
    c, cover = flower(fu, fv)
    color = mix(color, c, cover)
    gu, gv = u - math.floor(u) - 0.5, v - math.floor(v) - 0.5
    c, s = math.cos(math.pi / 6), math.sin(math.pi / 6)
    fc, cover = flower((c * gu - s * gv) * 1.75, (s * gu + c * gv) * 1.75)
    color = mix(color, mix(fc, OCHRE, 0.25), cover)
    # Leaves between them, and dots.
    for du, dv in ((0.5, 0.0), (0.0, 0.5)):
        hu, hv = u + du - round(u + du), v + dv - round(v + dv)
        diamond = abs(hu) + abs(hv)
        color = mix(color, TEAL, 1 - smooth(0.088, 0.108, diamond))
        color = mix(color, CREAM, 1 - smooth(0.026, 0.044, math.hypot(hu, hv)))
    shade = 0.86 + 0.14 * weave(x, y, 4)
    return tuple(c * shade for c in color)


# --- texture 2: marble, also a height map ---------------------------------------------------------


def marble(x, y, size):
    u, v = x / size, y / size
    warp = fractal2(u, v, 4, 5, 11)
    veins = abs(math.sin(math.pi * (2 * u + 2 * v + 3.2 * warp)))
    fine = fractal2(u, v, 8, 4, 71)
    return (clamp(0.25 + 0.62 * veins ** 0.55 + 0.22 * (fine - 0.5)),)


# --- texture 3: bricks, a height map --------------------------------------------------------------


def bricks(x, y, size):
    # Few pixels and a steep edge: the classic bump shader takes the difference of neighbouring
    # pixels for the slope, so this is what makes it show.
    rows, columns, joint, bevel = 10, 5, 2.4, 1.0  # joint and bevel in pixels
    bw, bh = size / columns, size / rows
    row = int(y / bh)
    shifted = x + (bw / 2 if row % 2 else 0)
    column = int(shifted / bw) % columns
    dx, dy = shifted % bw, y % bh
    # Hand-made bricks: each edge wavers a little.
    waver = 0.9 * (fractal2(x / size, y / size, 16, 2, 5) - 0.5)
    edge = min(dx, bw - dx, dy, bh - dy) - joint / 2 + waver
    body = smooth(0, bevel, edge)
    top = 0.78 + 0.16 * (hash_unit(row, column, 3) - 0.5)
    rough = 0.30 * (fractal2(x / size, y / size, 32, 2, 17) - 0.5)
    mortar = 0.12 + 0.08 * (fractal2(x / size, y / size, 32, 1, 23) - 0.5)
    return (clamp(mortar + (top + rough - mortar) * body),)


# --- texture 4: a tartan, woven in twill ----------------------------------------------------------

GREEN, NAVY, RED, WHITE, GOLD = (0.07, 0.24, 0.16), (0.06, 0.09, 0.22), (0.66, 0.09, 0.10), (0.90, 0.88, 0.82), (0.88, 0.68, 0.20)
# Threads of one repeat: 64 of them, mirrored about its middle as tartans are.
SETT = [(NAVY, 6), (GREEN, 8), (RED, 2), (GREEN, 4), (NAVY, 4), (WHITE, 1), (NAVY, 3), (RED, 3), (GOLD, 1)]


def sett_threads():
    half = [color for color, count in SETT for _ in range(count)]
    return half + half[::-1]


THREADS = sett_threads()


def tartan(x, y, size):
    pitch = size // (2 * len(THREADS))
    i, j = x // pitch, y // pitch
    warp, weft = THREADS[i % len(THREADS)], THREADS[j % len(THREADS)]
    over = (i - j) % 4 < 2  # two over, two under, one further in each row
    color = warp if over else weft
    a = (x % pitch + 0.5) / pitch - 0.5
    b = (y % pitch + 0.5) / pitch - 0.5
    across = a if over else b
    shade = 1.08 - 0.9 * across * across
    return tuple(c * shade for c in color)


# --- surroundings: a sky with sun and clouds over hills and meadows -------------------------------

SUN = (0.45, 0.42, 0.79)
FACES = {
    "posx": lambda a, b: (1, -b, -a),
    "negx": lambda a, b: (-1, -b, a),
    "posy": lambda a, b: (a, 1, b),
    "negy": lambda a, b: (a, -1, -b),
    "posz": lambda a, b: (a, -b, 1),
    "negz": lambda a, b: (-a, -b, -1),
}


def surroundings(x, y, z):
    length = math.sqrt(x * x + y * y + z * z)
    x, y, z = x / length, y / length, z / length
    around = math.hypot(x, z) or 1e-9
    cx, cz = x / around, z / around
    sl = math.sqrt(sum(s * s for s in SUN))
    toward = (x * SUN[0] + y * SUN[1] + z * SUN[2]) / sl

    haze = (0.86, 0.90, 0.93)
    if y > -0.02:
        up = clamp(y) ** 0.55
        color = mix(haze, (0.13, 0.34, 0.68), up)
        color = mix(color, (1.0, 0.95, 0.82), 0.55 * clamp(toward) ** 12)
        # Clouds on a flat ceiling, fading towards the horizon.
        if y > 0.03:
            scale = 0.9 / (y + 0.12)
            cover = fractal3(x * scale * 1.7 + 7.0, z * scale * 1.7, 3.0, 5, 101)
            thick = smooth(0.50, 0.72, cover) * smooth(0.03, 0.22, y)
            color = mix(color, mix((0.80, 0.84, 0.89), (1.0, 0.99, 0.97), smooth(0.52, 0.80, cover)), 0.92 * thick)
        color = mix(color, (1.0, 0.98, 0.90), smooth(0.9955, 0.9975, toward))
    else:
        color = haze
    # Two ranges of hills, the farther one paler; their height goes round without a seam.
    for height, amount, tint, seed, scale in ((0.055, 0.10, (0.56, 0.66, 0.74), 41, 2.2), (0.012, 0.075, (0.30, 0.45, 0.36), 57, 3.4)):
        ridge = height + amount * (fractal3(cx * scale + 9, cz * scale + 9, 0.5, 4, seed) - 0.42)
        color = mix(color, tint, 1 - smooth(ridge - 0.006, ridge + 0.006, y))
    if y < 0.0:
        # Meadows: fields of two greens on a flat ground that fades into the distance.
        scale = 1.0 / max(0.03, -y)
        gx, gz = x * scale, z * scale
        near = smooth(0.0, 0.35, -y)
        patch = fractal3(gx * 0.9 + 30, gz * 0.9 + 30, 1.5, 3, 77)
        ground = mix((0.29, 0.43, 0.19), (0.60, 0.56, 0.28), smooth(0.40, 0.62, patch))
        ground = mix((0.36, 0.48, 0.33), ground, near)
        color = mix(color, ground, smooth(0.0, 0.03, -y))
    return color


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.dirname(os.path.abspath(__file__))
    os.makedirs(os.path.join(folder, "cube"), exist_ok=True)
    for number, size, channels, make in ((1, 512, 3, printed_cotton), (2, 256, 1, marble), (3, 128, 1, bricks), (4, 384, 3, tartan)):
        write_png(os.path.join(folder, f"texture_{number}.png"), size, channels, lambda x, y: make(x, y, size))
    size = 256
    for name, direction in FACES.items():
        # Pixel centres: neighbouring faces continue each other.
        def pixel(x, y):
            return surroundings(*direction((2 * x + 1) / size - 1, (2 * y + 1) / size - 1))

        write_png(os.path.join(folder, "cube", name + ".png"), size, 3, pixel)


if __name__ == "__main__":
    main()
