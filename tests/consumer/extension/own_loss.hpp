// SPDX-License-Identifier: MIT
// A loss and a schedule of a user's own.
#pragma once

namespace own {

/// Huber: quadratic within `width` of the target, linear beyond; mean over samples and outputs.
struct Huber {
  double width = 0.5;

  template <class Context, class Batch, class Gradient>
  typename Batch::Scalar evaluate(const Context&, const Batch& batch, typename Batch::Scalar weight,
                                  Gradient& gradient) const {
    using Scalar = typename Batch::Scalar;
    const Scalar limit = Scalar(width), count = Scalar(batch.prediction.size());
    Scalar sum(0);
    for (int sample = 0; sample < batch.size(); ++sample) {
      for (int i = 0; i < Batch::outputs; ++i) {
        const Scalar error = batch.prediction(i, sample) - batch.target(i, sample);
        const Scalar magnitude = error < Scalar(0) ? -error : error;
        if (magnitude <= limit) {
          sum += error * error / Scalar(2);
          gradient(i, sample) += weight * error / count;
        } else {
          sum += limit * (magnitude - limit / Scalar(2));
          gradient(i, sample) += weight * (error < Scalar(0) ? -limit : limit) / count;
        }
      }
    }
    return sum / count;
  }
};

/// Rises linearly from 0 to `maximum` over the training.
struct LinearRamp {
  double maximum = 0.2;
  constexpr double weight(int epoch, int epochs) const noexcept {
    return epochs > 1 ? maximum * epoch / (epochs - 1) : maximum;
  }
};

}  // namespace own
