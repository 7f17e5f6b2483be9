"""Ray as the engine: the same rows as processes give, bit for bit, and the same failures."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import pytest

from auvgym.evaluation import EpisodeResult, Instance, PolicySpec, Store, Suite, run

pytest.importorskip("ray")
SUITE = Suite("ray", tuple(Instance("AUVDynamic2D-v0", seed) for seed in (11, 12, 13)))
EXITS = """
import os
class Exits:
    def reset(self, env): pass
    def act(self, observation, info): os._exit(7)
"""


def comparable(results: list[EpisodeResult]) -> list[EpisodeResult]:
    return [dataclasses.replace(result, planning_seconds=0.0) for result in results]


@pytest.mark.filterwarnings("ignore")
def test_ray_gives_what_processes_give(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "leaving.py").write_text(EXITS)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    monkeypatch.delenv("RAY_ADDRESS", raising=False)
    specs = [PolicySpec(name) for name in ("straight", "sonar-rule", "lfhh", "leaving:Exits")]
    with Store(None) as store:
        expected = comparable(run(SUITE, specs, store, workers=2))
    with Store(None) as store:
        assert comparable(run(SUITE, specs, store, workers=2, engine="ray")) == expected
    assert [row.outcome for row in expected if row.policy == "leaving:Exits"] == ["exit"] * 3


def test_an_unknown_engine_is_refused() -> None:
    with Store(None) as store, pytest.raises(ValueError, match="'processes' or 'ray'"):
        run(SUITE, [PolicySpec("straight")], store, engine="threads")  # type: ignore[arg-type]
