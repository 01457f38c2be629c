# SPDX-License-Identifier: MIT
"""python -m pinnquad convert net.onnx --features features.toml --out my_model"""
import argparse
import sys

from . import Error, Model, convert, save_network


def main():
    parser = argparse.ArgumentParser(prog="python -m pinnquad", description="The program pinnquad has all other commands.")
    line = parser.add_subparsers(required=True, metavar="COMMAND").add_parser(
        "convert", help="a network from elsewhere becomes a model, a model a network for elsewhere")
    line.add_argument("source", help="a network (.onnx, .safetensors) or a model (.block)")
    line.add_argument("--features", metavar="FILE.toml", help="of a network: what its numbers mean (docs/convert.md)")
    line.add_argument("--out", required=True, help="a folder for model.hpp and model.block; of a model the network to write")
    line.add_argument("--name", default="TrainedQuadModel", help="name of the exported struct")
    line.add_argument("--prefix", default="", help="of tensors by name: only those that begin with it, such as actor.")
    line.add_argument("--output", default="", help="of a network with several outputs: the one that makes the commands")
    line.add_argument("--double", action="store_true", help="numbers of the model in double, not in float")
    asked = parser.parse_args()
    try:
        if asked.source.endswith(".block"):
            save_network(Model.load(asked.source), asked.out)
        elif not asked.features:
            raise ValueError("--features is required: no file of weights says what its numbers mean")
        else:
            model = convert(asked.source, asked.features, asked.out, name=asked.name, prefix=asked.prefix,
                            output=asked.output, double=asked.double)
            print(f"{model.flight_verdict}\n{asked.out}/model.hpp: struct {model.name}")
    except (Error, ValueError, OSError) as error:
        print(f"convert: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
