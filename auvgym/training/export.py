"""A trained policy as an ONNX file: what it does where it is not exploring.

The networks that the recipes make are chains of linear layers and activations, an LSTM perhaps
before them; so is the graph that is written, node by node, and then held to the model's own
actions. The normalisation of observations is its first nodes.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from auvgym._extras import require
from auvgym.training.actor import Actor
from auvgym.training.config import TrainingError
from auvgym.training.stride import OFFSET, SCALE, SHORTEST

OPSET, IR_VERSION = 17, 9
#: Largest difference between an action of the file and one of the model.
TOLERANCE = 1e-4
_ACTIVATIONS = {"Tanh": "Tanh", "ReLU": "Relu", "ELU": "Elu", "Sigmoid": "Sigmoid"}


def export_onnx(
    model: Any,
    path: Path,
    normalizer: Any = None,
    least: float | None = None,
    probe: int = 64,
) -> float:
    """Write a model's deterministic policy, (n, k) float32 observations to (n, d) actions.

    Actions are clipped to their box; discrete ones are (n,) int64. A memory is a second and third
    input and output, ``hidden`` and ``cell`` (n, width), zeros where an episode begins.

    Args:
        model: of Stable-Baselines3: PPO, RecurrentPPO, SAC, TQC or DQN.
        path: of the file.
        normalizer: the ``VecNormalize`` that it was trained with, or None.
        least: shortest distance of a waypoint, in reaches, or None (:mod:`auvgym.training.stride`).
        probe: observations that the file is held to the model with, in steps of one episode.

    Returns:
        The largest difference found between actions of the file and of the model.

    Raises:
        TrainingError: a policy of another make, or a file that does something else than the model.
        ImportError: without onnx, or onnxruntime.
    """
    onnx = require("onnx", "train")
    graph = _Graph(onnx, model.observation_space.shape[0])
    if normalizer is not None and normalizer.norm_obs:
        graph.normalize(normalizer)
    discrete = type(model.action_space).__name__ == "Discrete"
    for layer in _layers(model):
        graph.add(layer)
    if discrete:
        graph.node("ArgMax", axis=1, keepdims=0)
    else:
        graph.clip(-1.0, 1.0)
        if least is not None:
            graph.stride(least, model.action_space.shape[0])
    graph.save(path, None if discrete else model.action_space.shape[0])
    difference = largest_difference(model, path, normalizer, least, probe)
    if difference > TOLERANCE:
        raise TrainingError(f"{path}: its actions differ from the model's by {difference:.2g}")
    return difference


def largest_difference(
    model: Any, path: Path, normalizer: Any = None, least: float | None = None, probe: int = 64
) -> float:
    """The largest difference between actions of a file and of the model it was made from."""
    session = require("onnxruntime", "train").InferenceSession(
        str(path), providers=["CPUExecutionProvider"]
    )
    names = [one.name for one in session.get_inputs()]
    memory = {one.name: np.zeros((1, one.shape[1]), np.float32) for one in session.get_inputs()[1:]}
    actor, worst = Actor(model, normalizer, least), 0.0
    low, high = model.observation_space.low, model.observation_space.high
    drawn = np.random.default_rng(0).uniform(low, high, (probe, len(low))).astype(np.float32)
    for index, observation in enumerate(drawn):
        outputs = session.run(None, {names[0]: observation[None], **memory})
        memory = dict(zip(memory, outputs[1:], strict=True))
        expected = actor(observation[None], np.array([index == 0]))
        worst = max(worst, float(np.abs(outputs[0] - expected).max()))
    return worst


def _layers(model: Any) -> Iterator[Any]:
    """The modules between observation and action of a deterministic policy, in their order."""
    policy = model.policy
    if hasattr(policy, "q_net"):
        yield policy.q_net.q_net
    elif hasattr(policy, "actor") and hasattr(policy.actor, "latent_pi"):
        yield policy.actor.latent_pi
        yield policy.actor.mu
        yield "Tanh"
    elif hasattr(policy, "action_net"):
        if hasattr(policy, "lstm_actor"):
            yield policy.lstm_actor
        yield policy.mlp_extractor.policy_net
        yield policy.action_net
    else:
        raise TrainingError(f"{type(policy).__name__}: there is no way to ONNX for such a policy")


class _Graph:
    """A chain of nodes that grows at its end."""

    def __init__(self, onnx: Any, entries: int) -> None:
        self._onnx, self._helper = onnx, onnx.helper
        self._float = onnx.TensorProto.FLOAT
        self._nodes: list[Any] = []
        self._weights: list[Any] = []
        self._inputs = [self._value("observation", ["n", entries])]
        self._memory: list[Any] = []
        self._end = "observation"

    def _value(self, name: str, shape: list[Any], kind: int | None = None) -> Any:
        return self._helper.make_tensor_value_info(name, kind or self._float, shape)

    def _constant(self, values: npt.NDArray[Any]) -> str:
        name = f"constant_{len(self._weights)}"
        self._weights.append(self._onnx.numpy_helper.from_array(values, name))
        return name

    def node(
        self, kind: str, *others: str, outputs: list[str] | None = None, **settings: Any
    ) -> None:
        """Append a node that takes the chain's end and ``others``."""
        made = outputs or [f"value_{len(self._nodes)}"]
        self._nodes.append(self._helper.make_node(kind, [self._end, *others], made, **settings))
        self._end = made[0]

    def add(self, layer: Any) -> None:
        """Append a module of torch, or an activation by its name."""
        kind = layer if isinstance(layer, str) else type(layer).__name__
        if kind in _ACTIVATIONS:
            self.node(_ACTIVATIONS[kind])
        elif kind == "Linear":
            weights, bias = _numbers(layer.weight), _numbers(layer.bias)
            self.node("Gemm", self._constant(weights), self._constant(bias), transB=1)
        elif kind == "Sequential":
            for part in layer:
                self.add(part)
        elif kind == "SiLU":
            before = self._end
            self.node("Sigmoid")
            self.node("Mul", before)
        elif kind == "LSTM" and layer.num_layers == 1 and not layer.bidirectional:
            self._lstm(layer)
        elif kind not in ("Flatten", "Identity"):
            raise TrainingError(
                f"a layer {kind} cannot be written as ONNX: make the policy of others"
            )

    def normalize(self, normalizer: Any) -> None:
        """What ``VecNormalize`` does to observations."""
        statistics = normalizer.obs_rms
        scale = np.sqrt(statistics.var + normalizer.epsilon)
        self.node("Sub", self._constant(statistics.mean.astype(np.float32)))
        self.node("Div", self._constant(scale.astype(np.float32)))
        self.clip(-normalizer.clip_obs, normalizer.clip_obs)

    def clip(self, low: float, high: float) -> None:
        """Append a clip."""
        bounds = [self._constant(np.array(bound, np.float32)) for bound in (low, high)]
        self.node("Clip", *bounds)

    def stride(self, least: float, wide: int) -> None:
        """What :func:`auvgym.training.stride.stride` does to clipped actions."""
        given = self._end
        offset, scale = (
            self._constant(np.array(one[:wide], np.float32)) for one in (OFFSET, SCALE)
        )
        bound = self._constant(np.array(least, np.float32))
        self.node("Mul", scale)
        self.node("Add", offset)
        asked = self._end
        self.node("ReduceL2", axes=[1], keepdims=1)
        length = self._end
        self.node("Less", bound)
        near = self._end
        self._end = length
        self.node("Max", self._constant(np.array(SHORTEST, np.float32)))
        length, self._end = self._end, bound
        self.node("Div", length)
        self.node("Mul", asked)
        self.node("Sub", offset)
        self.node("Div", scale)
        moved, self._end = self._end, near
        self.node("Where", moved, given)

    def _lstm(self, layer: Any) -> None:
        """One step of an LSTM: torch has its gates as i f g o, ONNX as i o f g."""
        width = layer.hidden_size

        def gates(name: str) -> npt.NDArray[np.float32]:
            i, f, g, o = np.split(_numbers(getattr(layer, name)), 4)
            return np.concatenate([i, o, f, g])[None]

        bias = np.concatenate([gates("bias_ih_l0"), gates("bias_hh_l0")], axis=1)
        first = self._constant(np.array([0], np.int64))
        chain, memory = self._end, []
        for name in ("hidden", "cell"):
            self._inputs.append(self._value(name, ["n", width]))
            self._memory.append(self._value(f"next_{name}", ["n", width]))
            self._end = name
            self.node("Unsqueeze", first)
            memory.append(self._end)
        self._end = chain
        self.node("Unsqueeze", first)
        weights = [self._constant(gates("weight_ih_l0")), self._constant(gates("weight_hh_l0"))]
        outputs = ["sequence", "last_hidden", "last_cell"]
        extra = [*weights, self._constant(bias), "", *memory]
        self.node("LSTM", *extra, outputs=outputs, hidden_size=width)
        for name in ("cell", "hidden"):
            self._end = f"last_{name}"
            self.node("Squeeze", first, outputs=[f"next_{name}"])

    def save(self, path: Path, actions: int | None) -> None:
        """Check and write it; ``actions`` is the width of continuous ones."""
        self.node("Identity", outputs=["action"])
        if actions is None:
            action = self._value("action", ["n"], self._onnx.TensorProto.INT64)
        else:
            action = self._value("action", ["n", actions])
        graph = self._helper.make_graph(
            self._nodes, "agent", self._inputs, [action, *self._memory], self._weights
        )
        opset = [self._helper.make_opsetid("", OPSET)]
        made = self._helper.make_model(graph, opset_imports=opset, ir_version=IR_VERSION)
        self._onnx.checker.check_model(made)
        self._onnx.save(made, str(path))


def _numbers(parameter: Any) -> npt.NDArray[np.float32]:
    values: npt.NDArray[np.float32] = parameter.detach().cpu().numpy().astype(np.float32)
    return values
