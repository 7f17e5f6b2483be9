"""The compiled engine. Everything here is private: the package wraps it.

Arrays come in as C-contiguous float64 (actions: float32) of exactly the stated shape; what comes
out is the caller's own. Held against the compiled module by ``mypy.stubtest``.
"""

from os import PathLike
from typing import Any, ClassVar, TypeAlias, final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "ActionError",
    "Episode",
    "Navigator",
    "PlanningError",
    "Scenario",
    "ScenarioError",
    "SectionProblem",
    "Source",
    "TimeField",
    "World",
    "__version__",
    "families",
    "list_planners",
    "maklink",
    "observation_layout",
    "path_cost",
    "plan",
    "replan",
    "run_phases",
    "sonar_directions",
]

__version__: str

_Point: TypeAlias = tuple[float, float, float]

# (gap_m, depth_m, corners (n, 3), trace (m, 2), barriers); these are only here, for type checkers:
# the engine has no such names.
FoundReport: TypeAlias = tuple[
    float | None, float, NDArray[np.float64], NDArray[np.float64], list[int]
]
# (planner, waypoints (n, 3), feasible, cost, evaluations, history (m, 2), window, harbor).
FoundPlan: TypeAlias = tuple[
    str,
    NDArray[np.float64],
    bool,
    dict[str, float],
    int,
    NDArray[np.float64],
    int | None,
    FoundReport | None,
]
# (ring (n, 2), numbers) of each zone or cell.
FoundRings: TypeAlias = list[tuple[NDArray[np.float64], list[int]]]

class ScenarioError(ValueError):
    """A scenario that is not allowed: names file, key, value and what was allowed."""

class ActionError(ValueError):
    """An action that is not allowed: names the entry, its value and what was allowed."""

class PlanningError(ValueError):
    """A planner, parameter or path that is not allowed: names it, its value, what was allowed."""

