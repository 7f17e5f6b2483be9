"""Worlds in three dimensions: seabed surface, obstacle meshes, depth downwards."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from auvgym.rendering.axes import length_unit, number
from auvgym.rendering.shapes import Obstacle
from auvgym.rendering.subjects import Points, World
from auvgym.report import theme
from auvgym.report.meshes import Mesh, merge, obstacle_mesh
from auvgym.report.scene import Scene, Trace

SEABED_POINTS = 9000
# A world flatter than this share of its longest side is stretched to it.
FLATTEST = 0.3
LAND_HEIGHT = 0.03  # land is drawn this share of the depth above the surface
SHORE = 0.05  # share of the colour scale that is land
ROOM = 1.75  # length of the scene's diagonal, in plotly's unit; fills the figure


class Space(Scene):
    """A 3-D scene; depth has a unit of its own, for oceans are wide and shallow."""

    scatter_name = "Scatter3d"
    marker = 5.0

    def __init__(self, world: World) -> None:
        super().__init__(world)
        places, shape = self._seabed_grid()
        self._places = places.reshape(*shape, 2)
        self._floor = np.asarray(world.floor_depth(places), dtype=np.float64).reshape(shape)
        self.deepest_m = self._deepest()
        self.depth_size_m, self.depth_unit = length_unit(self.deepest_m)
        sides = self.facts.maximum[:2] - self.facts.minimum[:2]
        longest = float(sides.max())
        true_height = self.deepest_m / longest
        self.exaggeration = max(1.0, FLATTEST / true_height)
        aspect = np.array([*sides / longest, true_height * self.exaggeration])
        self.aspect = (ROOM * aspect / np.linalg.norm(aspect)).tolist()

    def coordinates(self, points: Points) -> dict[str, Any]:
        """``x`` and ``y`` in the scene's unit, ``z`` in that of depth."""
        thin = np.asarray(points, dtype=np.float64)
        return {
            "x": (thin[:, 0] / self.size_m).astype(np.float32),
            "y": (thin[:, 1] / self.size_m).astype(np.float32),
            "z": (thin[:, 2] / self.depth_size_m).astype(np.float32),
        }

    def ground(self) -> list[Trace]:
        """The seabed as a surface, land above it."""
        if not np.isfinite(self._floor).any():
            return []
        depth = np.clip(self._floor, -LAND_HEIGHT * self.deepest_m, self.deepest_m)
        land = self._floor <= 0.0
        shallowest = float(depth[~land].min(initial=self.deepest_m))
        # A flat floor has nothing to tell shallow from deep by: a middle blue.
        relief = self.deepest_m - shallowest
        shade = (depth - shallowest) / relief if relief > 1e-6 else np.full_like(depth, 0.6)
        return [
            self.go.Surface(
                x=(self._places[0, :, 0] / self.size_m).astype(np.float32),
                y=(self._places[:, 0, 1] / self.size_m).astype(np.float32),
                z=(depth / self.depth_size_m).astype(np.float32),
                surfacecolor=np.where(land, -1.0, shade).astype(np.float32),
                cmin=-SHORE / (1.0 - SHORE),
                cmax=1.0,
                colorscale=_with_land(theme.DEPTH_SCALE),
                showscale=False,
                name="seabed",
                hovertemplate=f"floor %{{z:.4g}} {self.depth_unit}<extra></extra>",
                lighting={"ambient": 0.6, "diffuse": 0.7, "specular": 0.05, "roughness": 0.9},
            )
        ]

    def flow(self, world: World, depth_m: float, fastest_mps: float) -> list[Trace]:
        """Arrows of the current."""
        depth = number(round(depth_m / self.depth_size_m, 2))
        name = f"current at {depth} {self.depth_unit}, up to {fastest_mps:.2g} m/s"
        return [
            self.go.Scatter3d(
                **self.coordinates(self.arrows(world, depth_m, fastest_mps)),
                mode="lines",
                name=name,
                line={"color": theme.CURRENT, "width": 2.5},
                hoverinfo="skip",
            )
        ]

    def obstacles(self, obstacles: Sequence[Obstacle]) -> Trace:
        """All obstacles as one mesh."""
        mesh = self._mesh(obstacles)
        kind = np.uint16 if len(mesh.vertices) < 65536 else np.int32
        i, j, k = (mesh.faces[:, corner].astype(kind) for corner in range(3))
        return self.go.Mesh3d(
            **self.coordinates(mesh.vertices),
            i=i,
            j=j,
            k=k,
            color=theme.OBSTACLE,
            opacity=0.5,
            flatshading=False,
            name="obstacles",
            hoverinfo="name",
            lighting={"ambient": 0.6, "diffuse": 0.7, "specular": 0.15, "roughness": 0.7},
        )

    def obstacles_update(self, obstacles: Sequence[Obstacle]) -> dict[str, Any]:
        """Vertices of the mesh."""
        return self.coordinates(self._mesh(obstacles).vertices)

    def layout(self) -> dict[str, Any]:
        """Axes, depth downwards, and camera."""
        low, high = self.facts.minimum / self.size_m, self.facts.maximum / self.size_m
        stretched = ""
        if self.exaggeration > 1.05:
            stretched = f", stretched {self.exaggeration:.2g} times"
        axis = {
            "backgroundcolor": "rgba(0,0,0,0)",
            "gridcolor": theme.RULE,
            "zeroline": False,
            "showspikes": False,
        }
        across, along = self.facts.axis_names
        bottom = self.deepest_m / self.depth_size_m
        return {
            "margin": {"l": 10, "r": 10, "t": 104, "b": 10},
            "scene": {
                "xaxis": {
                    **axis,
                    "title": {"text": f"{across} ({self.unit})"},
                    "range": [low[0], high[0]],
                },
                "yaxis": {
                    **axis,
                    "title": {"text": f"{along} ({self.unit})"},
                    "range": [low[1], high[1]],
                },
                "zaxis": {
                    **axis,
                    "title": {"text": f"depth ({self.depth_unit}{stretched})"},
                    "range": [1.02 * bottom, -1.5 * LAND_HEIGHT * bottom],
                },
                "aspectmode": "manual",
                "aspectratio": dict(zip("xyz", self.aspect, strict=True)),
                "camera": {
                    "eye": {"x": -1.3, "y": -0.95, "z": 0.85},
                    "center": {"x": 0.0, "y": 0.0, "z": -0.22},
                },
            },
        }

    def _seabed_grid(self) -> tuple[Points, tuple[int, int]]:
        low, high = self.facts.minimum[:2], self.facts.maximum[:2]
        sides = high - low
        columns = int(np.clip(np.sqrt(SEABED_POINTS * sides[0] / sides[1]), 12, 300))
        rows = int(np.clip(SEABED_POINTS / columns, 12, 300))
        x, y = np.linspace(low[0], high[0], columns), np.linspace(low[1], high[1], rows)
        return np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2), (rows, columns)

    def _deepest(self) -> float:
        """Bottom of the scene: the domain's, or the floor's where that is not too far below."""
        bottom = float(self.facts.maximum[2])
        floor = self._floor[np.isfinite(self._floor)]
        deepest = float(floor.max(initial=0.0))
        return max(bottom, min(deepest, 3.0 * bottom), 1e-3)

    def _mesh(self, obstacles: Sequence[Obstacle]) -> Mesh:
        top = float(min(self.facts.minimum[2], 0.0))
        return merge(obstacle_mesh(obstacle, top, self.deepest_m) for obstacle in obstacles)


def _with_land(scale: list[list[Any]]) -> list[list[Any]]:
    """The colours of land up to half of ``SHORE``, from ``SHORE`` on those of a depth scale."""
    shallow = scale[0][1]
    land = [[0.0, theme.LAND_FILL], [SHORE / 2, theme.LAND_FILL], [SHORE / 2, shallow]]
    return land + [[SHORE + (1.0 - SHORE) * at, ink] for at, ink in scale]
