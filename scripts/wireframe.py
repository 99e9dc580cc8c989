#!/usr/bin/python3
"""Draws meshes as shaded surfaces with their triangles on them, hidden lines removed, creases in a colour of their own.

  wireframe.py picture.png --panel MESH.ply X Y Z AZIMUTH ELEVATION WIDTH [--panel ...] [--size 700x700]

Each panel looks at the point X Y Z (metres, z up) from AZIMUTH and ELEVATION (degrees); WIDTH metres fill it there. Panels
stand side by side. The meshes are binary .ply files as `cambium mesh` writes them, their creases the element `edge`.
Needs numpy alone (Debian: python3-numpy).
"""
import argparse
import struct
import zlib

import numpy as np

SUBPIXELS = 4      # along each side of a pixel
FIELD_OF_VIEW = np.radians(24)
PAPER, WOOD, WIRE, CREASE = (np.array(c) / 255 for c in ((247, 244, 238), (214, 190, 156), (38, 48, 66), (214, 48, 22)))
WIRE_WIDTH, CREASE_WIDTH = 0.9, 2.8   # pixels
SEAM = 14          # pixels of paper between panels
PLY_TYPES = {"char": "i1", "uchar": "u1", "short": "<i2", "ushort": "<u2", "int": "<i4", "uint": "<u4", "float": "<f4", "double": "<f8"}
LIST_LENGTHS = {"vertex_indices": 3, "texcoord": 6}   # of triangles; so every row of an element is equally long


def read_ply(path):
    """Vertices (n, 3) in metres, triangles (m, 3) and crease edges (k, 2) by index."""
    with open(path, "rb") as file:
        elements = []
        while (line := file.readline().decode("ascii").split()) != ["end_header"]:
            if line[0] == "element":
                elements.append((line[1], int(line[2]), []))
            elif line[:2] == ["property", "list"]:
                length = LIST_LENGTHS[line[4]]
                elements[-1][2].extend([(line[4] + "_length", PLY_TYPES[line[2]]), (line[4], PLY_TYPES[line[3]], (length,))])
            elif line[0] == "property":
                elements[-1][2].append((line[2], PLY_TYPES[line[1]]))
        rows = {name: np.fromfile(file, np.dtype(fields), count) for name, count, fields in elements}
    vertex, edge = rows["vertex"], rows["edge"]
    points = np.stack([vertex[c] for c in "xyz"], 1).astype(float)
    return points, rows["face"]["vertex_indices"], np.stack([edge["vertex1"], edge["vertex2"]], 1)[edge["crease"] > 0]


class Camera:
    """Pinhole. View space: x right, y down, z ahead, metres; picture space: subpixels and 1 / depth, which is linear across a triangle."""

    def __init__(self, target, azimuth, elevation, width, size):
        a, e = np.radians([azimuth, elevation])
        back = np.array([np.cos(a) * np.cos(e), np.sin(a) * np.cos(e), np.sin(e)])
        right = np.array([-np.sin(a), np.cos(a), 0])
        self.rows, self.size = np.stack([right, np.cross(-back, right), -back]), np.array(size) * SUBPIXELS
        self.eye = np.array(target) + back * (width / 2 / np.tan(FIELD_OF_VIEW / 2))
        self.focal = self.size[0] / 2 / np.tan(FIELD_OF_VIEW / 2)

    def view(self, points):
        return (points - self.eye) @ self.rows.T

    def project(self, view):
        return np.concatenate([self.focal * view[..., :2] / view[..., 2:] + self.size / 2, 1 / view[..., 2:]], -1)

    def unproject(self, inverse_depth):
        """View-space positions of the centres of whole pixels, (rows, columns, 3)."""
        rows, columns = inverse_depth.shape
        x, y = np.meshgrid(np.arange(columns) + 0.5, np.arange(rows) + 0.5)
        z = 1 / np.maximum(inverse_depth, 1e-6)
        return np.stack([(x * SUBPIXELS - self.size[0] / 2) / self.focal * z, (y * SUBPIXELS - self.size[1] / 2) / self.focal * z, z], -1)


def barycentric(corners, x, y):
    """Weights (..., 3) of the triangles' corners (..., 3, >=2) at picture points."""
    (ax, ay), (bx, by), (cx, cy) = ((corners[..., i, 0], corners[..., i, 1]) for i in range(3))
    area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    u = ((bx - x) * (cy - y) - (by - y) * (cx - x)) / area
    v = ((cx - x) * (ay - y) - (cy - y) * (ax - x)) / area
    return np.stack([u, v, 1 - u - v], -1)


