"""Agents of anybody's: a class that sees observations only, an ONNX file with its card, SB3."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from typer.testing import CliRunner

from auvgym import policies
from auvgym.cli import app
from auvgym.evaluation import Instance, PolicySpec, Store, Suite, run, verify
from auvgym.policies import PolicyError

SUITE = Suite("agents", (Instance("AUVDynamic2D-v0", 4, "easy"),))
ENTRIES = 59
FORWARD = [1.0, 0.1]
ENTRANT = """
import numpy as np
class Forward:
    knows = "sensors"
    def reset(self, observation, info):
        self.entries = len(observation)
        assert info["outcome"] == "running" and not hasattr(self, "env")
    def act(self, observation, info):
        return np.array([1.0, 0.1], np.float32)
"""


@pytest.fixture
def model(tmp_path: Path) -> Path:
    """An ONNX network that always goes forward: 0 x + bias, as an exported one would be written."""
    onnx = pytest.importorskip("onnx")
    pytest.importorskip("onnxruntime")
    helper, kind = onnx.helper, onnx.TensorProto.FLOAT
    weights = helper.make_tensor("W", kind, [ENTRIES, 2], np.zeros(ENTRIES * 2))
    bias = helper.make_tensor("B", kind, [2], FORWARD)
    graph = helper.make_graph(
        [helper.make_node("Gemm", ["observation", "W", "B"], ["action"])],
        "agent",
        [helper.make_tensor_value_info("observation", kind, ["n", ENTRIES])],
        [helper.make_tensor_value_info("action", kind, ["n", 2])],
        [weights, bias],
    )
    made = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=9)
    path = tmp_path / "agent.onnx"
    onnx.save(made, path)
    card = {"schema": 1, "name": "forward", "environment": "AUVDynamic2D-v0"}
    path.with_suffix(".json").write_text(json.dumps(card))
    return path


def test_a_class_without_the_environment(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "entrant.py").write_text(ENTRANT)
    monkeypatch.syspath_prepend(tmp_path)
    with Store(tmp_path / "results.db") as store:
        (row,) = run(SUITE, [PolicySpec("entrant:Forward")], store)
    assert (row.knows, row.policy_failed) == ("sensors", False)
    assert row.action_log()[0] == pytest.approx(FORWARD)
    assert verify(tmp_path / "results.db").differences == []


def test_an_onnx_file_flies_and_is_bound_to_its_hash(model: Path, tmp_path: Path) -> None:
    path = tmp_path / "results.db"
    with Store(path) as store:
        (row,) = run(SUITE, [PolicySpec(str(model))], store)
    assert (row.knows, row.policy_failed, row.error) == ("sensors", False, "")
    assert row.action_log() == pytest.approx(np.tile(np.float32(FORWARD), (row.steps, 1)))
    sha256 = json.loads(row.parameters)["sha256"]
    assert len(sha256) == 16
    assert verify(path).differences == []
    # The same file again is the same policy; another file of the same name is another one.
    with Store(path) as store:
        assert run(SUITE, [PolicySpec(str(model))], store) == [row]
    model.write_bytes(model.read_bytes() + b"\0")
    with pytest.raises(PolicyError, match="it has changed"):
        policies.make(str(model), sha256=sha256)


def test_the_command_line_takes_a_file(model: Path) -> None:
    done = CliRunner().invoke(
        app, ["evaluate", "--policy", str(model), "--episodes", "1", "--difficulty", "easy"]
    )
    assert done.exit_code == 0, done.output
    assert "AUVDynamic2D-v0" in done.output


def test_an_agent_of_another_environment_says_so(model: Path) -> None:
    env = gymnasium.make("AUVDynamic3D-v0")
    observation, info = env.reset(seed=0)
    policy = policies.make(str(model))
    policies.begin(policy, env, observation, info)
    with pytest.raises(PolicyError, match="takes 59 entries, this environment has 97"):
        policy.act(observation, info)


@pytest.mark.parametrize(
    ("card", "said"),
    [
        (None, "cannot be read"),
        ("[", "cannot be read"),
        ("[]", "not a JSON object"),
        ('{"schema": 2}', "schema is 2"),
        ('{"schema": 1, "name": "x"}', "environment is missing"),
    ],
)
def test_a_card_says_what_the_agent_is_for(model: Path, card: str | None, said: str) -> None:
    path = model.with_suffix(".json")
    path.unlink() if card is None else path.write_text(card)
    with pytest.raises(PolicyError, match=said):
        policies.make(str(model))


def test_a_file_that_is_no_agent_is_refused(model: Path, tmp_path: Path) -> None:
    model.write_bytes(b"not a model")
    with pytest.raises(PolicyError, match="is not an ONNX model"):
        policies.make(str(model))
    (tmp_path / "agent.zip").write_bytes(b"not an archive")
    with pytest.raises(PolicyError, match="is not a Stable-Baselines3 archive"):
        policies.make(str(tmp_path / "agent.zip"))
    for name in ("none.onnx", "none.zip"):
        with pytest.raises(PolicyError, match="cannot be read"):
            policies.make(str(tmp_path / name))


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_a_stable_baselines_archive_flies_with_a_warning(tmp_path: Path) -> None:
    sb3: Any = pytest.importorskip("stable_baselines3")
    env = gymnasium.make("AUVDynamic2D-v0")
    path = tmp_path / "agent.zip"
    model = sb3.PPO("MlpPolicy", env, seed=3, device="cpu", policy_kwargs={"net_arch": [8]})
    model.save(path)
    with pytest.warns(policies.CodeWarning, match="runs code"):
        policy = policies.make(str(path))
    observation, info = env.reset(seed=1)
    policies.begin(policy, env, observation, info)
    expected, _ = model.predict(observation, deterministic=True)
    assert policy.act(observation, info) == pytest.approx(np.clip(expected, -1, 1))
    drawn = []
    with pytest.warns(policies.CodeWarning):
        policy = policies.make(str(path), deterministic=False)
    for _ in range(2):  # an episode depends on itself alone
        policies.begin(policy, env, observation, info)
        drawn.append(policy.act(observation, info))
    assert np.array_equal(*drawn)
    with pytest.raises(PolicyError, match="unknown parameter"):
        policies.make(str(path), net="large")
