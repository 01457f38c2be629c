// SPDX-License-Identifier: MIT
// The structured kinds, for the features that the flights have: velocity and battery where they were measured, the
// altitude where the validation rows gain by it.

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command_line/interrupt.hpp"
#include "pinnquad/deploy/structured_model.hpp"
#include "training/log_features.hpp"
#include "training/log_kinds.hpp"

namespace programs {

namespace {

/// A structured model, how it was chosen whether it is shown the altitude, and what is known of its slopes. Where they
/// are by smoothed rows, it is judged by features without their noise.
class StructuredNetwork : public ExportableNetwork {
 public:
  /// Limits of trust are of models without a window, and found by rows that they were not fitted to.
  StructuredNetwork(pinnquad::GroundModel<float> model, pinnquad::FitContext context, const pinnquad::RowSet& training,
                    const AltitudeChoice& altitude, const pinnquad::MeasuredSlopes& slopes, bool fits_validation)
      : ExportableNetwork(std::move(model), training, !context.is_windowed() && !fits_validation),
        altitude_(altitude),
        slopes_(slopes),
        context_(std::move(context)) {}
  Predictions predictions(const pinnquad::RowSet& rows) const override {
    if (!slopes_.smoothed()) return ExportableNetwork::predictions(rows);
    Predictions result = without_answer(rows);
    pinnquad::each_denoised(context_, slopes_, rows, [&](std::size_t row, const std::vector<double>& x) {
      result[row] = this->block()->commands(x);
    });
    return result;
  }
  Answers answers(const pinnquad::RowSet& rows) const override {
    Answers result = ExportableNetwork::answers(rows);
    if (slopes_.smoothed()) result.predictions = predictions(rows);
    return result;
  }
  AltitudeChoice altitude() const override { return altitude_; }
  pinnquad::SlopesOfSums slopes() const override { return slopes_.of; }

 private:
  AltitudeChoice altitude_;
  pinnquad::MeasuredSlopes slopes_;
  pinnquad::FitContext context_;
};

/// Work of fit_structured(), with progress; Ctrl-C stops it.
class StructuredWork : public pinnquad::FitWork {
 public:
  StructuredWork(const FitTask& task, int epochs) : task_(task), epochs_(epochs) {}

  bool goes_on(int epoch) const override {
    task_.share_done(static_cast<double>(epoch) / epochs_);
    return !interrupted();
  }

 private:
  const FitTask& task_;
  int epochs_;
};

/// As many steps as a recipe takes on the 9,000 training rows of a flight of the paper, over all groups left out.
int structured_epochs(const FitTask& task) {
  if (task.epochs > 0) return task.epochs;
  const double groups = static_cast<double>(pinnquad::left_out_groups(task.training).size());
  const double rows = static_cast<double>(task.training.size()) * (task.settings.fit_validation ? groups : 1);
  return std::clamp(static_cast<int>(recipe_epochs * 9000.0 / std::max(rows, 1.0)), 12, recipe_epochs);
}

pinnquad::StructuredSet structured_set(const FitTask& task, TimeReach reach, bool with_altitude) {
  using pinnquad::StructuredResidual, pinnquad::detail::residual_trainer;
  pinnquad::GroundFeatures features = task.shared->keep(inverse_features(task, reach, with_altitude));
  const bool few = features.size() - 3 * features.accelerations.size() <= 16;  // else up to 32
  return pinnquad::structured_set(
      std::move(features), task.given_airframe(),
      few ? residual_trainer<StructuredResidual<16>>() : residual_trainer<StructuredResidual<32>>());
}

template <TimeReach Reach>
std::shared_ptr<const TrainedNetwork> fit_structured_kind(const FitTask& task) {
  using Rule = pinnquad::StructuredSettings::Altitude;
  pinnquad::StructuredSettings settings;
  settings.residual.epochs = task.settings.without_residual ? 0 : structured_epochs(task);
  settings.pinned_slopes = task.settings.pinned_slopes;
  settings.fit_validation = task.settings.fit_validation;
  settings.altitude = task.lacks("altitude")    ? Rule::no
                      : !task.settings.altitude ? Rule::by_validation
                      : *task.settings.altitude ? Rule::yes
                                                : Rule::no;
  settings.first_seed = task.seed;
  settings.seeds = 1;
  const auto make = [&task] {
    std::optional<pinnquad::StructuredSet> higher;  // none where there is no altitude to choose
    if (!task.lacks("velocity")) higher = structured_set(task, Reach, true);
    return std::make_shared<const pinnquad::StructuredBases>(structured_set(task, Reach, false), std::move(higher),
                                                             pinnquad::RowSplit{task.training, task.validation, {}});
  };
  // a judge's rows are other ones
  const auto bases =
      task.settings.without_residual
          ? make()
          : task.shared->once<pinnquad::StructuredBases>("structured " + std::to_string(static_cast<int>(Reach)), make);
  const auto fits = pinnquad::fit_structured(*bases, settings, StructuredWork(task, settings.residual.epochs));
  if (fits.models.empty()) throw Interrupted{};
  AltitudeChoice altitude;
  altitude.applies = bases->chooses_altitude();
  altitude.taken = fits.altitude.taken;
  altitude.error_with = fits.altitude.error_with.value_or(pinnquad::not_a_number);
  altitude.error_without = fits.altitude.error_without.value_or(pinnquad::not_a_number);
  const pinnquad::StructuredFits::Fit& best = fits.best();
  return std::make_shared<StructuredNetwork>(best.model, fits.context, task.training, altitude, best.slopes,
                                             settings.fit_validation);
}

template <TimeReach Reach>
ModelKind structured(const char* key, const char* title, std::string (*not_applicable)(const FitTask&)) {
  return {key,
          title,
          Reach,
          true,
          not_applicable,
          fit_structured_kind<Reach>,
          [](const FitSettings& settings) { return settings.fit_validation; },
          pinnquad::structured_in_words,
          true,
          true};
}

}  // namespace

ModelKind log_structured() { return structured<TimeReach::present>("structured", "structured", always_applicable); }
ModelKind log_structured_causal() {
  return structured<TimeReach::causal>("structured_causal", "structured, the last 160 ms", needs_window);
}
ModelKind log_structured_centred() {
  return structured<TimeReach::centred>("structured_centred", "structured, 80 ms to both sides", needs_window);
}

}  // namespace programs