def rasterise(corners, size):
    """Which triangle shows in each subpixel, (rows, columns), -1 for none, and 1 / depth. Triangles of like size go in one batch."""
    columns, rows = size
    nearest = np.zeros(rows * columns, np.uint64)   # high half: 1 / depth, whose bits sort as it does; low half: triangle + 1
    low = np.clip(np.floor(corners[:, :, :2].min(1)), 0, size).astype(int)
    span = np.clip(np.ceil(corners[:, :, :2].max(1)), 0, size).astype(int) - low
    bucket = np.ceil(np.log2(np.maximum(span, 1)) * 2).astype(int)   # box sides in steps of a factor 1.41
    order = np.lexsort((bucket[:, 0], bucket[:, 1]))
    order = order[(span[order] > 0).all(1)]
    for same in np.split(order, np.flatnonzero(np.diff(bucket[order], axis=0).any(1)) + 1) if len(order) else []:
        width, height = span[same].max(0)
        step = max(1, 2_000_000 // (width * height))
        for ids in (same[i:i + step] for i in range(0, len(same), step)):
            x = low[ids, 0, None, None] + np.arange(width)[None, None, :]
            y = low[ids, 1, None, None] + np.arange(height)[None, :, None]
            weights = barycentric(corners[ids, None, None], x + 0.5, y + 0.5)
            hit = (weights >= 0).all(-1) & (x < columns) & (y < rows)
            which, iy, ix = np.nonzero(hit)
            inverse_depth = (weights[hit] * corners[ids[which], :, 2]).sum(-1).astype(np.float32)
            key = inverse_depth.view(np.uint32).astype(np.uint64) << np.uint64(32) | (ids[which] + 1).astype(np.uint64)
            np.maximum.at(nearest, (low[ids[which], 1] + iy) * columns + low[ids[which], 0] + ix, key)
    shown = (nearest & np.uint64(0xFFFFFFFF)).astype(int).reshape(rows, columns) - 1
    return shown, (nearest >> np.uint64(32)).astype(np.uint32).view(np.float32).reshape(rows, columns)


def openness(position, normal, reach):
    """Ambient light in 0..1 for each pixel, from its neighbours in the picture that rise above its plane within reach (metres)."""
    blocked, rows, columns = np.zeros(position.shape[:2]), *position.shape[:2]
    for i in range(48):   # a sunflower's spiral, out to 45 pixels
        turn, away = i * 2.39996, 45 * np.sqrt((i + 0.5) / 48)
        dx, dy = int(round(away * np.cos(turn))), int(round(away * np.sin(turn)))
        to = position[np.clip(np.arange(rows) + dy, 0, rows - 1)[:, None], np.clip(np.arange(columns) + dx, 0, columns - 1)] - position
        length = np.maximum(np.linalg.norm(to, axis=-1), 1e-9)
        blocked += np.clip((to * normal).sum(-1) / length - 0.12, 0, 1) * np.clip(2 - 2 * length / reach, 0, 1)
    return np.exp(-4.5 * blocked / 48)


def crease_coverage(lines, inverse_depth):
    """Where crease edges (k, 2 ends, 3), in picture space, show: discs along each, where the surface is not in front of them."""
    rows, columns = inverse_depth.shape
    covered, radius = np.zeros((rows, columns), bool), CREASE_WIDTH * SUBPIXELS / 2
    r = int(np.ceil(radius))
    dy, dx = (d[np.hypot(*np.mgrid[-r:r + 1, -r:r + 1]) <= radius] for d in np.mgrid[-r:r + 1, -r:r + 1])
    for a, b in lines:
        t = np.linspace(0, 1, int(np.linalg.norm((b - a)[:2]) / 1.5) + 2)[:, None]
        p = a + t * (b - a)
        x, y = (p[:, :1].astype(int) + dx).ravel(), (p[:, 1:2].astype(int) + dy).ravel()
        inside = (x >= 0) & (x < columns) & (y >= 0) & (y < rows)
        x, y, z = x[inside], y[inside], np.repeat(p[:, 2], len(dx))[inside]
        seen = inverse_depth[y, x] < z * 1.002   # lines lie on the surface: let them win by 0.2 % of the distance
        covered[y[seen], x[seen]] = True
    return covered


def draw(points, triangles, creases, target, azimuth, elevation, width, size):
    """The panel, (rows, columns, 3) in 0..1, and the lengths in metres of the edges of the triangles seen."""
    camera = Camera(target, azimuth, elevation, width, size)
    view = camera.view(points)
    ahead = view[:, 2] > 0.02 * width
    picture = camera.project(np.where(ahead[:, None], view, [0, 0, 1]))
    inside = ahead[triangles].all(1)
    for axis in range(2):
        inside &= (picture[triangles, axis].max(1) > 0) & (picture[triangles, axis].min(1) < camera.size[axis])
    triangles = triangles[inside]
    corners, place = picture[triangles], view[triangles]
    normals = np.cross(place[:, 1] - place[:, 0], place[:, 2] - place[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
    front = (normals * place[:, 0]).sum(1) < 0
    corners, place, normals = corners[front], place[front], normals[front]
    shown, inverse_depth = rasterise(corners, camera.size)

    solid = shown >= 0
    y, x = np.nonzero(solid)
    seen = shown[solid]
    # Light: a warm key from the upper left, a cool fill from the right, and the sky, dimmed in crotches.
    middle = (slice(SUBPIXELS // 2, None, SUBPIXELS),) * 2
    normal = np.where(solid[middle][..., None], normals[shown[middle]], 0)
    sky = np.kron(openness(camera.unproject(inverse_depth[middle]), normal, 0.2 * width), np.ones((SUBPIXELS, SUBPIXELS)))[solid]
    towards = lambda *d: np.clip(normals @ (np.array(d) / np.linalg.norm(d)), 0, 1)[:, None]
    key = (towards(-0.6, -0.5, -0.62) * [0.60, 0.565, 0.52] + towards(0.9, -0.1, -0.4) * [0.10, 0.12, 0.16])[seen]
    ambient = ((0.49 - 0.16 * normals[:, 1:2]) * [0.97, 1.0, 1.05])[seen]
    colour = WOOD * (key * (0.35 + 0.65 * sky[:, None]) + ambient * sky[:, None]) * 1.12
    # Wires: half of each from the triangle on either side, thinner and fainter where triangles are only a few pixels large.
    weights = barycentric(corners[seen], x + 0.5, y + 0.5)
    a, b, c = (corners[:, i, :2] for i in range(3))
    sides = np.stack([np.linalg.norm(c - b, axis=1), np.linalg.norm(a - c, axis=1), np.linalg.norm(b - a, axis=1)], 1)
    heights = np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])[:, None] / np.maximum(sides, 1e-9)
    inradius = heights[:, 0] * sides[:, 0] / np.maximum(sides.sum(1), 1e-9)
    half = np.minimum(WIRE_WIDTH * SUBPIXELS / 2, 0.22 * inradius)
    strength = np.clip(inradius / (3 * SUBPIXELS), 0.35, 1)[seen, None] * 0.8
    wired = (weights * heights[seen]).min(-1) < half[seen]
    colour[wired] += (strength * (WIRE - colour))[wired]
    lines = picture[creases][ahead[creases].all(1)]
    on_crease = crease_coverage(lines, inverse_depth)
    image = np.broadcast_to(PAPER, (*solid.shape, 3)).copy()
    image[solid] = colour
    image[on_crease] = CREASE
    # Mean of the subpixels in linear light, so that thin wires keep their weight.
    image = np.clip(image, 0, 1) ** 2.2
    image = image.reshape(size[1], SUBPIXELS, size[0], SUBPIXELS, 3).mean((1, 3)) ** (1 / 2.2)
    visible = np.unique(seen)
    return image, np.linalg.norm(place[visible] - np.roll(place[visible], 1, 1), axis=2)


def palette(image):
    """256 colours (256, 3) in 0..1 for the picture, and which of them each pixel takes: k-means over its histogram."""
    bins, which, count = np.unique((image * 63.99).astype(int) @ [4096, 64, 1], return_inverse=True, return_counts=True)
    colours = np.stack([np.bincount(which.ravel(), image[..., i].ravel()) for i in range(3)], 1) / count[:, None]
    weight = np.sqrt(count)   # else the paper and the wood leave too few to the creases
    chosen = colours[np.argsort(colours.sum(1))[np.linspace(0, len(bins) - 1, 256).astype(int)]]
    for _ in range(12):
        nearest = ((colours ** 2).sum(1)[:, None] - 2 * colours @ chosen.T + (chosen ** 2).sum(1)).argmin(1)
        total = np.bincount(nearest, weight, 256)
        mean = np.stack([np.bincount(nearest, weight * colours[:, i], 256) for i in range(3)], 1) / np.maximum(total, 1e-9)[:, None]
        chosen = np.where(total[:, None] > 0, mean, chosen)
    return chosen, nearest[which].reshape(image.shape[:2])


def write_png(path, image):
    """With a palette: a third of the size of full colour, and wires hide the steps."""
    colours, pixels = palette(image)
    data = np.pad(pixels.astype(np.uint8), ((0, 0), (1, 0))).tobytes()   # each row begins with its filter: none
    chunk = lambda kind, body: struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", pixels.shape[1], pixels.shape[0], 8, 3, 0, 0, 0))
                   + chunk(b"PLTE", np.round(colours * 255).astype(np.uint8).tobytes())
                   + chunk(b"IDAT", zlib.compress(data, 9)) + chunk(b"IEND", b""))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("picture")
    parser.add_argument("--panel", nargs=7, action="append", required=True,
                        metavar=("MESH", "X", "Y", "Z", "AZIMUTH", "ELEVATION", "WIDTH"))
    parser.add_argument("--size", default="700x700", help="of each panel, in pixels")
    arguments = parser.parse_args()
    size = tuple(int(n) for n in arguments.size.split("x"))
    panels = []
    for path, *numbers in arguments.panel:
        x, y, z, azimuth, elevation, width = map(float, numbers)
        image, edges = draw(*read_ply(path), (x, y, z), azimuth, elevation, width, size)
        smallest, median, largest = np.quantile(edges, [0, 0.5, 1]) * 1000
        print(f"{path}: {len(edges)} triangles seen, edges of {smallest:.2f} to {largest:.1f} mm, median {median:.2f} mm")
        panels += [np.broadcast_to(np.ones(3), (size[1], SEAM, 3)), image]
    write_png(arguments.picture, np.concatenate(panels[1:], 1))


if __name__ == "__main__":
    main()
