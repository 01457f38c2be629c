// SPDX-License-Identifier: MIT
// A block asked row by row by C++ that knows its type, for rates.py: ns of the processor a row, a line each time that a
// line is read.
//   rates MODEL.block ROWS
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <random>
#include <vector>

#include "models/demo_quadrotor.hpp"
#include "pinnquad/deploy/block_model.hpp"
#include "pinnquad/exported/model_view.hpp"
#include "pinnquad/flight.hpp"

using namespace pinnquad;

int main(int, char** arguments) {
  using View = ModelView<DemoQuadModel>;
  const BlockModel block(arguments[1]);
  const auto rows = static_cast<std::size_t>(std::atol(arguments[2]));
  View view;
  if (View::open(block.data(), block.size(), view) != Status::ok) return 1;
  const InverseDynamics<View> inverse(view);
  constexpr auto inputs = static_cast<std::size_t>(DemoQuadModel::Features::size);
  const std::vector<double> lower = block.envelope_lower(), upper = block.envelope_upper();
  std::mt19937_64 engine(1);
  std::vector<float> x(rows * inputs), u(rows * rotor_count);
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = static_cast<float>(uniform(engine, lower[i % inputs], upper[i % inputs]));
  }
  std::size_t answered = 0;
  while (std::getchar() != EOF) {
    const std::clock_t start = std::clock();
    for (std::size_t row = 0; row < rows; ++row) {
      if (inverse.predict_features(&x[row * inputs], &u[row * rotor_count]) == Status::ok) ++answered;
    }
    const double elapsed_s = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    std::printf("%.3f\n", 1e9 * elapsed_s / static_cast<double>(rows));
    std::fflush(stdout);
  }
  return answered > 0 ? 0 : 1;
}
