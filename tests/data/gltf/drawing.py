"""Makes drawing.vrm, and drawing.png as it should look: python3 drawing.py FOLDER (takes numpy and Pillow).

A ball, a box and a floor in MToon's paint, written byte by byte after the specifications of glTF 2.0 and
VRMC_materials_mtoon 1.0. The picture is traced: 16 rays a pixel to the nearest triangle, and one to the sun.
"""
import json
import struct
import sys
from pathlib import Path

import numpy as np
from PIL import Image

WIDTH, HEIGHT, PER_SIDE = 160, 90, 4
PAPER = np.array([0.72, 0.66, 0.52])
EYE, TARGET, FOV = np.array([2.9, 3.3, 7.6]), np.array([0.15, 0.75, 0.0]), 0.5
TO_SUN = np.array([-4.0, 6.0, 3.0]) / np.sqrt(61)


def ball(columns=32, rows=16, center=(-0.9, 1.0, 0.0)):
    angles = [(np.pi * (r / rows - 0.5), 2 * np.pi * c / columns) for r in range(rows + 1) for c in range(columns)]
    normals = np.array([(np.cos(a) * np.sin(b), np.sin(a), np.cos(a) * np.cos(b)) for a, b in angles])
    at = lambda r, c: r * columns + c % columns
    faces = []
    for r in range(rows):
        for c in range(columns):
            if r > 0:
                faces.append((at(r, c), at(r, c + 1), at(r + 1, c + 1)))
            if r < rows - 1:
                faces.append((at(r, c), at(r + 1, c + 1), at(r + 1, c)))
    return normals + center, normals, np.array(faces)


def box(center, half):
    """Six faces of four corners each, with the faces' normals."""
    places, normals, faces = [], [], []
    for axis in range(3):
        for side in (-1, 1):
            u, v = np.eye(3)[(axis + 1) % 3] * side, np.eye(3)[(axis + 2) % 3]
            normal, first = np.eye(3)[axis] * side, len(places)
            for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                places.append(normal + s * u + t * v)
                normals.append(normal)
            faces += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
    return np.array(places) * half + center, np.array(normals), np.array(faces)


def outwards(places, normals):
    """For each corner the mean of the normals at its place."""
    key = [tuple(np.round(p, 6)) for p in places]
    sums = {k: np.sum([n for j, n in zip(key, normals) if j == k], axis=0) for k in set(key)}
    mean = np.array([sums[k] for k in key])
    return mean / np.linalg.norm(mean, axis=1)[:, None]


PAINTS = [  # name, lit, shade, glow, toony, shift, outline's mode, width, colour
    ("ball", (0.9, 0.35, 0.1), (0.4, 0.08, 0.1), (0, 0, 0), 0.9, -0.1, "worldCoordinates", 0.04, (0.05, 0.02, 0.1)),
    ("box", (0.15, 0.5, 0.55), (0.04, 0.16, 0.3), (0.02, 0.05, 0), 1.0, 0.0, "screenCoordinates", 0.012, (0, 0, 0)),
    ("floor", (0.5, 0.65, 0.4), (0.2, 0.33, 0.36), (0, 0, 0), 0.5, 0.1, "none", 0, (0, 0, 0))]
MESHES = [ball(), box(np.array([1.2, 0.7, -0.3]), np.array([0.6, 0.7, 0.6])),
          box(np.array([0, -0.1, 0]), np.array([2.4, 0.1, 1.5]))]


def write_file(path):
    data, views, accessors = b"", [], []

    def add(array, kind, component):
        nonlocal data
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": array.nbytes})
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "type": kind,
                          "count": array.size // (3 if kind == "VEC3" else 1)})
        if kind == "VEC3":
            accessors[-1].update(min=array.min(0).tolist(), max=array.max(0).tolist())
        data += array.tobytes()
        return len(accessors) - 1

    meshes, materials = [], []
    for i, ((places, normals, faces), paint) in enumerate(zip(MESHES, PAINTS)):
        name, lit, shade, glow, toony, shift, mode, width, color = paint
        meshes.append({"name": name, "primitives": [{"material": i, "attributes": {
            "POSITION": add(places.astype("<f4"), "VEC3", 5126), "NORMAL": add(normals.astype("<f4"), "VEC3", 5126)},
            "indices": add(faces.astype("<u4").ravel(), "SCALAR", 5125)}]})
        materials.append({
            "name": name, "pbrMetallicRoughness": {"baseColorFactor": [*lit, 1], "metallicFactor": 0},
            "emissiveFactor": glow, "extensions": {"KHR_materials_unlit": {}, "VRMC_materials_mtoon": {
                "specVersion": "1.0", "shadeColorFactor": shade, "shadingToonyFactor": toony,
                "shadingShiftFactor": shift, "outlineWidthMode": mode, "outlineWidthFactor": width,
                "outlineColorFactor": color}}})
    right, up, back = view_axes()
    axes = np.eye(4)
    axes[:3, 0], axes[:3, 1], axes[:3, 2], axes[:3, 3] = right, up, back, EYE
    x = np.cross([0, 1, 0], TO_SUN) / np.linalg.norm(np.cross([0, 1, 0], TO_SUN))  # a light shines along -z
    sun = np.eye(4)
    sun[:3, 0], sun[:3, 1], sun[:3, 2] = x, np.cross(TO_SUN, x), TO_SUN
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(5))}],
        "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_unlit", "VRMC_materials_mtoon"],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 3}]}},
        "nodes": [{"mesh": i} for i in range(3)] + [
            {"camera": 0, "matrix": axes.T.ravel().tolist()},
            {"matrix": sun.T.ravel().tolist(), "extensions": {"KHR_lights_punctual": {"light": 0}}}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": FOV, "znear": 0.1}}],
        "meshes": meshes, "materials": materials, "accessors": accessors, "bufferViews": views,
        "buffers": [{"byteLength": len(data)}]}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    path.write_bytes(struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(data), len(text), 0x4E4F534A) + text +
                     struct.pack("<II", len(data), 0x004E4942) + data)


