#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Compile times as JSON: a translation unit with flight.hpp and one exported model that predicts and tests itself, beside one
that includes Eigen/Core alone. Least CPU time of some runs each, which a busy machine disturbs least.

    bench/compile_time.py [--compiler g++] [--runs 5]
"""
import argparse
import json
import os
import pathlib
import resource
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
EIGEN = """#include <Eigen/Core>
float f(const float* x) { return Eigen::Matrix<float, 3, 1>(x[0], x[1], x[2]).sum(); }
"""
MODEL = """#include "examples/models/demo_quadrotor.hpp"
pinnquad::Status f(const DemoQuadModel::Inputs& inputs, pinnquad::Commands<float>& commands) {
  const pinnquad::InverseDynamics<DemoQuadModel> inverse;
  const pinnquad::Status status = pinnquad::self_test(inverse);
  return status == pinnquad::Status::ok ? inverse.predict(inputs, commands) : status;
}
"""


def cpu_seconds(compiler, flags, source, folder):
    file = pathlib.Path(folder) / "unit.cpp"
    file.write_text(source)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([compiler, "-std=c++17", "-DNDEBUG", *flags, f"-I{ROOT}", f"-I{ROOT}/include", "-isystem",
                    os.environ.get("EIGEN_INCLUDE_DIR", "/usr/include/eigen3"), "-c", str(file), "-o", "/dev/null"],
                   check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--compiler", default="g++")
    parser.add_argument("--runs", type=int, default=5)
    arguments = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for flags in (["-O2"], ["-O2", "-march=native"], ["-O3", "-march=native"]):
            times = [min(cpu_seconds(arguments.compiler, flags, source, folder) for _ in range(arguments.runs))
                     for source in (EIGEN, MODEL)]
            rows.append({"flags": " ".join(flags), "eigen_s": times[0], "model_s": times[1],
                         "ratio": times[1] / times[0]})
    print(json.dumps({"compiler": arguments.compiler, "rows": rows}, indent=1))


if __name__ == "__main__":
    main()
