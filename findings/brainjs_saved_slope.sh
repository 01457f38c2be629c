#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: brain.js 1.6.1 (npm).
# One would guess: a network that is saved with toJSON() and read with fromJSON() computes what it computed.
# What happens: toJSON() writes the name of the activation and not the slope of leaky-relu. fromJSON() takes .01, even into a
#   network that was made with another slope. toFunction() of the trained network is right.
# Seen: a network trained with leakyReluAlpha .2, at (-1, .5): trained and toFunction() equal within 1e-6, read back off by more
#   than 0.1; with .01 it comes back equal.
# Why it matters: a network is trained in a browser or by Node, saved, and then converted or flown by something else: nothing
#   reports that its negative half has another slope.
# pinnquad: reads no brain.js file; the slope of leaky ReLU is a number in each header and block.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
npm install --silent --no-audit --no-fund --ignore-scripts --prefix "$dir" brain.js@1.6.1 >"$dir/log" 2>&1 || {
  echo "not run: npm does not install brain.js"
  exit 2
}
cat >"$dir/observe.cjs" <<'JS'
const brain = require('brain.js');
const rows = Array.from({ length: 50 }, (_, i) => ({ input: [Math.sin(i), Math.cos(i)], output: [0.5 + 0.4 * Math.sin(i)] }));
const differences = (leakyReluAlpha) => {
  const options = { hiddenLayers: [4], activation: 'leaky-relu', leakyReluAlpha };
  const trained = new brain.NeuralNetwork(options);
  trained.train(rows, { iterations: 300 });
  const read = new brain.NeuralNetwork(options).fromJSON(JSON.parse(JSON.stringify(trained.toJSON())));
  const called = trained.toFunction();
  const worst = (other) => Math.max(...rows.map(({ input }) => Math.abs(trained.run(input)[0] - other(input)[0])));
  return [worst((x) => read.run(x)), worst(called)];
};
const [read, called] = differences(0.2), [usual] = differences(0.01);
console.log(`slope .2: read back off by ${read.toFixed(3)}, toFunction() by ${called.toExponential(0)}; slope .01: ${usual.toExponential(0)}`);
if (!(read > 0.01 && called < 1e-5 && usual < 1e-5)) {
  console.log('changed: fromJSON() of brain.js keeps the slope of leaky-relu');
  process.exit(1);
}
JS
node "$dir/observe.cjs"
