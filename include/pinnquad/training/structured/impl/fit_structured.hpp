// SPDX-License-Identifier: MIT
// Bodies of fit_structured.hpp: the structured models of one feature set, and the choice between sets.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "pinnquad/training/structured/agreement.hpp"
#include "pinnquad/training/structured/fit_structured.hpp"

namespace pinnquad {
namespace detail {

/// All rows of some groups.
PINNQUAD_BODY RowSet rows_of(const std::vector<RowSet>& groups) {
  RowSet rows;
  for (const RowSet& group : groups) {
    for (const FlightRows& piece : group.pieces()) rows.add(*piece.flight, piece.rows);
  }
  return rows;
}

/// These rows one after the other, without those of one group.
PINNQUAD_BODY FitRows joined(const std::vector<FitRows>& groups, std::size_t without) {
  FitRows all{groups.front().inputs, {}, {}};
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (i == without) continue;
    all.features.insert(all.features.end(), groups[i].features.begin(), groups[i].features.end());
    all.outputs.insert(all.outputs.end(), groups[i].outputs.begin(), groups[i].outputs.end());
  }
  return all;
}

/// The fits of one feature set. The base is the same of all seeds, the residual is not: fits of several threads share
/// one of these.
class StructuredFitter {
 public:
  StructuredFitter(const StructuredSet& set, const RowSplit& split, const StructuredSettings& settings)
      : settings_(settings),
        kind_(set.residual),
        fitted_(settings.fit_validation ? rows_of({split.train, split.validation}) : split.train),
        context_(set.context(fitted_)) {
    if (settings.pinned_slopes) pinned_ = hover_slopes(context_.airframe);
    std::vector<RowSet> groups;
    std::vector<RegressionSums> sums;
    for (const RowSet& group : left_out_groups(fitted_)) {
      RegressionSums of_group = regression_sums(context_, group);
      if (!(of_group.rows() > 0)) continue;  // no window is complete there
      groups.push_back(group);
      sums.push_back(std::move(of_group));
    }
    measured_ = map_ = fit_monotone_base(context_, sums, pinned_);
    slopes_ = measure_slopes(context_, fitted_, pinned_, measured_);
    if (!settings.fit_validation) {
      validation_ = fit_rows(context_, split.validation);
    } else if (settings.residual.epochs < 1) {
      return;
    }
    rows_ = fit_rows(context_, fitted_);
    const bool whole_flights = whole_flight_groups(fitted_).size() > 1;
    if (groups.size() < 2 || !(settings.fit_validation || whole_flights)) return;
    for (std::size_t out = 0; out < groups.size(); ++out) {
      groups_.push_back(fit_rows(context_, groups[out]));
      std::vector<RegressionSums> others = sums;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(out));
      without_.push_back(fit_monotone_base(context_, others, pinned_));
    }
  }

  const FitContext& context() const { return context_; }
  const RowSet& fitted_rows() const { return fitted_; }

  /// None where `goes_on` stopped it.
  std::optional<SeedFit> operator()(std::uint64_t seed, const GoesOn& goes_on) const {
    const auto start = std::chrono::steady_clock::now();
    const auto done = [&](std::vector<float> parameters, bool has_residual, double error) {
      SeedFit made{with_measured_slopes(std::move(parameters)), has_residual, false, seed, error, 0, slopes_};
      made.training_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      return made;
    };
    if (settings_.fit_validation) return fit_by_groups(seed, goes_on, done);
    const FittedResidual fit = fitted(rows_, map_, seed, goes_on);
    if (!fit.finished) return {};
    bool kept = fit.residual_kept;
    if (kept && !groups_.empty()) {
      const std::optional<bool> gains = gains_on_flights_left_out(seed, goes_on);
      if (!gains) return {};
      kept = *gains;
    }
    return kept ? done(fit.predictor, true, fit.error) : done(fit.base, false, fit.base_error);
  }

 private:
  FittedResidual fitted(const FitRows& training, const AffineMap& map, std::uint64_t seed,
                        const GoesOn& goes_on) const {
    std::mt19937_64 engine(seed);
    return fit_residual(context_, kind_, training, validation_, map, settings_.residual, engine, goes_on);
  }

  /// The base with its measured slopes. A sum that has them by smoothed rows has no residual: what a network is shown,
  /// it would use to take them back.
  std::vector<float> with_measured_slopes(std::vector<float> parameters) const {
    if (!slopes_.smoothed()) return parameters;
    const std::vector<float> base = base_parameters(context_.features.accelerations, measured_);
    std::copy(base.begin(), base.end(), parameters.begin());
    for (std::size_t k = 0; k < slopes_.of.size() && parameters.size() > base.size(); ++k) {
      if (slopes_.of[k].smoothed()) parameters[base.size() + k] = parameters[base.size() + 4 + k] = 0;
    }
    return parameters;
  }

