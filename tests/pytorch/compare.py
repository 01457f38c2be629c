# SPDX-License-Identifier: MIT
"""Trains in PyTorch what train.cpp has trained, from the same initial weights on the same batches, and compares every
weight after every step.

    compare.py FOLDER mse|paper plain|batch_norm adam|adam_w_cosine

The network is torch.nn's, the optimisers and the cosine are torch.optim's, the gradient is autograd's; the loss is written
here from the paper (Algorithm 1, Eqs. (2), (5), (6), with docs/paper.md, deviations 8, 9 and 11). Exit code 1 if a tensor
differs by more than 1e-9 of its largest entry at any step.
"""
import math
import pathlib
import sys

import torch

TOLERANCE = 1e-9
EPOCHS, BATCH = 10, 64
INPUTS, WIDTH, HIDDEN, OUTPUTS = 16, 25, 10, 4
# Eq. (2), columns u1..u4, and the column of the angular acceleration among the features
AXES = {"roll": ([-1, 1, 1, -1], 3), "pitch": ([1, -1, 1, -1], 4), "yaw": ([1, 1, -1, -1], 5)}
LAMBDA_MAX, CYCLES, HOLD, GAIN = 0.1, 2, 0.5, 3.0


def read(path, dtype):
    return torch.frombuffer(bytearray(path.read_bytes()), dtype=dtype).clone()


def network(normed):
    layers, inputs = [], INPUTS
    for _ in range(HIDDEN):
        layers.append(torch.nn.Linear(inputs, WIDTH, bias=not normed))
        if normed:
            layers.append(torch.nn.BatchNorm1d(WIDTH))
        layers.append(torch.nn.ReLU())
        inputs = WIDTH
    layers.append(torch.nn.Linear(inputs, OUTPUTS))
    return torch.nn.Sequential(*layers).double()


def tensors(model):
    """Name and tensor in the order of pinnquad's flat array."""
    for index, layer in enumerate(model):
        if isinstance(layer, torch.nn.Linear):
            yield f"{index}.weight", layer.weight
            if layer.bias is not None:
                yield f"{index}.bias", layer.bias
        elif isinstance(layer, torch.nn.BatchNorm1d):
            yield f"{index}.gamma", layer.weight
            yield f"{index}.beta", layer.bias
            yield f"{index}.running_mean", layer.running_mean
            yield f"{index}.running_variance", layer.running_var


def split(model, flat):
    """The same tensors, cut from the flat array."""
    at = 0
    for name, tensor in tensors(model):
        yield name, flat[at:at + tensor.numel()].view(tensor.shape)
        at += tensor.numel()
    assert at == flat.numel(), "the two networks have different sizes"


def annealed(epoch):
    period = math.ceil(EPOCHS / CYCLES)
    beta = (epoch % period) / period
    return LAMBDA_MAX if beta <= HOLD else (1 - beta) / (1 - HOLD) * LAMBDA_MAX


def local_monotonicity(m, n):
    return torch.mean(1 - torch.tanh(GAIN * (m[1:] - m[:-1])) * torch.tanh(GAIN * (n[1:] - n[:-1])))


def loss_of(kind, predicted, target, features, scales, epoch):
    loss = torch.mean((predicted - target) ** 2)
    if kind == "paper":
        mean, spread, sum_spread = scales[0:4], scales[4:8], scales[8:11]
        commands = predicted * spread + mean
        for axis, (signs, column) in enumerate(AXES.values()):
            m = commands @ torch.tensor(signs, dtype=torch.float64) / sum_spread[axis]
            loss = loss + annealed(epoch) * local_monotonicity(m, features[:, column])
    return loss


def main(folder, kind, normed, optimiser):
    torch.set_num_threads(1)
    folder = pathlib.Path(folder)
    features = read(folder / "features.f64", torch.float64).view(-1, INPUTS)
    outputs = read(folder / "outputs.f64", torch.float64).view(-1, OUTPUTS)
    order = read(folder / "order.i32", torch.int32).long().view(EPOCHS, -1)
    scales = read(folder / "scales.f64", torch.float64)
    model = network(normed)
    count = sum(tensor.numel() for _, tensor in tensors(model))
    weights = read(folder / "weights.f64", torch.float64).view(-1, count)
    batches = math.ceil(len(features) / BATCH)
    steps = EPOCHS * batches
    assert len(weights) == steps + 1, "another number of steps"
    with torch.no_grad():
        for (_, tensor), (_, initial) in zip(tensors(model), split(model, weights[0])):
            tensor.copy_(initial)

    schedule = None
    if optimiser == "adam":
        optimizer = torch.optim.Adam(model.parameters(), lr=1e-3, weight_decay=1e-3)
    else:
        optimizer = torch.optim.AdamW(model.parameters(), lr=3e-3, weight_decay=1e-2)
        schedule = torch.optim.lr_scheduler.CosineAnnealingLR(optimizer, T_max=steps)

    worst, where, step = 0.0, "", 0
    model.train()
    for epoch in range(EPOCHS):
        for rows in order[epoch].split(BATCH):
            optimizer.zero_grad()
            x = features[rows]
            loss_of(kind, model(x), outputs[rows], x, scales, epoch).backward()
            optimizer.step()
            if schedule is not None:
                schedule.step()
            step += 1
            with torch.no_grad():
                for (name, tensor), (_, ours) in zip(tensors(model), split(model, weights[step])):
                    difference = ((tensor - ours).abs().max() / tensor.abs().max()).item()
                    if not difference <= worst:  # NaN counts
                        worst, where = difference, f"{name} at step {step}"

    model.eval()
    with torch.no_grad():
        unseen = model(read(folder / "unseen.f64", torch.float64).view(-1, INPUTS))
        flown = read(folder / "predictions.f64", torch.float64).view(-1, OUTPUTS)
        predicted = ((unseen - flown).abs().max() / unseen.abs().max()).item()
        moved = max(((b - a).abs().max() / a.abs().max()).item()
                    for (_, a), (_, b) in zip(split(model, weights[0]), split(model, weights[-1])))

    good = worst <= TOLERANCE and predicted <= TOLERANCE and moved > 1e-3
    print(f"{kind:6} {'batch_norm' if normed else 'plain':11} {optimiser:14} {steps} steps: "
          f"weights {worst:.1e} ({where}), folded predictions {predicted:.1e}{'' if good else '   TOO FAR'}")
    return 0 if good else 1


if __name__ == "__main__":
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], sys.argv[2], sys.argv[3] == "batch_norm", sys.argv[4]))
