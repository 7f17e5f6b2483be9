"""What all environments share: the engine's episodes in Gymnasium's manner."""

from __future__ import annotations

import inspect
import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar

import gymnasium
import numpy as np
import numpy.typing as npt
from gymnasium.error import ResetNeeded

from auvgym import _core
from auvgym._arrays import numbers
from auvgym._core import ActionError
from auvgym._names import unknown
from auvgym.envs.replan import CHOICES, Replanning, as_decision, replanning
from auvgym.scenario import Scenario, check_seed, parameters_json, resolve_scenario
from auvgym.world import World

if TYPE_CHECKING:
    from auvgym.rendering import Viewer

Observation = npt.NDArray[np.float32]
Action = npt.NDArray[np.float32]
#: What ``step`` takes: an offset in waypoint mode, a number in re-plan mode.
Choice = Any
Array = npt.NDArray[np.float64]


class AUVEnv(gymnasium.Env[Observation, Choice]):
    """An AUV that is steered from waypoint to waypoint; base of the registered environments.

    With ``action_mode="replan"`` a planner's path is flown, and actions say when to plan anew.

    Subclasses set ``dimensions`` and ``family``. What an episode is, the observation and the
    reward are decided in the engine; this class only speaks Gymnasium.
    """

    metadata: ClassVar[dict[str, Any]] = {  # type: ignore[misc]  # Gymnasium declares it mutable
        "render_modes": ["human", "rgb_array"],
        "render_fps": 30,
    }
    dimensions: ClassVar[int]
    family: ClassVar[str]
    #: What planning to the goal takes in re-plan mode unless it is said, s.
    usual_planning_s: ClassVar[float] = 600.0

    def __init__(
        self,
        scenario: Scenario | str | os.PathLike[str] | None = None,
        mission: int = 0,
        action_mode: str = "waypoint",
        difficulty: str | None = None,
        variant: str | None = None,
        current_ratio: float | None = None,
        ring_ratio: float | None = None,
        time_factor: float | None = None,
        obstacles: int | None = None,
        vortices: int | None = None,
        peaks: int | None = None,
        vehicle_speed_mps: float | None = None,
        change_every_m: float | None = None,
        obstacle_speed_mps: float | None = None,
        vortex_drift_mps: float | None = None,
        manoeuvres: str | None = None,
        sensor_noise_m: float | None = None,
        vessels: int | None = None,
        planner: str | None = None,
        planner_parameters: Mapping[str, Any] | None = None,
        windows: Sequence[float] | None = None,
        planning_s: float | Sequence[float] | None = None,
        seconds_per_evaluation: float | None = None,
        render_mode: str | None = None,
        **unknown_settings: Any,
    ) -> None:
        if unknown_settings:
            known = [
                name for name in inspect.signature(AUVEnv).parameters if name != "unknown_settings"
            ]
            raise TypeError(unknown("setting", next(iter(unknown_settings)), known))
        if action_mode not in ("waypoint", "replan"):
            raise ValueError(f"action_mode = {action_mode!r}: must be 'waypoint' or 'replan'")
        planning: dict[str, Any] = {
            "planner": planner,
            "planner_parameters": planner_parameters,
            "windows": windows,
            "planning_s": planning_s,
            "seconds_per_evaluation": seconds_per_evaluation,
        }
        given = [name for name, value in planning.items() if value is not None]
        if action_mode == "waypoint" and given:
            raise ValueError(f"{given[0]} is for action_mode='replan': leave it out, or say so")
        if render_mode is not None and render_mode not in self.metadata["render_modes"]:
            modes = self.metadata["render_modes"]
            raise ValueError(f"render_mode = {render_mode!r}: must be None or one of {modes}")
        self.render_mode = render_mode
        self._scenario = None if scenario is None else resolve_scenario(scenario)
        self._mission = mission
        self._parameters = {
            "difficulty": difficulty,
            "variant": variant,
            "current_ratio": current_ratio,
            "ring_ratio": ring_ratio,
            "time_factor": time_factor,
            "obstacles": obstacles,
            "vortices": vortices,
            "peaks": peaks,
            "vehicle_speed_mps": vehicle_speed_mps,
            "change_every_m": change_every_m,
            "obstacle_speed_mps": obstacle_speed_mps,
            "vortex_drift_mps": vortex_drift_mps,
            "manoeuvres": manoeuvres,
            "sensor_noise_m": sensor_noise_m,
            "vessels": vessels,
        }
        self._replanning: Replanning | None = None
        self._source = self._make_source()
        if action_mode == "replan":
            self._replanning = replanning(self._source, self.usual_planning_s, **planning)
            self._source = self._replanning.source(self._source)
        #: "waypoint" or "replan".
        self.action_mode = action_mode
        self._episode: _core.Episode | None = None
        self._viewer: Viewer | None = None
        #: The plan in flight, or what a policy wants drawn: waypoints (n, 3) m, or None.
        self.plan: Array | None = None

        blocks = _core.observation_layout(self.dimensions, self._replanning is not None)
        low = np.concatenate(
            [np.full(count, least, np.float32) for _, _, count, least, _, _ in blocks]
        )
        high = np.concatenate(
            [np.full(count, most, np.float32) for _, _, count, _, most, _ in blocks]
        )
        self.observation_space = gymnasium.spaces.Box(low, high, dtype=np.float32)
        self.action_space: gymnasium.Space[Any] = (
            gymnasium.spaces.Box(-1.0, 1.0, (self.dimensions,), np.float32)
            if self._replanning is None
            else gymnasium.spaces.Discrete(CHOICES)
        )
        #: Name of a block of the observation -> where it is.
        self.observation_layout = {
            name: slice(start, start + count) for name, start, count, _, _, _ in blocks
        }
        #: Unit vectors (forward, left, up) of the sonar's beams, (beams, 3) float64.
        self.sonar_directions: Array = _core.sonar_directions(self.dimensions)

    def _make_source(self) -> _core.Source:
        if (
            isinstance(self._mission, bool)
            or not isinstance(self._mission, int)
            or self._mission < 0
        ):
            raise ValueError(f"mission = {self._mission!r}: must be an integer, 0 or more")
        if self._scenario is None:
            if self._mission != 0:
                message = f"mission = {self._mission}: needs a scenario, a drawn world has only one"
                raise ValueError(message)
            return _core.Source.family(self.family, parameters_json(self._parameters))
        given = [name for name, value in self._parameters.items() if value is not None]
        if given:
            message = f"{given[0]} is for drawn worlds: leave it out when a scenario is given"
            raise ValueError(message)
        if self._scenario.dimensions != self.dimensions:
            message = (
                f"scenario {self._scenario.name!r} has {self._scenario.dimensions} dimensions: "
                f"this environment needs {self.dimensions}"
            )
            raise ValueError(message)
        return _core.Source.fixed(self._scenario._core, self._mission)

    @property
    def episode(self) -> _core.Episode:
        """The engine's episode.

        Raises:
            ResetNeeded: before the first ``reset``.
        """
        if self._episode is None:
            raise ResetNeeded("call reset() first: there is no episode yet")
        return self._episode

    @property
    def world(self) -> World:
        """A copy of the world at the present time: what a policy that is given the map may see."""
        return World._of(self.episode.world)

    def action_for(self, waypoint: npt.ArrayLike) -> Action:
        """The action, (d,) float32, that steers towards a waypoint, (3,) m.

        A waypoint beyond the reach is brought nearer along the line to it.

        Raises:
            ValueError: if the waypoint is not finite or has another shape, or in re-plan mode.
            ResetNeeded: before the first ``reset``.
        """
        if self._replanning is not None:
            raise ValueError("action_for steers at waypoints: in re-plan mode the plan does")
        point = numbers("waypoint", waypoint)
        if point.shape != (3,):
            raise ValueError(f"waypoint has shape {point.shape}: must be (3,)")
        return self.episode.action_for((point[0], point[1], point[2]))

    def charge(self, evaluations: int = 0, replans: int = 0) -> None:
        """Charge planning to the episode: counted in ``info``."""
        self.episode.charge(evaluations, replans)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Begin an episode.

        Args:
            seed: seeds the draws of this and the following episodes.
            options: ``{"episode_seed": n}`` begins exactly the episode n (0 .. 2**64 - 1), as it
                is named in ``info``.

        Returns:
            The observation and ``info``.
        """
        super().reset(seed=seed)
        options = dict(options or {})
        episode_seed = options.pop("episode_seed", None)
        if options:
            raise ValueError(unknown("option", next(iter(options)), ["episode_seed"]))
        if episode_seed is None:
            episode_seed = int(self.np_random.integers(0, 2**63))
        episode_seed = check_seed(episode_seed, "episode_seed")
        self._episode = self._source.episode(episode_seed)
        self.plan = self._episode.plan
        info = self._episode.info()
        info["episode_seed"] = episode_seed
        if self.render_mode == "human":
            self.render()
        return self._episode.observe(), info

    def step(self, action: Choice) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Fly one leg; in re-plan mode plan anew before it, if the action says so.

        Args:
            action: (d,) numbers in [-1, 1]; in re-plan mode 0, 1, 2 or 3.

        Raises:
            ActionError: for an action of wrong shape or type, not finite or out of range; the
                episode is as before.
            ResetNeeded: before ``reset`` and after the end.
            KeyboardInterrupt: on Ctrl-C while planning; the episode is as before.
        """
        episode = self.episode
        if episode.outcome != "running":
            raise ResetNeeded(f"the episode has ended ({episode.outcome}): call reset() first")
        if self._replanning is None:
            observation, reward, terminated = episode.step(_as_float32(action, self.dimensions))
        else:
            observation, reward, terminated = episode.step(as_decision(action))
            self.plan = episode.plan
        if self.render_mode == "human":
            self.render()
        return observation, reward, terminated, False, episode.info()

    def replay(
        self, seed: int, actions: npt.NDArray[np.float32]
    ) -> tuple[_core.Episode, float, int, list[tuple[int, _core.World]]]:
        """Fly a log in one call, as ``reset(seed=seed)`` and then ``step`` would, but unobserved.

        Args:
            seed: as of ``reset``.
            actions: (n, d) float32.

        Returns:
            The episode as it then stands, the sum of rewards, how many actions were flown before
            its end, and (length of the trail when it came, world) of each map that was met.

        Raises:
            ActionError: an action that is not allowed.
        """
        generator, _ = gymnasium.utils.seeding.np_random(seed)
        log = np.ascontiguousarray(actions, dtype=np.float32)
        return self._source.replay(int(generator.integers(0, 2**63)), log)

    def render(self) -> npt.NDArray[np.uint8] | None:
        """A frame, (height, width, 3) uint8, or None when it went to the screen."""
        if self.render_mode is None:
            gymnasium.logger.warn("render() does nothing without a render_mode, see gymnasium.make")
            return None
        if self._viewer is None:
            from auvgym.rendering import Viewer

            self._viewer = Viewer(self.render_mode)
        return self._viewer.frame(self.world, self.episode, self.plan)

    def close(self) -> None:
        """Close the window, if there is one."""
        if self._viewer is not None:
            self._viewer.close()
            self._viewer = None

    def __getstate__(self) -> dict[str, Any]:
        # The source is made again from the settings; a window belongs to its process.
        return {**self.__dict__, "_source": None, "_viewer": None}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._source = self._make_source()
        if self._replanning is not None:
            self._source = self._replanning.source(self._source)


def _as_float32(action: Any, entries: int) -> Action:
    """An action as the engine takes it.

    Raises:
        ActionError: if it is not a vector of plain numbers.
    """
    if type(action) is np.ndarray and action.dtype == np.float32 and action.ndim == 1:
        return np.ascontiguousarray(action)
    try:
        array = np.asarray(action)
    except (TypeError, ValueError) as error:
        raise ActionError(f"action = {action!r}: must be {entries} numbers ({error})") from error
    if array.dtype.kind not in "fiu":
        raise ActionError(f"action = {action!r}: must be {entries} numbers, not {array.dtype}")
    if array.shape != (entries,):
        raise ActionError(f"action has shape {array.shape}: must be ({entries},)")
    # A number too large for float32 becomes infinite, which the engine refuses by name.
    with np.errstate(over="ignore"):
        return np.ascontiguousarray(array, dtype=np.float32)