  /// Does the residual lower the error on whole flights, each left out in turn of the rows that it is fitted to? None
  /// where `goes_on` stopped it.
  std::optional<bool> gains_on_flights_left_out(std::uint64_t seed, const GoesOn& goes_on) const {
    double base_error = 0, error = 0;
    for (std::size_t out = 0; out < groups_.size(); ++out) {
      const FittedResidual fit = fitted(joined(groups_, out), without_[out], seed, goes_on);
      if (!fit.finished) return {};
      const FitRows& unseen = groups_[out];
      const double of_base = unseen.size() * command_error(context_, {kind_.base, fit.base}, unseen);
      base_error += of_base;
      error += fit.predictor.empty()
                   ? of_base
                   : unseen.size() * command_error(context_, {kind_.predictor, fit.predictor}, unseen);
    }
    return error < (1 - settings_.residual.least_gain) * base_error;
  }

  /// Groups left out in turn say how long the residual is trained and what share of each output counts; then base and
  /// residual are fitted to all rows.
  template <class Done>
  std::optional<SeedFit> fit_by_groups(std::uint64_t seed, const GoesOn& goes_on, const Done& done) const {
    const std::vector<float> base = base_parameters(context_.features.accelerations, map_);
    if (groups_.empty()) {  // nothing to choose by
      return done(base, false, std::numeric_limits<double>::quiet_NaN());
    }
    const int epochs = settings_.residual.epochs;
    std::vector<Agreement> by_epoch(static_cast<std::size_t>(epochs));
    const auto train = [&](const FitRows& training, const FitRows& unseen, int until, const auto& visit) {
      std::mt19937_64 engine(seed);
      return train_residual(context_, kind_, training, unseen, settings_.residual, until, engine, goes_on, visit);
    };
    for (std::size_t out = 0; out < groups_.size(); ++out) {
      const auto left = [&](FitRows rows) { return left_by(context_, kind_, without_[out], std::move(rows)); };
      const FitRows unseen = left(groups_[out]);
      const bool finished = train(left(joined(groups_, out)), unseen, epochs, [&](ResidualTrainer& trainer, int epoch) {
        agree(by_epoch[static_cast<std::size_t>(epoch)], trainer.predictions(), unseen.outputs);
      });
      if (!finished) return {};
    }
    std::size_t best = 0;
    for (std::size_t epoch = 1; epoch < by_epoch.size(); ++epoch) {
      if (by_epoch[epoch].gain() > by_epoch[best].gain()) best = epoch;
    }
    const Agreement& chosen = by_epoch[best];
    const double error = chosen.error();
    if (!(chosen.gain() > 0)) return done(base, false, error);
    std::vector<float> residual;
    const FitRows all = left_by(context_, kind_, map_, rows_);
    if (!train(all, FitRows{all.inputs, {}, {}}, static_cast<int>(best) + 1,
               [&](ResidualTrainer& trainer, int) { residual = trainer.parameters(); })) {
      return {};
    }
    take_shares(residual, chosen);
    return done(base_and_residual(kind_, base, residual, all), true, error);
  }

  void agree(Agreement& agreement, const std::vector<float>& said, const std::vector<float>& truth) const {
    agreement.begin_group();
    for (std::size_t i = 0; i < said.size(); ++i) {
      const std::size_t k = i % AxisCommandOutputs::size;
      const double unit = context_.output_deviation[k];
      agreement.add(static_cast<int>(k), unit * static_cast<double>(said[i]), unit * static_cast<double>(truth[i]));
    }
  }

  /// In the last layer, which is affine: weights by output, then biases.
  void take_shares(std::vector<float>& residual, const Agreement& agreement) const {
    const int width = DescribedPredictor(kind_.network, residual).last_width();
    auto weight = residual.end() - AxisCommandOutputs::size * (width + 1);
    for (int k = 0; k < AxisCommandOutputs::size; ++k) {
      const auto share = static_cast<float>(agreement.share(k));
      for (int i = 0; i < width; ++i) *weight++ *= share;
      *(residual.end() - AxisCommandOutputs::size + k) *= share;
    }
  }

  StructuredSettings settings_;
  const ResidualKind& kind_;
  RowSet fitted_;
  FitContext context_;
  std::optional<AxisSlopes> pinned_;
  AffineMap map_;       ///< by least squares
  AffineMap measured_;  ///< by smoothed rows where noise bends it
  MeasuredSlopes slopes_;
  FitRows rows_, validation_;       ///< the rows that are fitted; others, where those stop the residual
  std::vector<FitRows> groups_;     ///< left out in turn, where they choose
  std::vector<AffineMap> without_;  ///< the bases without them
};

}  // namespace detail

