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

TEST_CASE("mean over batch and outputs (docs/paper.md, deviation 10)") {
  PaperBatch<double> batch;
  batch.resize(2);
  batch.features.setZero();
  batch.target.setZero();
  batch.prediction << 1, 5, 2, 6, 3, 7, 4, 8;  // columns are samples: (1, 2, 3, 4), (5, 6, 7, 8)
  CHECK(value(batch) == 204.0 / 8.0);
}

TEST_CASE_TEMPLATE("laws", Scalar, float, double) {
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

    auto reversed = batch;
    reversed.prediction = batch.prediction.rowwise().reverse().eval();
    reversed.target = batch.target.rowwise().reverse().eval();
    CHECK(static_cast<double>(value(reversed)) == doctest::Approx(static_cast<double>(loss)).epsilon(tolerance));

    auto doubled = batch;  // errors twice as large, loss four times: powers of two are exact
    doubled.prediction *= Scalar(2);
    doubled.target *= Scalar(2);
    CHECK(value(doubled) == Scalar(4) * loss);

    batch.prediction = batch.target;
    CHECK(value(batch) == Scalar(0));
  }
}
