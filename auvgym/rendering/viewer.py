"""The viewer: a world and an episode in, a frame out, on a window or as an array."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from auvgym.rendering import chart, marks, palette, panel, profile, strips
from auvgym.rendering.canvas import Canvas, load_pygame
from auvgym.rendering.currents import Flow
from auvgym.rendering.layout import SMALLEST, Layout, arrange
from auvgym.rendering.subjects import Episode, Facts, Points, World

RENDER_MODES = ("human", "rgb_array")
RENDER_FPS = 30
# A current that varies is painted again after this share of the time limit or of the depth.
REPAINT_TIME_SHARE = 1.0 / 60.0
REPAINT_DEPTH_SHARE = 1.0 / 40.0


class Viewer:
    """Draws episodes: a chart, a depth profile (or strips along time) and a status panel.

    Nothing is drawn, and pygame not imported, before the first frame. Images need no display and
    open no window. The layers that stay (seabed, axes, legend) are drawn once per map.

    Args:
        render_mode: ``"human"`` shows each frame in a window, ``"rgb_array"`` returns it.
        size: (width, height) of a frame, pixels.
        title: of the window.

    Raises:
        ValueError: an unknown render mode, or a size too small to read.
        ImportError: at the first frame, without pygame; says which extra brings it.
    """

    def __init__(
        self,
        render_mode: str,
        size: tuple[int, int] = (1120, 800),
        title: str = "auvgym",
    ) -> None:
        if render_mode not in RENDER_MODES:
            raise ValueError(f"render_mode is {render_mode!r}; allowed: {', '.join(RENDER_MODES)}")
        if size[0] < SMALLEST[0] or size[1] < SMALLEST[1]:
            raise ValueError(f"size is {size}; at least {SMALLEST} pixels are needed")
        self.render_mode = render_mode
        self.size = (int(size[0]), int(size[1]))
        self.title = title
        self._scene: _Scene | None = None
        self._window: Any = None
        self._clock: Any = None
        self._shut = False

    def frame(
        self, world: World, episode: Episode, plan: Points | None = None
    ) -> NDArray[np.uint8] | None:
        """Draw the episode as it stands.

        Args:
            world: at the present time.
            episode: in that world.
            plan: (n, 3) m, a way to draw, or None.

        Returns:
            (height, width, 3) uint8 in ``"rgb_array"`` mode, None in ``"human"`` mode. Once the
            user has closed the window frames are no longer drawn until :meth:`close`.
        """
        if self._shut:
            return None
        if self._scene is None or not self._scene.shows(world):
            self._scene = _Scene(self.size, world)
        picture = self._scene.draw(world, episode, plan)
        if self.render_mode == "human":
            self._show(picture)
            return None
        return picture.pixels()

    def close(self) -> None:
        """Close the window, if any, and forget the drawn layers; calling it again is harmless."""
        self._scene = None
        self._shut = False
        if self._window is not None:
            load_pygame().display.quit()
            self._window = self._clock = None

    def _show(self, picture: Canvas) -> None:
        pygame = picture.pygame
        if self._window is None:
            pygame.display.init()
            pygame.display.set_caption(self.title)
            self._window = pygame.display.set_mode(self.size)
            self._clock = pygame.time.Clock()
        self._window.blit(picture.surface, (0, 0))
        pygame.display.flip()
        self._clock.tick(RENDER_FPS)
        if any(event.type == pygame.QUIT for event in pygame.event.get()):
            self.close()
            self._shut = True


class _Scene:
    """The layers of one map at one size."""

    def __init__(self, size: tuple[int, int], world: World) -> None:
        self.scenario, self.mission = world.scenario, world.mission
        self.facts = Facts.of(world)
        self.layout: Layout = arrange(size, self.facts)
        self.ground = chart.survey(self.layout.chart_axes, world, self.facts)
        self.still = Canvas(size=size)
        self.still.surface.fill(palette.PAGE)
        chart.draw_frame(self.still, self.layout.chart, self.layout.chart_axes, self.facts)
        panel.draw_card(self.still, self.layout.panel, self.facts)
        (strips if self.facts.flat else profile).draw_card(self.still, self.layout.strip)
        self.painted: Canvas | None = None
        self.painted_for: tuple[int, ...] = ()

    def shows(self, world: World) -> bool:
        """Whether this scene was made for the world's map."""
        return bool(self.mission == world.mission and self.scenario == world.scenario)

    def draw(self, world: World, episode: Episode, plan: Points | None) -> Canvas:
        """A picture of the episode on a surface of its own."""
        layout, facts = self.layout, self.facts
        depth_m = float(episode.position[2])
        picture = self._with_current(world, episode, depth_m).copy()
        snapshot = world.snapshot()
        picture.clip(layout.chart_axes.box)
        marks.draw_obstacles(picture, layout.chart_axes, snapshot, facts, depth_m)
        chart.draw_scale_bar(picture, layout.chart_axes, facts)
        # Starts lie on the edge of many worlds: their marks may reach beyond it.
        picture.clip(layout.chart_axes.box.inset(-10, -10, -10, -10))
        marks.draw_goal(picture, layout.chart_axes, facts)
        marks.draw_course(picture, layout.chart_axes, episode, plan)
        picture.clip(None)
        if facts.flat:
            strips.draw_strips(picture, layout.strip, episode, facts)
        else:
            profile.draw_profile(picture, layout.strip, world, snapshot, episode, plan, facts)
        panel.draw_status(picture, layout.panel, world, episode, facts)
        return picture

    def _with_current(self, world: World, episode: Episode, depth_m: float) -> Canvas:
        """The still layer with the chart and its current; painted anew when that has changed."""
        extent = float(self.facts.maximum[2] - self.facts.minimum[2])
        time_step = REPAINT_TIME_SHARE * episode.time_limit_s
        wanted = (
            world.changes,
            0 if self.facts.steady else int(episode.time_s / time_step),
            int(depth_m / (REPAINT_DEPTH_SHARE * extent)) if self.facts.layered else 0,
        )
        if self.painted is None or wanted != self.painted_for:
            axes = self.layout.chart_axes
            flow = Flow.sample(world, axes, depth_m, self.facts)
            self.painted = self.still.copy()
            chart.paint(self.painted, axes, self.ground, flow, self.facts)
            chart.draw_colour_bar(self.painted, axes, self.ground, flow, self.facts)
            self.painted_for = wanted
        return self.painted
