"""Obstacles as triangles, few enough that a page of them stays small. Metres, depth down."""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from auvgym.rendering.shapes import Obstacle, depth_range, outline
from auvgym.rendering.subjects import Points

Faces = NDArray[np.int32]


class Mesh(NamedTuple):
    """Triangles: vertices (v, 3) m and faces (f, 3), each the numbers of its corners."""

    vertices: Points
    faces: Faces


def obstacle_mesh(obstacle: Obstacle, top_m: float, bottom_m: float) -> Mesh:
    """The mesh of one obstacle; what has no ends is cut off at ``top_m`` and ``bottom_m``."""
    kind = obstacle["kind"]
    if kind == "sphere":
        unit = _unit_sphere()
        centre = np.asarray(obstacle["position_m"], dtype=np.float64)
        return Mesh(centre + float(obstacle["radius_m"]) * unit.vertices, unit.faces)
    if kind == "superquadric":
        return _superquadric(obstacle)
    ends = np.clip(depth_range(obstacle), top_m, bottom_m)
    return _prism(outline(obstacle), float(ends[0]), float(ends[1]))


def merge(meshes: Iterable[Mesh]) -> Mesh:
    """One mesh of many."""
    vertices: list[Points] = [np.empty((0, 3))]
    faces: list[Faces] = [np.empty((0, 3), dtype=np.int32)]
    count = 0
    for mesh in meshes:
        vertices.append(mesh.vertices)
        faces.append(mesh.faces + np.int32(count))
        count += len(mesh.vertices)
    return Mesh(np.concatenate(vertices), np.concatenate(faces))


@lru_cache(maxsize=1)
def _unit_sphere() -> Mesh:
    """An icosahedron with every face divided in four: 42 vertices, 80 faces."""
    golden = (1.0 + 5.0**0.5) / 2.0
    corners = [(0.0, a, b * golden) for a in (-1.0, 1.0) for b in (-1.0, 1.0)]
    rolled = [np.roll(corner, turn) for turn in range(3) for corner in corners]
    vertices = [corner / np.linalg.norm(corner) for corner in rolled]
    edge = min(float(np.linalg.norm(vertices[0] - other)) for other in vertices[1:]) * 1.01
    near = [
        {k for k, other in enumerate(vertices) if 0.0 < np.linalg.norm(vertex - other) < edge}
        for vertex in vertices
    ]
    faces = []
    middles: dict[tuple[int, int], int] = {}

    def between(first: int, second: int) -> int:
        key = (min(first, second), max(first, second))
        if key not in middles:
            middle = vertices[first] + vertices[second]
            middles[key] = len(vertices)
            vertices.append(middle / np.linalg.norm(middle))
        return middles[key]

    for a in range(12):
        for b in sorted(near[a]):
            for c in sorted(near[a] & near[b]):
                if a < b < c:
                    ab, bc, ca = between(a, b), between(b, c), between(c, a)
                    faces += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
    sphere = np.array(vertices)
    triangles = np.array(faces, dtype=np.int32)
    # Anticlockwise seen from outside, so that all faces are lit alike.
    first, second, third = (sphere[triangles[:, corner]] for corner in range(3))
    outwards = np.cross(second - first, third - first)
    inward = np.einsum("ij,ij->i", outwards, first + second + third) < 0.0
    triangles[inward] = triangles[inward][:, ::-1]
    return Mesh(sphere, triangles)


def _superquadric(obstacle: Obstacle, rows: int = 11, columns: int = 20) -> Mesh:
    # |x/a|^ex + |y/b|^ey + |z/c|^ez = 1: the unit sphere's squares share the one among the terms.
    rise = np.linspace(-np.pi / 2, np.pi / 2, rows)[:, None]
    turn = np.linspace(0.0, 2.0 * np.pi, columns, endpoint=False)[None, :]
    sphere = np.stack(
        [np.cos(rise) * np.cos(turn), np.cos(rise) * np.sin(turn), np.sin(rise) + 0.0 * turn],
        axis=-1,
    ).reshape(-1, 3)
    exponents = np.asarray(obstacle["exponents"], dtype=np.float64)
    semi = np.asarray(obstacle["semi_axes_m"], dtype=np.float64)
    centre = np.asarray(obstacle["position_m"], dtype=np.float64)
    vertices = centre + np.sign(sphere) * semi * (sphere**2) ** (1.0 / exponents)
    row, column = np.meshgrid(np.arange(rows - 1), np.arange(columns), indexing="ij")
    here = (row * columns + column).ravel()
    beside = (row * columns + (column + 1) % columns).ravel()
    faces = np.concatenate(
        [
            np.stack([here, beside, beside + columns], axis=-1),
            np.stack([here, beside + columns, here + columns], axis=-1),
        ]
    )
    return Mesh(vertices, faces.astype(np.int32))


def _prism(ring: Points, top_m: float, bottom_m: float) -> Mesh:
    """Walls under an outline (k, 2) and its two lids."""
    count = len(ring)
    vertices = np.vstack(
        [np.column_stack([ring, np.full(count, depth)]) for depth in (top_m, bottom_m)]
    )
    here = np.arange(count)
    beside = (here + 1) % count
    walls = [
        np.stack([here, beside, beside + count], axis=-1),
        np.stack([here, beside + count, here + count], axis=-1),
    ]
    lid = triangulate(ring)
    return Mesh(vertices, np.concatenate([*walls, lid, lid + count]).astype(np.int32))


def triangulate(ring: Points) -> Faces:
    """Faces (k - 2, 3) that fill a simple polygon (k, 2), by cutting off its ears."""
    turn = 1.0 if _area(ring) > 0.0 else -1.0
    left = list(range(len(ring)))
    faces = []
    while len(left) > 3:
        for place in range(len(left)):
            a, b, c = left[place - 1], left[place], left[(place + 1) % len(left)]
            others = [k for k in left if k not in (a, b, c)]
            if turn * _area(ring[[a, b, c]]) > 0.0 and not _any_within(
                ring[others], ring[[a, b, c]] if turn > 0 else ring[[c, b, a]]
            ):
                break
        else:
            # No ear: corners in a line or an outline that crosses itself. Any cut will do.
            place = 0
            a, b, c = left[-1], left[0], left[1]
        faces.append((a, b, c))
        del left[place]
    faces.append((left[0], left[1], left[2]))
    return np.array(faces, dtype=np.int32)


def _area(ring: Points) -> float:
    """Signed area, positive anticlockwise."""
    x, y = ring[:, 0] - ring[0, 0], ring[:, 1] - ring[0, 1]
    return float(0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


def _any_within(points: Points, triangle: Points) -> bool:
    """Whether a point lies in or on an anticlockwise triangle."""
    within = np.ones(len(points), dtype=np.bool_)
    for first, second in zip(triangle, np.roll(triangle, -1, axis=0), strict=True):
        edge, offset = second - first, points - first
        within &= edge[0] * offset[:, 1] - edge[1] * offset[:, 0] >= 0.0
    return bool(within.any())
