// SPDX-License-Identifier: MIT
// The structured model, whole: a monotone base in closed form and a residual network, fitted from several seeds. The
// validation rows choose whether the model is shown the altitude, and whether the residual is kept.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>
#include <stdexcept>
#include <utility>
#include <variant>
#include <vector>

#include "pinnquad/core/finite.hpp"
#include "pinnquad/data/split.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/training/structured/residual_fit.hpp"

namespace pinnquad {

/// Whether a structured model is shown the altitude above ground. A model that is shown it must be given it in flight.
enum class AltitudeRule {
  by_validation,  ///< shown where it lowers the error on the validation rows much
  yes,
  no
};

/// The settings of fit_structured().
struct StructuredSettings {
  ResidualTraining residual{};
  bool pinned_slopes = false;  ///< the base's slopes are the airframe's in hover; false: learnt
  AltitudeRule altitude = AltitudeRule::by_validation;
  double least_altitude_gain = 0.2;  ///< by_validation: least share of the error that the altitude must take away
  std::uint64_t first_seed = 1;
  int seeds = 5;
};

/// The training in words, for Provenance::loss.
inline constexpr const char* structured_in_words =
    "least squares, slopes above 0; MSE of the residual, which sees no angular acceleration";

/// The residual network of a structured model.
template <class Features>
using StructuredResidual = Mlp<float, InputSize<residual_inputs<Features>>, Hidden<2, 32>, OutputSize<4>, Relu>;

namespace detail {
template <class Features>
using StructuredContext = Context<Features, GivenAirframe, AxisCommandOutputs>;
template <class Features>
using StructuredBase = TrainedModel<MonotoneBase<Features>, StructuredContext<Features>>;
template <class Features>
using StructuredSum =
    TrainedModel<MonotonePredictor<Features, StructuredResidual<Features>>, StructuredContext<Features>>;
}  // namespace detail

/// Base alone or base and residual, without the altitude or with it.
using StructuredModel = std::variant<detail::StructuredBase<InverseFeatures>, detail::StructuredSum<InverseFeatures>,
                                     detail::StructuredBase<InverseFeaturesWithAltitude>,
                                     detail::StructuredSum<InverseFeaturesWithAltitude>>;

/// The model of one seed.
struct StructuredFit {
  StructuredModel model;
  std::uint64_t seed = 0;
  double validation_error = 0;  ///< mean absolute error of the commands on the validation rows
  double training_s = 0;        ///< wall-clock time of the residual's training
};

/// The choice of the altitude. Errors are those of the first seed; none where the rule is not by_validation.
struct AltitudeChoice {
  bool taken = false;
  std::optional<double> error_with, error_without;
};

/// The models of all seeds that were finished, in the order of the seeds. A model has its residual where that helps.
struct StructuredFits {
  AltitudeChoice altitude;
  std::vector<StructuredFit> models;

  /// The model with the least error on the validation rows. Throws std::logic_error where no model was finished.
  const StructuredFit& best() const {
    const auto less = [](const StructuredFit& a, const StructuredFit& b) {
      return is_finite(a.validation_error) && !(b.validation_error <= a.validation_error);  // NaN is the worst
    };
    if (models.empty()) throw std::logic_error("structured fit: no model was finished");
    return *std::min_element(models.begin(), models.end(), less);
  }
};

/// Runs the fits of fit_structured() one after the other. A program passes a class of its own, with threads, progress
/// and interrupts.
struct InTurn {
  /// Calls job(i) for each i below `count`, also from several threads. A job that returns false was stopped: no further
  /// one need be started.
  template <class Job>
  void run(std::size_t count, const Job& job) const {
    for (std::size_t i = 0; i < count && job(i); ++i) {
    }
  }
  bool goes_on(int /*epoch*/) const { return true; }  ///< asked before each epoch of each fit; false stops it
  void chose(const AltitudeChoice&) const {}          ///< called once, before the fits of the other seeds
};

namespace detail {

/// The fits of one feature set. The base is the same of all seeds, the residual is not.
template <class Features>
class StructuredFitter {
 public:
  StructuredFitter(const RowSplit& split, const ContextAirframe<GivenAirframe>& airframe,
                   const StructuredSettings& settings)
      : split_(split),
        settings_(settings),
        context_(make_context<StructuredContext<Features>>(split.train, airframe)),
        map_(fit_monotone_base(context_, split.train, slope_rule(airframe, settings))) {}

