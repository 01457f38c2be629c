// SPDX-License-Identifier: MIT
#include "pinnquad/loss/loss.hpp"

#include <doctest/doctest.h>

#include <random>

#include "support/loss_batches.hpp"
#include "support/tolerances.hpp"

using namespace pinnquad;
using namespace pinnquad::test;

namespace {

using PaperContext = Context<PaperFeatures, PaperQuadrotor>;

template <class Scalar>
Scalar value(const PaperBatch<Scalar>& batch) {
  typename PaperBatch<Scalar>::Gradient gradient;
  gradient.setZero(4, batch.size());
  return Mse{}.evaluate(PaperContext{}, batch, Scalar(1), gradient);
}

}  // namespace

TEST_CASE_TEMPLATE("mean over batch and outputs (docs/paper.md, deviation 10)", Scalar, float, double) {
  std::mt19937_64 engine(41);
  for (const int size : {1, 2, 3, 40, 64}) {
    auto batch = random_batch<Scalar>(size, engine);
    const double tolerance = rounding<Scalar>(8.0 * size);  // a sum of 4 size squares of order 1, as a mean
    double sum = 0.0;
    for (int i = 0; i < size; ++i) {
      for (int k = 0; k < 4; ++k) {
        const double difference = static_cast<double>(batch.prediction(k, i)) - static_cast<double>(batch.target(k, i));
        sum += difference * difference;
      }
    }
    const Scalar loss = value(batch);
    CHECK(static_cast<double>(loss) == doctest::Approx(sum / (4.0 * size)).epsilon(tolerance));

    batch.prediction = batch.target;
    CHECK(value(batch) == Scalar(0));
  }
}