def view_axes():
    back = (EYE - TARGET) / np.linalg.norm(EYE - TARGET)
    right = np.cross([0, 1, 0], back)
    right /= np.linalg.norm(right)
    return right, np.cross(back, right), back


# A ray from o along w meets the triangle a, a + e1, a + e2 where o + t w = a + u e1 + v e2. By Cramer's rule
# t, u and v are quotients of determinants, with s = o - a and det = w . (e2 x e1).

def seen(ways, a, e1, e2):
    """Of each ray from the eye the nearest front face: its distance (or infinity), number and weights."""
    s = EYE - a
    with np.errstate(all="ignore"):
        det = ways @ np.cross(e2, e1).T
        u, v = ways @ np.cross(e2, s).T / det, ways @ np.cross(s, e1).T / det
        t = np.einsum("tk,tk->t", e2, np.cross(s, e1)) / det
        t = np.where((u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0) & (det > 0), t, np.inf)
    nearest, rows = t.argmin(1), np.arange(len(ways))
    return t[rows, nearest], nearest, u[rows, nearest], v[rows, nearest]


def sees_sun(points, a, e1, e2):
    """Whether no triangle, front or back, is between each point and the sun."""
    p, q, n = np.cross(TO_SUN, e2), np.cross(e1, TO_SUN), np.cross(e1, e2)
    with np.errstate(all="ignore"):
        det = np.einsum("tk,tk->t", e1, p)
        u, v, t = ((points @ w.T - np.einsum("tk,tk->t", a, w)) / det for w in (p, q, n))
        return ~((u >= 0) & (v >= 0) & (u + v <= 1) & (t > 1e-4)).any(1)


def picture():
    right, up, back = view_axes()
    corners, normals, paint_of, is_hull = [], [], [], []
    for i, ((places, own, faces), paint) in enumerate(zip(MESHES, PAINTS)):
        corners.append(places[faces]), normals.append(own[faces])
        paint_of += [i] * len(faces)
        is_hull += [False] * len(faces)
        if paint[6] != "none":
            width = np.full(len(places), paint[7])
            if paint[6] == "screenCoordinates":  # a share of the picture's height, where the corner is
                width = width * ((EYE - places) @ back) * 2 * np.tan(FOV / 2)
            pushed = places + width[:, None] * outwards(places, own)
            corners.append(pushed[faces[:, ::-1]]), normals.append(own[faces[:, ::-1]])
            paint_of += [i] * len(faces)
            is_hull += [True] * len(faces)
    corners, normals = np.concatenate(corners), np.concatenate(normals)
    paint_of, is_hull = np.array(paint_of), np.array(is_hull)
    a, e1, e2 = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    casters = ~is_hull

    width, height = WIDTH * PER_SIDE, HEIGHT * PER_SIDE
    y, x = np.divmod(np.arange(width * height), width)
    half = np.tan(FOV / 2)
    ways = (((2 * (x + 0.5) / width - 1) * half * WIDTH / HEIGHT)[:, None] * right +
            ((1 - 2 * (y + 0.5) / height) * half)[:, None] * up - back)
    colors = np.empty((width * height, 3))
    for first in range(0, len(ways), 2048):
        way = ways[first:first + 2048]
        t, which, u, v = seen(way, a, e1, e2)
        point = EYE + np.where(np.isfinite(t), t, 0)[:, None] * way
        n = normals[which]
        normal = n[:, 0] + u[:, None] * (n[:, 1] - n[:, 0]) + v[:, None] * (n[:, 2] - n[:, 0])
        cosine = (normal / np.linalg.norm(normal, axis=1)[:, None]) @ TO_SUN
        # From a cosine of 0.1 on a surface gets all light (lesson 09), so it gets half from 0.05 on.
        is_lit = sees_sun(point, a[casters], e1[casters], e2[casters]) & (cosine >= 0.05)
        paints = [PAINTS[i] for i in paint_of[which]]
        column = lambda k: np.array([p[k] for p in paints], dtype=float)
        toony, turned = column(4), cosine + column(5)
        with np.errstate(all="ignore"):
            ramp = np.clip((turned + 1 - toony) / (2 * (1 - toony)), 0, 1)
        step = np.where(toony >= 1, turned >= 0, ramp) * is_lit
        color = column(3) + column(2) + step[:, None] * (column(1) - column(2))
        color = np.where(is_hull[which][:, None], column(8), color)
        colors[first:first + 2048] = np.where(np.isfinite(t)[:, None], color, PAPER)
    mean = np.clip(colors, 0, 1).reshape(HEIGHT, PER_SIDE, WIDTH, PER_SIDE, 3).mean((1, 3))
    codes = np.where(mean <= 0.0031308, 12.92 * mean, 1.055 * mean ** (1 / 2.4) - 0.055)
    return Image.fromarray(np.round(255 * codes).astype("uint8"))


folder = Path(sys.argv[1])
write_file(folder / "drawing.vrm")
picture().save(folder / "drawing.png")
