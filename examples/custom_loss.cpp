// SPDX-License-Identifier: MIT
// A loss of one's own, in the paper's loss beside local monotonicity: commands of the four rotors should stay close to
// their mean. No header of the library is touched; the trainer takes it because it has evaluate().
#include <cstdio>
#include <memory>
#include <random>

#include "pinnquad/pinnquad.hpp"

using namespace pinnquad;

/// mean over samples and rotors of (u_i - mean of u)^2, standardised; adds weight * its derivative by the predictions.
struct EvenRotors {
  template <class Context, class Batch, class Gradient>
  typename Batch::Scalar evaluate(const Context&, const Batch& batch, typename Batch::Scalar weight,
                                  Gradient& gradient) const {
    using Scalar = typename Batch::Scalar;
    const Scalar count = Scalar(batch.prediction.size());
    const typename Batch::Gradient deviation = batch.prediction.rowwise() - batch.prediction.colwise().mean();
    gradient += Scalar(2) * weight / count * deviation;
    return deviation.squaredNorm() / count;
  }
};

int main() {
  using Net = Mlp<float, InputSize<16>, Hidden<3, 25>, OutputSize<4>, Relu>;
  using Loss =
      PhysicsInformed<Mse, Weighted<LocalMonotonicity<Roll>, CyclicalAnnealing>, Weighted<EvenRotors, Constant>>;
  using Settings = Context<PaperFeatures, PaperQuadrotor>;

  const Quadrotor<double, StandardAtmosphere, QuadraticDrag> quadrotor(airframe_value<PaperQuadrotor, double>(),
                                                                       paper_site<double>(), {}, {});
  FlightPlan plan;
  plan.samples = 1500;
  const RandomPilot<std::mt19937_64> pilot(std::mt19937_64(1), pilot_style(quadrotor, plan.start_m, 8.0),
                                           quadrotor.site().ground_z_m);
  const Flight flight = fly(quadrotor, pilot, plan).flight;

  const IndexRange everything = {0, flight.size()};
  const Settings settings = make_context<Settings>({flight, everything});
  const auto data = standardised<float>(settings, {flight, everything});
  std::mt19937_64 engine(1);
  const auto network = initialised<Net>(engine);
  const auto trainer = std::make_unique<Trainer<Net, Loss, Adam, Settings>>(network, Loss{}, Adam{}, settings);
  constexpr int epochs = 10;
  for (int epoch = 0; epoch < epochs; ++epoch) {
    std::printf("epoch %d: loss %.4f\n", epoch, trainer->epoch(data, {epoch, epochs}, engine));
  }
}
