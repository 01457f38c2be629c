// SPDX-License-Identifier: MIT
// The paper's network on the paper's features, plain and physics-informed, trained as the study does; of its epochs the
// one counts that is best on the validation flights.
#include <memory>
#include <stdexcept>

#include "training/log_features.hpp"
#include "training/log_kinds.hpp"
#include "training/network_kinds.hpp"
#include "training/paper_network.hpp"

namespace programs {

namespace {

constexpr int network_epochs = 100;

template <class Features, class Loss>
std::shared_ptr<const TrainedNetwork> trained(const FitTask& fit, const Loss& loss, double weight_decay) {
  using Context = pinnquad::Context<Features, pinnquad::GivenAirframe>;
  bool any = false;
  pinnquad::each_features<Features, double>(fit.training,
                                            [&any](const pinnquad::Flight&, std::size_t, const auto&) { any = true; });
  if (!any) throw std::invalid_argument("no row has all features that are asked for");
  const auto rows = network_rows<Context>(fit);
  const auto network = std::make_unique<PaperNetwork<Features>>(trained_network<PaperNetwork<Features>>(
      fit, *rows, loss, best::optimizer(weight_decay), fit.epochs > 0 ? fit.epochs : network_epochs,
      KeptEpoch::best_on_validation));
  return std::make_shared<ExportableNetwork>(
      pinnquad::ground_model(pinnquad::make_trained_model(*network, rows->context, fit.training)), fit.training);
}

std::shared_ptr<const TrainedNetwork> fit_vanilla(const FitTask& fit) {
  return with_paper_features(
      fit, [&](auto tag) { return trained<typename decltype(tag)::type>(fit, pinnquad::Mse{}, best::vanilla_decay); });
}

std::shared_ptr<const TrainedNetwork> fit_physics_informed(const FitTask& fit) {
  return with_paper_features(fit, [&](auto tag) {
    return trained<typename decltype(tag)::type>(fit, best::physics_loss(best::annealed_weight()),
                                                 best::informed_decay);
  });
}

}  // namespace

ModelKind log_vanilla() {
  return {"vanilla", "vanilla network", TimeReach::present, true, needs_velocity, fit_vanilla};
}
ModelKind log_physics_informed() {
  return {"physics_informed", "physics-informed network", TimeReach::present, true,
          needs_velocity,     fit_physics_informed};
}

}  // namespace programs
