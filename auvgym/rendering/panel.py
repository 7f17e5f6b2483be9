"""The status panel: outcome, what is left of time and energy, figures, a dial and the legend."""

from __future__ import annotations

import numpy as np

from auvgym.rendering import palette
from auvgym.rendering.axes import Box, length_unit, time_unit
from auvgym.rendering.canvas import Canvas
from auvgym.rendering.palette import Colour
from auvgym.rendering.subjects import Episode, Facts, Points, World

LINE = 23
LEGEND_LINE = 19


def draw_card(canvas: Canvas, card: Box, facts: Facts) -> None:
    """Card, scenario name and legend, under which nothing moves."""
    canvas.box(card, fill=palette.CARD, radius=8)
    room = card.width - 120
    height = 21 if len(facts.name) * 10.5 < room else 17
    name = _short(facts.name, int(room / (0.5 * height)))
    canvas.text((card.left + 14, card.top + 20), name, height, palette.INK, (0.0, 0.5))
    left, right = _columns(card)
    entries = _legend(facts)
    box = right if right is not left else left
    across = 2 if right is left else 1
    rows = -(-len(entries) // across)
    top = card.bottom - 12 - rows * LEGEND_LINE
    for index, (kind, ink, label) in enumerate(entries):
        x = box.left + (index % across) * box.width / across
        y = top + (index // across) * LEGEND_LINE + 9
        _symbol(canvas, kind, x, y, ink)
        canvas.text((x + 28, y), label, 16, palette.SOFT_INK, (0.0, 0.5))


def draw_status(canvas: Canvas, card: Box, world: World, episode: Episode, facts: Facts) -> None:
    """Everything on the panel that changes from frame to frame."""
    left, right = _columns(card)
    _draw_outcome(canvas, card, episode.outcome)
    position = np.asarray(episode.position, dtype=np.float64)
    distance = float(np.linalg.norm(position - facts.goal))
    y = left.top
    spent = (
        ("time", episode.time_s, episode.time_limit_s, time_unit(episode.time_limit_s)),
        ("energy", episode.energy_j, episode.energy_budget_j, _energy_unit(episode)),
    )
    for label, used, limit, (size, unit) in spent:
        value = f"{used / size:.2f} / {limit / size:.2f} {unit}"
        y = _bar(canvas, left, y, label, used / limit, value)
    come = 1.0 - distance / max(facts.distance_m, 1e-9)
    y = _bar(canvas, left, y, "to the goal", come, _metres(distance), palette.GOAL)
    for label, value in _figures(world, episode, facts, position):
        canvas.text((left.left, y), label, 17, palette.SOFT_INK)
        canvas.text((left.right, y), value, 17, palette.INK, (1.0, 0.0))
        y += LINE
    current = np.asarray(world.current(position[None]))[0]
    below = Box(left.left, y + 8, left.width, 110)
    if right is not left:
        _draw_dial(canvas, right, episode, current, facts)
    elif below.bottom < card.bottom - 12 - 4 * LEGEND_LINE:
        _draw_dial(canvas, below, episode, current, facts)


def _columns(card: Box) -> tuple[Box, Box]:
    """Two columns on a wide card, the same one twice on a narrow card."""
    inner = card.inset(16, 46, 16, 12)
    if card.width < 460:
        return inner, inner
    width = 0.55 * inner.width
    rest = inner.width - width - 28
    return Box(inner.left, inner.top, width, inner.height), Box(
        inner.right - rest, inner.top, rest, inner.height
    )


def _draw_outcome(canvas: Canvas, card: Box, outcome: str) -> None:
    ink = palette.OUTCOMES[outcome]
    label = outcome.replace("_", " ")
    width = 18 + 8 * len(label)
    box = Box(card.right - width - 14, card.top + 9, width, 22)
    canvas.box(box, border=ink, radius=11)
    canvas.text((box.left + width / 2, box.top + 11.5), label, 17, ink, (0.5, 0.5))


def _bar(
    canvas: Canvas,
    box: Box,
    y: float,
    label: str,
    share: float,
    value: str,
    ink: Colour = palette.OUTCOMES["running"],
) -> float:
    canvas.text((box.left, y), label, 17, palette.SOFT_INK)
    canvas.text((box.right, y), value, 17, palette.INK, (1.0, 0.0))
    canvas.box((box.left, y + 16, box.width, 6), fill=palette.RULE, radius=3)
    part = float(np.clip(share, 0.0, 1.0))
    if ink != palette.GOAL and part > 0.85:
        ink = palette.OBSTACLE
    canvas.box((box.left, y + 16, max(part * box.width, 3), 6), fill=ink, radius=3)
    return y + 31


def _figures(
    world: World, episode: Episode, facts: Facts, position: Points
) -> list[tuple[str, str]]:
    """Label and value of the panel's lines."""
    current = np.asarray(world.current(position[None]))[0]
    figures = [("current here", f"{np.linalg.norm(current):.2f} m/s")]
    if not facts.flat:
        altitude = float(world.floor_depth(position[None, :2])[0]) - position[2]
        figures.append(("depth", _metres(position[2])))
        figures.append(("above the seabed", _metres(altitude)))
    figures.append(("nearest danger", _metres(float(world.clearance(position[None])[0]))))
    figures.append(("path flown", _metres(episode.path_length_m)))
    changes = str(world.changes)
    if facts.change_every_m is not None:
        left = max(facts.change_every_m - episode.distance_since_change_m, 0.0)
        changes += f"   next in {_metres(left)}"
    figures.append(("map changes", changes))
    return figures


def _metres(length_m: float) -> str:
    if not np.isfinite(length_m) or abs(length_m) > 1e7:
        return "none"
    size, unit = length_unit(abs(length_m))
    return f"{length_m / size:.2f} {unit}" if unit == "km" else f"{length_m:.0f} {unit}"


def _energy_unit(episode: Episode) -> tuple[float, str]:
    """(J in the unit, its name) that suits the budget."""
    for size, name in ((1e9, "GJ"), (1e6, "MJ"), (1e3, "kJ")):
        if episode.energy_budget_j >= size:
            return size, name
    return 1.0, "J"


def _draw_dial(canvas: Canvas, box: Box, episode: Episode, current: Points, facts: Facts) -> None:
    """Heading and current seen from above; the ring is the vehicle's own speed."""
    radius = min(46.0, box.width / 4)
    centre = np.array([box.left + radius + 6, box.top + radius + 8])
    canvas.dot(centre, radius, palette.RULE, 2)
    for quarter in range(4):
        out = np.array([np.sin(quarter * np.pi / 2), -np.cos(quarter * np.pi / 2)])
        canvas.line([centre + (radius - 5) * out, centre + radius * out], palette.SOFT_INK)
    heading = np.asarray(episode.heading, dtype=np.float64)[:2] * (1.0, -1.0)
    canvas.arrow(centre, centre + heading * radius, palette.VEHICLE, 2)
    flow = current[:2] * (1.0, -1.0) / facts.speed_mps
    flow *= min(1.0, 1.2 / max(float(np.hypot(*flow)), 1e-9))
    canvas.arrow(centre, centre + flow * radius, palette.CURRENT, 2)
    x = centre[0] + radius + 18
    canvas.text((x, centre[1] - 28), "heading", 17, palette.VEHICLE)
    canvas.text((x, centre[1] - 8), "current", 17, palette.CURRENT)
    canvas.text((x, centre[1] + 12), f"ring {facts.speed_mps:g} m/s", 17, palette.SOFT_INK)


def _legend(facts: Facts) -> list[tuple[str, Colour, str]]:
    entries = [
        ("vehicle", palette.VEHICLE, "vehicle"),
        ("line", palette.TRAIL, "flown"),
        ("dashes", palette.PLAN, "plan"),
        ("cross", palette.WAYPOINT, "waypoint"),
        ("ring", palette.START, "start"),
        ("ring", palette.GOAL, "goal"),
    ]
    if facts.flat:
        return [*entries, ("fill", palette.OBSTACLE, "obstacle")]
    return [
        *entries,
        ("fill", palette.OBSTACLE, "obstacle"),
        ("ring", palette.OBSTACLE_AWAY, "above or below"),
    ]


def _symbol(canvas: Canvas, kind: str, x: float, y: float, ink: Colour) -> None:
    if kind == "vehicle":
        canvas.polygon([(x + 19, y), (x + 3, y - 6), (x + 7, y), (x + 3, y + 6)], ink)
    elif kind == "line":
        canvas.line([(x, y), (x + 20, y)], ink, 2)
    elif kind == "dashes":
        canvas.dashes([(x, y), (x + 20, y)], ink, 2, 5)
    elif kind == "cross":
        canvas.line([(x + 6, y - 4), (x + 14, y + 4)], ink, 2)
        canvas.line([(x + 6, y + 4), (x + 14, y - 4)], ink, 2)
    elif kind == "fill":
        canvas.dot((x + 10, y), 6, ink)
    else:
        canvas.dot((x + 10, y), 6, ink, 2)


def _short(text: str, longest: int) -> str:
    return text if len(text) <= longest else text[: longest - 1] + "…"
