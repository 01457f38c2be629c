// SPDX-License-Identifier: MIT
// Models of the paper's features that nobody trains: linear regression, and Eq. (3) of the airframe as it is given.
#include "training/log_closed_form.hpp"
#include "training/log_kinds.hpp"

#include "pinnquad/outputs/residual_outputs.hpp"

namespace programs {

namespace {

std::shared_ptr<const TrainedNetwork> fit_linear(const FitTask& fit) {
  return with_paper_features(fit, [&](auto tag) {
    return fit_affine<typename decltype(tag)::type>(fit, [](const auto& context, const pinnquad::RowSet& rows) {
      return solved_least_squares(log_sums(context, rows));
    });
  });
}

/// A residual of 0 on Eq. (3) inverted.
std::shared_ptr<const TrainedNetwork> fit_linearized(const FitTask& fit) {
  using Context = LogContext<pinnquad::PaperFeatures, pinnquad::ResidualOutputs<pinnquad::LinearizedBase>>;
  const pinnquad::RowSet rows = rows_not_held_out(fit);
  Context context = log_context<Context>(fit, rows);
  context.output.mean = {};
  return log_model_of(
      pinnquad::Network<float, pinnquad::InputSize<Context::Features::size>, pinnquad::Dense<Context::output_count>>{},
      context, rows);
}

}  // namespace

ModelKind log_linear() {
  return {"linear",
          "linear on the paper's features",
          TimeReach::present,
          false,
          needs_velocity,
          fit_linear,
          takes_validation_rows};
}
ModelKind log_linearized() {
  return {"linearized",         "linearized model of the airframe",
          TimeReach::present,   false,
          needs_velocity,       fit_linearized,
          takes_validation_rows};
}

}  // namespace programs