PINNQUAD_BODY const detail::StructuredFitter& StructuredBases::fitter(bool with_altitude,
                                                                      const StructuredSettings& settings) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  auto& made = fitters_[with_altitude ? 1 : 0];
  if (!made) made = std::make_shared<const detail::StructuredFitter>(set(with_altitude), split_, settings);
  return *made;
}

PINNQUAD_BODY detail::SeedFits StructuredBases::fit(const StructuredSettings& settings, const FitWork& work) const {
  using Altitude = StructuredSettings::Altitude;
  using detail::SeedFit;
  const Altitude rule = chooses_altitude() ? settings.altitude : Altitude::no;
  if (rule != Altitude::no) fitter(true, settings);
  if (rule != Altitude::yes) fitter(false, settings);
  const auto fit_one = [&](bool with_altitude, std::uint64_t seed) {
    auto made = fitter(with_altitude, settings)(seed, [&work](int epoch) { return work.goes_on(epoch); });
    if (made) made->with_altitude = with_altitude;
    return made;
  };

  FitWork::Altitude choice;
  choice.taken = rule == Altitude::yes;
  std::vector<std::optional<SeedFit>> made(static_cast<std::size_t>(std::max(settings.seeds, 0)));
  std::size_t next = 0;  // seed that is fitted next
  if (rule == Altitude::by_validation && !made.empty()) {
    std::optional<SeedFit> tried[2];
    work.run(2, [&](std::size_t i) { return (tried[i] = fit_one(i == 1, settings.first_seed)).has_value(); });
    if (!tried[0] || !tried[1]) return {choice, {}, {}, {}};
    choice.error_without = tried[0]->validation_error;
    choice.error_with = tried[1]->validation_error;
    choice.taken = *choice.error_with < (1 - settings.least_altitude_gain) * *choice.error_without;
    made[next++] = std::move(tried[choice.taken ? 1 : 0]);
  }
  work.chose(choice);
  const auto finish = [&](std::size_t i) {
    made[next + i] = fit_one(choice.taken, settings.first_seed + static_cast<std::uint64_t>(next + i));
    return made[next + i].has_value();
  };
  if (next < made.size()) work.run(made.size() - next, finish);
  const detail::StructuredFitter& of_all = fitter(choice.taken, settings);
  detail::SeedFits fits{choice, {}, of_all.context(), of_all.fitted_rows()};
  for (auto& one : made) {
    if (one) fits.fits.push_back(std::move(*one));
  }
  return fits;
}

namespace detail {

/// The residual, the base, and both, of these features: as descriptions, or as types of a header, which have other
/// words for three things.
PINNQUAD_BODY std::array<std::string, 3> monotone_texts(const GroundFeatures& features, std::string network,
                                                        const std::string& inputs, const std::string& bounded,
                                                        const std::string& masked) {
  std::string places = std::to_string(features.size());
  for (const int place : features.accelerations) places += ", " + std::to_string(place);
  const std::string one = inputs + "<1>";
  const std::size_t others = features.size() - 3 * features.accelerations.size();
  network.replace(network.find(one), one.size(), inputs + "<" + std::to_string(others) + ">");
  const std::string base = "pinnquad::AxisAligned<float, " + places + ">";
  return {network, base,
          "pinnquad::Sum<" + base + ", " + bounded + "<" + masked + "<" + network + ", " + places + ">>>"};
}

}  // namespace detail

PINNQUAD_BODY StructuredSet structured_set(GroundFeatures features, const GivenAirframe& airframe,
                                           detail::ResidualTrainer::Make trainer) {
  if (features.accelerations.empty()) {
    throw std::invalid_argument("a structured model needs features that hold the angular acceleration");
  }
  const detail::PredictorText one = detail::predictor_text<StructuredResidual<1>>();
  const auto said =
      detail::monotone_texts(features, one.description, "pinnquad::Inputs", "pinnquad::Bounded", "pinnquad::Withheld");
  const auto types =
      detail::monotone_texts(features, one.type, "pinnquad::InputSize", "pinnquad::Saturated", "pinnquad::Masked");
  return {std::move(features),
          airframe,
          {{said[0], types[0]}, {said[1], types[1]}, {said[2], types[2]}, false, std::move(trainer)}};
}

#ifdef PINNQUAD_COMPILED
namespace detail {
template class ResidualTrainerOf<StructuredResidual<16>, NoProjection>;
template class ResidualTrainerOf<StructuredResidual<32>, NoProjection>;
}  // namespace detail
#endif

}  // namespace pinnquad
