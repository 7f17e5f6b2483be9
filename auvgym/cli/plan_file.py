"""A plan's waypoints as a JSON or CSV file, with longitude and latitude where there are any."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import auvgym

_SUFFIXES = (".json", ".csv")
_LOCAL = ("x_m", "y_m", "z_m")
_EARTH = ("longitude_deg", "latitude_deg")


def check_suffix(path: Path) -> None:
    """Refuse a file whose format its name does not tell, before anything is planned."""
    if path.suffix.lower() not in _SUFFIXES:
        raise ValueError(f'--out is "{path}"; its name must end in {" or ".join(_SUFFIXES)}')


def write_plan(path: Path, world: auvgym.World, plan: auvgym.Plan, seed: int) -> None:
    """Write ``plan``: one row per waypoint in CSV; with what it took to find it in JSON."""
    columns, rows = _waypoints(world, plan)
    path.parent.mkdir(parents=True, exist_ok=True)
    if path.suffix.lower() == ".csv":
        with path.open("w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(columns)
            writer.writerows(rows)
        return
    content = {
        "scenario": world.scenario.name,
        "scenario_hash": world.scenario.hash,
        "planner": plan.planner,
        "seed": seed,
        "feasible": bool(plan.feasible),
        "cost": {key: float(value) for key, value in plan.cost.items()},
        "evaluations": int(plan.evaluations),
        "waypoints": [dict(zip(columns, row, strict=True)) for row in rows],
    }
    path.write_text(json.dumps(content, indent=2) + "\n", encoding="utf-8")


def _waypoints(world: auvgym.World, plan: auvgym.Plan) -> tuple[tuple[str, ...], list[list[float]]]:
    import numpy as np

    local = np.asarray(plan.waypoints, dtype=np.float64)
    if not world.scenario.to_dict().get("projection"):
        return _LOCAL, local.tolist()
    from auvgym import ocean

    earth = ocean.to_lonlat(world.scenario, local[:, :2])
    return (*_EARTH, *_LOCAL), np.hstack([earth, local]).tolist()