@final
class Scenario:
    """Everything a world is made of, checked."""

    __hash__: ClassVar[None]  # type: ignore[assignment]  # equal by value, without a hash
    @staticmethod
    def from_toml(text: str) -> Scenario: ...
    @staticmethod
    def from_json(text: str) -> Scenario: ...
    @staticmethod
    def load(path: str | PathLike[str]) -> Scenario: ...
    @staticmethod
    def generate(family: str, seed: int, parameters_json: str) -> Scenario: ...
    def to_toml(self) -> str: ...
    def to_json(self) -> str: ...
    def save(self, path: str | PathLike[str]) -> None: ...
    @property
    def hash(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def description(self) -> str: ...
    @property
    def family(self) -> str: ...
    @property
    def dimensions(self) -> int: ...
    @property
    def notes(self) -> list[str]: ...
    @property
    def missions(self) -> int: ...
    @property
    def projection(self) -> tuple[float, float] | None: ...
    def __eq__(self, value: object, /) -> bool: ...
    def __reduce__(self) -> tuple[Any, tuple[str]]: ...

@final
class World:
    """One scenario at one time, after the map changes so far."""

    def __new__(cls, scenario: Scenario, seed: int, mission: int) -> World: ...
    @staticmethod
    def restore(
        scenario: Scenario,
        seed: int,
        mission: int,
        changes: list[tuple[float, _Point]],
        time_s: float,
    ) -> World: ...
    @property
    def scenario(self) -> Scenario: ...
    @property
    def seed(self) -> int: ...
    @property
    def mission(self) -> int: ...
    @property
    def dimensions(self) -> int: ...
    @property
    def start(self) -> NDArray[np.float64]: ...
    @property
    def goal(self) -> NDArray[np.float64]: ...
    @property
    def domain(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
    @property
    def changes(self) -> list[tuple[float, _Point]]: ...
    @property
    def time_s(self) -> float: ...
    @time_s.setter
    def time_s(self, time_s: float) -> None: ...
    @property
    def is_steady(self) -> bool: ...
    def current(
        self, points: NDArray[np.float64], time_s: float | None = None
    ) -> NDArray[np.float64]: ...
    def clearance(
        self, points: NDArray[np.float64], time_s: float | None = None
    ) -> NDArray[np.float64]: ...
    def floor_depth(self, points: NDArray[np.float64]) -> NDArray[np.float64]: ...
    def apply_change(self, vehicle: _Point) -> bool: ...
    def snapshot_json(self, time_s: float | None = None) -> str: ...
    def copy(self) -> World: ...

@final
class Source:
    """Makes episodes from seeds."""

    @staticmethod
    def fixed(scenario: Scenario, mission: int) -> Source: ...
    @staticmethod
    def family(family: str, parameters_json: str) -> Source: ...
    def episode(self, seed: int) -> Episode: ...

@final
class Episode:
    """One episode."""

    def step(self, action: NDArray[np.float32]) -> tuple[NDArray[np.float32], float, bool]: ...
    def observe(self) -> NDArray[np.float32]: ...
    def info(self) -> dict[str, Any]: ...
    def charge(self, evaluations: int, replans: int) -> None: ...
    def action_for(self, waypoint: _Point) -> NDArray[np.float32]: ...
    def waypoint_of(self, action: NDArray[np.float32]) -> NDArray[np.float64]: ...
    @property
    def world(self) -> World: ...
    @property
    def dimensions(self) -> int: ...
    @property
    def seed(self) -> int: ...
    @property
    def position(self) -> NDArray[np.float64]: ...
    @property
    def heading(self) -> NDArray[np.float64]: ...
    @property
    def waypoint(self) -> NDArray[np.float64] | None: ...
    @property
    def trail(self) -> NDArray[np.float64]: ...
    @property
    def actions(self) -> NDArray[np.float32]: ...
    @property
    def time_s(self) -> float: ...
    @property
    def energy_j(self) -> float: ...
    @property
    def time_limit_s(self) -> float: ...
    @property
    def energy_budget_j(self) -> float: ...
    @property
    def straight_distance_m(self) -> float: ...
    @property
    def path_length_m(self) -> float: ...
    @property
    def distance_since_change_m(self) -> float: ...
    @property
    def tick_s(self) -> float: ...
    @property
    def outcome(self) -> str: ...
    def copy(self) -> Episode: ...
    def __copy__(self) -> Episode: ...
    def __deepcopy__(self, _memo: Any) -> Episode: ...
    def save(self) -> bytes: ...
    @staticmethod
    def load(bytes: bytes) -> Episode: ...  # noqa: A002
    def __reduce__(self) -> tuple[Any, tuple[bytes]]: ...

@final
class TimeField:
    """Times to the goal over a grid, through the world as it was when this was made."""

    def __new__(
        cls,
        world: World,
        goal: _Point | None = None,
        spacing_m: float | None = None,
        inflation_m: float | None = None,
    ) -> TimeField: ...
    @property
    def evaluations(self) -> int: ...
    def best_waypoint(
        self, world: World, position: _Point, reach_m: float
    ) -> NDArray[np.float64] | None: ...

@final
class SectionProblem:
    """A box of numbers and a cost."""

    def __new__(
        cls,
        world: World,
        start: _Point | None,
        goal: _Point | None,
        cost: str,
        options_json: str,
    ) -> SectionProblem: ...
    @property
    def low(self) -> NDArray[np.float64]: ...
    @property
    def high(self) -> NDArray[np.float64]: ...
    def evaluate(self, genes: NDArray[np.float64]) -> NDArray[np.float64]: ...
    def path(self, genes: NDArray[np.float64]) -> NDArray[np.float64]: ...

@final
class Navigator:
    """A vehicle's way from start to goal among threats that it sees."""

    def __new__(
        cls, world: World, start: _Point, goal: _Point, parameters_json: str
    ) -> Navigator: ...
    def see(self, position: _Point, radius_m: float, time_s: float) -> None: ...
    def forget(self, before_s: float) -> None: ...
    def threats(self, time_s: float) -> list[tuple[_Point, _Point, float]]: ...
    def course(
        self, position: _Point, time_s: float, tick_s: float
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...

def families() -> list[str]: ...
def observation_layout(dimensions: int) -> list[tuple[str, int, int, float, float, str]]: ...
def sonar_directions(dimensions: int) -> NDArray[np.float64]: ...
def list_planners() -> list[str]: ...
def maklink(
    world: World, start: _Point | None, goal: _Point | None, zones_json: str
) -> tuple[
    FoundRings,
    NDArray[np.float64],
    FoundRings,
    NDArray[np.float64],
    NDArray[np.int64],
    NDArray[np.int64],
]: ...
def plan(
    world: World,
    planner: str,
    start: _Point | None,
    goal: _Point | None,
    seed: int,
    parameters_json: str,
) -> FoundPlan: ...
def replan(
    world: World,
    path: NDArray[np.float64],
    position: _Point,
    planner: str,
    seed: int,
    window: int,
    parameters_json: str,
) -> FoundPlan: ...
def path_cost(
    world: World, waypoints: NDArray[np.float64], cost: str, options_json: str
) -> dict[str, float]: ...
def run_phases(
    world: World, planner: str, seed: int, window: int | None, parameters_json: str
) -> list[tuple[float, bool, int, int, _Point]]: ...