  /// None where `goes_on` stopped it.
  template <class GoesOn>
  std::optional<StructuredFit> operator()(std::uint64_t seed, const GoesOn& goes_on) const {
    const auto start = std::chrono::steady_clock::now();
    std::mt19937_64 engine(seed);
    const auto fit = fit_monotone<StructuredResidual<Features>>(context_, split_.train, split_.validation, map_,
                                                                settings_.residual, engine, goes_on);
    if (!fit.finished) return {};
    const auto done = [&](const auto& predictor, double error) {
      StructuredFit made{make_trained_model(predictor, context_, split_.train), seed, error, 0};
      made.training_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      return made;
    };
    return fit.residual_kept ? done(fit.predictor, fit.error) : done(fit.base, fit.base_error);
  }

 private:
  static SlopeRule slope_rule(const ContextAirframe<GivenAirframe>& airframe, const StructuredSettings& settings) {
    SlopeRule rule;
    if (settings.pinned_slopes) rule.pinned = hover_slopes(airframe.airframe<double>());
    return rule;
  }

  const RowSplit& split_;
  const StructuredSettings& settings_;
  StructuredContext<Features> context_;
  AffineMap map_;
};

}  // namespace detail

/// Fits a structured model from each seed. The first seed tries both feature sets where the altitude is chosen
/// by_validation. Throws std::invalid_argument for rows that are too few, and for an airframe that can't fly.
template <class Work = InTurn>
StructuredFits fit_structured(const RowSplit& split, const ContextAirframe<GivenAirframe>& airframe,
                              const StructuredSettings& settings = {}, Work&& work = {}) {
  std::optional<detail::StructuredFitter<InverseFeatures>> lower;
  std::optional<detail::StructuredFitter<InverseFeaturesWithAltitude>> higher;
  if (settings.altitude != AltitudeRule::no) higher.emplace(split, airframe, settings);
  if (settings.altitude != AltitudeRule::yes) lower.emplace(split, airframe, settings);
  const auto fit = [&](bool with_altitude, std::uint64_t seed) {
    const auto goes_on = [&work](int epoch) { return work.goes_on(epoch); };
    return with_altitude ? (*higher)(seed, goes_on) : (*lower)(seed, goes_on);
  };

  StructuredFits fits;
  AltitudeChoice& choice = fits.altitude;
  choice.taken = settings.altitude == AltitudeRule::yes;
  std::vector<std::optional<StructuredFit>> made(static_cast<std::size_t>(std::max(settings.seeds, 0)));
  std::size_t next = 0;  // seed that is fitted next
  if (settings.altitude == AltitudeRule::by_validation && !made.empty()) {
    std::optional<StructuredFit> tried[2];  // without the altitude, with it
    work.run(2, [&](std::size_t i) { return (tried[i] = fit(i == 1, settings.first_seed)).has_value(); });
    if (!tried[0] || !tried[1]) return fits;
    choice.error_without = tried[0]->validation_error;
    choice.error_with = tried[1]->validation_error;
    choice.taken = *choice.error_with < (1 - settings.least_altitude_gain) * *choice.error_without;
    made[next++] = std::move(tried[choice.taken ? 1 : 0]);
  }
  work.chose(choice);
  const auto finish = [&](std::size_t i) {
    made[next + i] = fit(choice.taken, settings.first_seed + static_cast<std::uint64_t>(next + i));
    return made[next + i].has_value();
  };
  if (next < made.size()) work.run(made.size() - next, finish);
  for (std::optional<StructuredFit>& one : made) {
    if (one) fits.models.push_back(std::move(*one));
  }
  return fits;
}

/// The same for an airframe that the compiler knows.
template <class Vehicle, class Work = InTurn>
StructuredFits fit_structured(const RowSplit& split, const StructuredSettings& settings = {}, Work&& work = {}) {
  return fit_structured(split, ContextAirframe<GivenAirframe>(Vehicle::name, airframe_value<Vehicle, double>()),
                        settings, std::forward<Work>(work));
}

}  // namespace pinnquad
