"""What is asked of the loader, checked."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Literal

from auvgym.ocean.mission import Place, parse_place

PathLike = str | os.PathLike[str]
Missing = Literal["fill", "error", "land"]
TimeWish = str | datetime | Sequence[str | datetime] | None


@dataclass(frozen=True)
class Request:
    """The arguments of :func:`auvgym.ocean.load`, which explains them."""

    currents: PathLike | None
    bathymetry: PathLike | None
    start: Sequence[float]
    goal: Sequence[float]
    vehicle_speed_mps: float = 1.0
    time: TimeWish = None
    depth_m: float | None = None
    margin_m: float | None = None
    dimensions: int = 2
    max_depth_m: float | None = None
    missing: Missing = "fill"
    time_factor: float = 4.0
    name: str | None = None
    current_names: tuple[str, str] | None = None
    bathymetry_name: str | None = None
    bathymetry_positive: str | None = None

    def check(self) -> None:
        """Raise ValueError naming the first argument that cannot be, its value and the rule."""
        if self.currents is None and self.bathymetry is None:
            raise ValueError("currents=None, bathymetry=None: at least one file is needed")
        if self.dimensions not in (2, 3):
            raise ValueError(f"dimensions={self.dimensions!r}: must be 2 or 3")
        if self.missing not in ("fill", "error", "land"):
            raise ValueError(f'missing={self.missing!r}: must be "fill", "error" or "land"')
        for key in ("vehicle_speed_mps", "margin_m", "max_depth_m"):
            value = getattr(self, key)
            if value is not None and not (math.isfinite(value) and value > 0.0):
                raise ValueError(f"{key}={value!r}: must be greater than 0")
        if self.dimensions == 2 and self.max_depth_m is not None:
            raise ValueError(
                f"max_depth_m={self.max_depth_m!r}: is for dimensions=3; 2-D has one depth_m"
            )
        if self.depth_m is not None and not (math.isfinite(self.depth_m) and self.depth_m >= 0.0):
            raise ValueError(f"depth_m={self.depth_m!r}: must be 0 (the surface) or more")
        if not (math.isfinite(self.time_factor) and self.time_factor >= 1.0):
            raise ValueError(f"time_factor={self.time_factor!r}: must be at least 1")

    def places(self) -> tuple[Place, Place]:
        """Start and goal; in 2-D at one depth. Raises ValueError naming the argument."""
        start = parse_place("start", self.start, self.depth_m)
        goal = parse_place("goal", self.goal, self.depth_m)
        given = {"start": start.depth, "goal": goal.depth}
        if self.depth_m is not None:
            given["depth_m"] = self.depth_m
        if self.dimensions == 2 and len(set(given.values())) > 1:
            told = ", ".join(f"{key} {depth:g} m" for key, depth in given.items())
            raise ValueError(
                f"depths differ ({told}): with dimensions=2 all of the mission has one depth; "
                "say it once, or use dimensions=3"
            )
        for place in (start, goal):
            if self.max_depth_m is not None and place.depth > self.max_depth_m:
                raise ValueError(
                    f"{place.name} depth {place.depth:g} m: max_depth_m={self.max_depth_m:g} "
                    "is the deepest allowed"
                )
        return start, goal
