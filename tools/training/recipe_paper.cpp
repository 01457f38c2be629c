// SPDX-License-Identifier: MIT
// The recipe `paper`: the network and the losses of the paper (Sec. 5.2), the library's defaults where it is silent.
#include "pinnquad/features/features.hpp"
#include "training/model_predictions.hpp"
#include "training/network_kinds.hpp"
#include "training/paper_network.hpp"
#include "training/recipe.hpp"

namespace programs {

namespace {

struct Paper {
  using Network = PaperNetwork<pinnquad::PaperFeatures>;
  static pinnquad::Adam vanilla_optimizer() { return {}; }
  static pinnquad::Adam informed_optimizer() { return {}; }
  static pinnquad::PaperLoss<pinnquad::CyclicalAnnealing> annealed() { return {}; }
  static PearsonLoss pearson() { return {}; }
  static pinnquad::PaperLoss<pinnquad::Constant> constant() {
    return best::with_schedule(pinnquad::PaperLoss<pinnquad::Constant>{},
                               pinnquad::Constant{pinnquad::CyclicalAnnealing{}.maximum});
  }
};

}  // namespace

Recipe paper_recipe() {
  const pinnquad::Adam adam;
  const pinnquad::CyclicalAnnealing annealing;
  return {"paper",
          network_in_words<Paper::Network>("10 x 25 ReLU"),
          {{"network", "10 x 25 ReLU"},
           {"batch", batch_size},
           {"optimizer", "Adam, coupled weight decay"},
           {"learning_rate", adam.learning_rate},
           {"learning_rate_schedule", "constant"},
           {"weight_decay", adam.weight_decay},
           {"lambda_max", annealing.maximum},
           {"cycles", annealing.cycles},
           {"hold", annealing.hold},
           {"step_gain", pinnquad::Standardised::gain}},
          network_kinds<Paper>({"paper_vanilla", "paper_physics_informed", "paper_constant_weight", "paper_pearson"})};
}

ModelKind formula_kind() {
  return {"formula",
          "formula of the airframe",
          TimeReach::present,
          false,
          always_applicable,
          [](const FitTask& task) {
            const pinnquad::Airframe<double>& airframe = task.airframe.value;
            return formula_model(task.given_airframe(), [airframe, rotors = pinnquad::Rotors<double>(airframe)](
                                                            const pinnquad::Sample& sample) {
              return linear_prediction(airframe, rotors, sample);
            });
          },
          never_takes_validation,
          "linearized model of the airframe",
          false};
}

}  // namespace programs
