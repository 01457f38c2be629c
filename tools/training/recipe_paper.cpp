// SPDX-License-Identifier: MIT
// The recipe `paper`: the network and the losses of the paper (Sec. 5.2), the library's defaults where it is silent.
#include "training/campaign.hpp"
#include "training/paper_network.hpp"

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
          "10 x 25 ReLU, Adam at a constant rate: the paper's",
          network_in_words<Paper::Network>("10 x 25 ReLU"),
          "Adam",
          {{"network", "10 x 25 ReLU"},
           {"batch", batch_size},
           {"optimizer", "Adam, coupled weight decay"},
           {"learning_rate", adam.learning_rate},
           {"learning_rate_schedule", "constant"},
           {"weight_decay", adam.weight_decay},
           {"lambda_max", annealing.maximum},
           {"cycles", annealing.cycles},
           {"hold", annealing.hold},
           {"step_gain", pinnquad::TanhStep{}.gain}},
          train_all<Paper>};
}

}  // namespace programs
