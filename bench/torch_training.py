#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Seconds per epoch of the same training in PyTorch as in bench_training.cpp: the paper's network (16 -> 10 x 25 ReLU -> 4),
9,000 samples, shuffled batches of 64, mean squared error, Adam with weight decay 1e-5, float32, one thread, on the CPU.

    bench/torch_training.py [--epochs 5] [--eager] [--data-loader]

Four rows: the plain network and the one with batch norm, each with the mean squared error alone and with the local monotonicity
loss. The network is traced and Adam takes all tensors at once (foreach), the fastest that PyTorch 1.13 was found to do here;
--eager trains as most people write it. Batches are cut from one shuffled index tensor, which is the fastest way;
--data-loader takes them from torch.utils.data.DataLoader, as the paper's Algorithm 1 names it. The median of the epochs is
printed after one that warms up, with the fastest and the slowest. Needs Debian's python3-torch.
"""
import argparse
import statistics
import time

import torch

SAMPLES, BATCH, INPUTS, WIDTH, HIDDEN, OUTPUTS = 9000, 64, 16, 25, 10, 4
# Eq. (2), columns u1..u4: roll, pitch, yaw; their angular accelerations are features 3, 4 and 5
SIGNS = torch.tensor([[-1.0, 1.0, 1.0, -1.0], [1.0, -1.0, 1.0, -1.0], [1.0, 1.0, -1.0, -1.0]])


def training_set():
    """As bench/support/training_set.hpp: output k is a sine of features k and k + 4."""
    generator = torch.Generator().manual_seed(3)
    features = torch.randn(SAMPLES, INPUTS, generator=generator)
    return features, torch.sin(features[:, 0:4] + 0.5 * features[:, 4:8])


def network(normed):
    torch.manual_seed(1)
    layers, inputs = [], INPUTS
    for _ in range(HIDDEN):
        layers.append(torch.nn.Linear(inputs, WIDTH, bias=not normed))
        if normed:
            layers.append(torch.nn.BatchNorm1d(WIDTH))
        layers.append(torch.nn.ReLU())
        inputs = WIDTH
    layers.append(torch.nn.Linear(inputs, OUTPUTS))
    return torch.nn.Sequential(*layers)


def local_monotonicity(predicted, features):
    sums, rates = predicted @ SIGNS.T, features[:, 3:6]
    steps = torch.tanh(3 * (sums[1:] - sums[:-1])) * torch.tanh(3 * (rates[1:] - rates[:-1]))
    return torch.mean(1 - steps, dim=0).sum()


def batches(features, targets, data_loader):
    if data_loader:
        data = torch.utils.data.TensorDataset(features, targets)
        yield from torch.utils.data.DataLoader(data, batch_size=BATCH, shuffle=True)
    else:
        for rows in torch.randperm(SAMPLES).split(BATCH):
            yield features[rows], targets[rows]


def epoch_seconds(normed, physics_informed, epochs, eager, data_loader):
    features, targets = training_set()
    model = network(normed)
    if not eager:
        model = torch.jit.trace(model, features[:BATCH])
    optimizer = torch.optim.Adam(model.parameters(), lr=1e-3, weight_decay=1e-5, foreach=not eager)
    seconds = []
    for _ in range(epochs + 1):
        begin = time.perf_counter()
        for x, y in batches(features, targets, data_loader):
            optimizer.zero_grad(set_to_none=True)
            predicted = model(x)
            loss = torch.nn.functional.mse_loss(predicted, y)
            if physics_informed:
                loss = loss + 0.1 * local_monotonicity(predicted, x)
            loss.backward()
            optimizer.step()
        seconds.append(time.perf_counter() - begin)
    return seconds[1:]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--epochs", type=int, default=5, help="timed epochs (default: 5)")
    parser.add_argument("--eager", action="store_true", help="neither traced nor foreach")
    parser.add_argument("--data-loader", action="store_true", help="batches from torch.utils.data.DataLoader")
    options = parser.parse_args()
    if options.epochs < 1:
        parser.error("--epochs needs at least 1")
    torch.set_num_threads(1)
    print(f"PyTorch {torch.__version__}, one thread, {SAMPLES} samples, batch {BATCH}; seconds per epoch")
    for name, normed, physics_informed in (("vanilla", False, False), ("physics_informed", False, True),
                                           ("batch_norm", True, False), ("batch_norm_physics_informed", True, True)):
        seconds = epoch_seconds(normed, physics_informed, options.epochs, options.eager, options.data_loader)
        print(f"TrainEpoch/{name:28} median {statistics.median(seconds):.4f}  min {min(seconds):.4f}  max {max(seconds):.4f}")


if __name__ == "__main__":
    main()
