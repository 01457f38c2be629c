// SPDX-License-Identifier: MIT
// The structured model of the library (training/structured/fit_structured.hpp) as a kind, for the features that the
// flights have: velocity and battery where they were measured, the altitude where the validation rows gain by it.
#pragma once

#include <algorithm>
#include <memory>
#include <type_traits>
#include <variant>
#include <vector>

#include "command_line/interrupt.hpp"
#include "pinnquad/training/structured/fit_structured.hpp"
#include "training/log_features.hpp"
#include "training/network_kinds.hpp"

namespace programs {

/// Limits of trust are of models without a window.
template <class Model>
using ExportedStructured =
    NetworkOfModel<Model, ExportedAirframe::by_value, !pinnquad::is_windowed<typename Model::Features>>;

/// A structured model, how it was chosen whether it is shown the altitude, and what is known of its slopes. Where they
/// are by instruments, it is judged by features without their noise.
template <class Model>
class StructuredNetwork : public ExportedStructured<Model> {
 public:
  StructuredNetwork(const Model& model, const pinnquad::RowSet& training, const AltitudeChoice& altitude,
                    const pinnquad::MeasuredSlopes& slopes, bool fits_validation)
      : ExportedStructured<Model>(model, training),
        altitude_(altitude),
        slopes_(slopes),
        input_(model.input),
        fits_validation_(fits_validation) {}
  Predictions predictions(const pinnquad::RowSet& rows) const override {
    if (!slopes_.by_instruments()) return ExportedStructured<Model>::predictions(rows);
    Predictions result = without_answer(rows);
    pinnquad::each_denoised<typename Model::Features>(
        input_, slopes_, rows,
        [&](std::size_t row, const std::vector<double>& x) { result[row] = this->block()->commands(x); });
    return result;
  }
  Answers answers(const pinnquad::RowSet& rows) const override {
    Answers result = ExportedStructured<Model>::answers(rows);
    if (slopes_.by_instruments()) result.predictions = predictions(rows);
    return result;
  }
  AltitudeChoice altitude() const override { return altitude_; }
  pinnquad::SlopesOfSums slopes() const override { return slopes_.of; }
  /// Limits are found by rows that it was not fitted to.
  bool has_trust() const override { return ExportedStructured<Model>::has_trust() && !fits_validation_; }

 private:
  AltitudeChoice altitude_;
  pinnquad::MeasuredSlopes slopes_;
  decltype(Model::input) input_;
  bool fits_validation_;
};

inline bool fits_validation(const FitSettings& settings) { return settings.fit_validation; }

/// Work of fit_structured(): one fit after the other, with progress; Ctrl-C stops it.
class StructuredWork {
 public:
  StructuredWork(const FitTask& task, int epochs) : task_(task), epochs_(epochs) {}

  template <class Job>
  void run(std::size_t count, const Job& job) {
    fits_ = static_cast<double>(count);
    for (std::size_t i = 0; i < count; ++i) {
      if (!job(i)) throw Interrupted{};
      done_ += 1;
    }
  }
  bool goes_on(int epoch) const {
    task_.share_done((done_ + static_cast<double>(epoch) / epochs_) / fits_);
    return !interrupted();
  }
  void chose(const pinnquad::StructuredAltitude&) const {}

 private:
  const FitTask& task_;
  int epochs_;
  double fits_ = 1, done_ = 0;
};

/// As many steps as a recipe takes on the 9,000 training rows of a flight of the paper, over all groups left out.
inline int structured_epochs(const FitTask& task) {
  if (task.epochs > 0) return task.epochs;
  const double groups = static_cast<double>(pinnquad::left_out_groups(task.training).size());
  const double rows = static_cast<double>(task.training.size()) * (task.settings.fit_validation ? groups : 1);
  return std::clamp(static_cast<int>(recipe_epochs * 9000.0 / std::max(rows, 1.0)), 12, recipe_epochs);
}

template <class Features, class WithAltitude>
std::shared_ptr<const TrainedNetwork> fit_structured_on(const FitTask& task) {
  using Rule = pinnquad::StructuredSettings::Altitude;
  using Fits = pinnquad::StructuredFitsOf<Features, WithAltitude>;
  pinnquad::StructuredSettings settings;
  settings.residual.epochs = structured_epochs(task);
  settings.pinned_slopes = task.settings.pinned_slopes;
  settings.fit_validation = task.settings.fit_validation;
  settings.altitude = task.lacks("altitude")    ? Rule::no
                      : !task.settings.altitude ? Rule::by_validation
                      : *task.settings.altitude ? Rule::yes
                                                : Rule::no;
  settings.first_seed = task.seed;
  settings.seeds = 1;
  const pinnquad::RowSplit split{task.training, task.validation, {}};
  const Fits fits = pinnquad::fit_structured<Fits>(split, task.given_airframe(), settings,
                                                   StructuredWork(task, settings.residual.epochs));
  AltitudeChoice altitude;
  altitude.applies = Fits::has_altitude;
  altitude.taken = fits.altitude.taken;
  altitude.error_with = fits.altitude.error_with.value_or(pinnquad::not_a_number);
  altitude.error_without = fits.altitude.error_without.value_or(pinnquad::not_a_number);
  const auto& best = fits.best();
  return std::visit(
      [&](const auto& model) -> std::shared_ptr<const TrainedNetwork> {
        return std::make_shared<StructuredNetwork<std::decay_t<decltype(model)>>>(model, task.training, altitude,
                                                                                  best.slopes, settings.fit_validation);
      },
      best.model);
}

/// Of what an asked motion can have, as far as the flights have it.
template <TimeReach Reach>
std::shared_ptr<const TrainedNetwork> fit_structured_kind(const FitTask& task) {
  using namespace pinnquad;
  const auto fit = [&task](auto lower, auto higher) {
    using Lower = LogFeatures<Reach, typename decltype(lower)::type, InverseAccelerations>;
    using Higher = LogFeatures<Reach, typename decltype(higher)::type, InverseAccelerations>;
    return fit_structured_on<Lower, Higher>(task);
  };
  if (!task.lacks("velocity")) return with_battery<InverseFeatures, InverseFeaturesWithAltitude>(task, fit);
  using Without = InverseFeaturesWithoutVelocity;
  return with_battery<Without, Without>(task, fit);
}

}  // namespace programs
