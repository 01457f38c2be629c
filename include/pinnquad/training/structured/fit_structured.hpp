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

/// The settings of fit_structured().
struct StructuredSettings {
  /// Whether the model is shown the altitude above ground. A model that is shown it must be given it in flight.
  enum class Altitude {
    by_validation,  ///< shown where it lowers the error on the validation rows much
    yes,
    no
  };

  ResidualTraining residual{};
  bool pinned_slopes = false;  ///< the base's slopes are the airframe's in hover; false: learnt
  Altitude altitude = Altitude::by_validation;
  double least_altitude_gain = 0.2;  ///< by_validation: least share of the error that the altitude must take away
  std::uint64_t first_seed = 1;
  int seeds = 5;
};

/// The training in words, for Provenance::loss.
inline constexpr const char* structured_in_words =
    "least squares, slopes above 0; MSE of the residual, which sees no angular acceleration";

/// The models of all seeds that were finished, in the order of the seeds. A model has its residual where that helps.
struct StructuredFits {
  /// The residual network.
  template <class Features>
  using Residual = Mlp<float, InputSize<residual_inputs<Features>>, Hidden<2, 32>, OutputSize<4>, Relu>;
  template <class Features, class Predictor>
  using TrainedAs = TrainedModel<Predictor, Context<Features, GivenAirframe, AxisCommandOutputs>>;
  template <class Features>
  using Base = TrainedAs<Features, MonotoneBase<Features>>;
  template <class Features>
  using BaseAndResidual = TrainedAs<Features, MonotonePredictor<Features, Residual<Features>>>;

  /// Base alone or base and residual, without the altitude or with it.
  using Model = std::variant<Base<InverseFeatures>, BaseAndResidual<InverseFeatures>, Base<InverseFeaturesWithAltitude>,
                             BaseAndResidual<InverseFeaturesWithAltitude>>;
  /// The model of one seed.
  struct Fit {
    Model model;
    std::uint64_t seed = 0;
    double validation_error = 0;  ///< mean absolute error of the commands on the validation rows
    double training_s = 0;        ///< wall-clock time of the residual's training
  };
  /// The choice of the altitude. Errors are those of the first seed; none where the rule is not by_validation.
  struct Choice {
    bool taken = false;
    std::optional<double> error_with, error_without;
  };

  Choice altitude;
  std::vector<Fit> models;

  /// The model with the least error on the validation rows. Throws std::logic_error where no model was finished.
  const Fit& best() const {
    const auto less = [](const Fit& a, const Fit& b) {
      return is_finite(a.validation_error) && !(b.validation_error <= a.validation_error);  // NaN is the worst
    };
    if (models.empty()) throw std::logic_error("structured fit: no model was finished");
    return *std::min_element(models.begin(), models.end(), less);
  }
};

namespace detail {

/// Runs the fits of fit_structured() one after the other.
struct InTurn {
  template <class Job>
  void run(std::size_t count, const Job& job) const {
    for (std::size_t i = 0; i < count && job(i); ++i) {
    }
  }
  bool goes_on(int /*epoch*/) const { return true; }
  void chose(const StructuredFits::Choice&) const {}
};

/// The fits of one feature set. The base is the same of all seeds, the residual is not.
template <class Features>
class StructuredFitter {
  using ContextType = Context<Features, GivenAirframe, AxisCommandOutputs>;

 public:
  StructuredFitter(const RowSplit& split, const GivenAirframe& airframe, const StructuredSettings& settings)
      : split_(split), settings_(settings), context_(make_context<ContextType>(split.train, airframe)) {
    std::optional<AxisSlopes> pinned;
    if (settings.pinned_slopes) pinned = hover_slopes(airframe.airframe<double>());
    map_ = fit_monotone_base(context_, split.train, pinned);
  }

  /// None where `goes_on` stopped it.
  template <class GoesOn>
  std::optional<StructuredFits::Fit> operator()(std::uint64_t seed, const GoesOn& goes_on) const {
    const auto start = std::chrono::steady_clock::now();
    std::mt19937_64 engine(seed);
    const auto fit = fit_monotone<StructuredFits::Residual<Features>>(context_, split_.train, split_.validation, map_,
                                                                      settings_.residual, engine, goes_on);
    if (!fit.finished) return {};
    const auto done = [&](const auto& predictor, double error) {
      StructuredFits::Fit made{make_trained_model(predictor, context_, split_.train), seed, error, 0};
      made.training_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      return made;
    };
    return fit.residual_kept ? done(fit.predictor, fit.error) : done(fit.base, fit.base_error);
  }

 private:
  const RowSplit& split_;
  const StructuredSettings& settings_;
  ContextType context_;
  AffineMap map_;
};

}  // namespace detail

/// Fits a structured model from each seed. The first seed tries both feature sets where the altitude is chosen
/// by_validation. Throws std::invalid_argument for rows that are too few, and for an airframe that can't fly.
/// `work` runs the fits; without it they run one after the other. A class of one's own, with threads, progress and
/// interrupts, has
///   template <class Job> void run(std::size_t count, const Job& job);  // calls job(i) for each i below `count`, also
///       // from several threads. A job that returns false was stopped: no further one need be started.
///   bool goes_on(int epoch);                     // asked before each epoch of each fit; false stops it
///   void chose(const StructuredFits::Choice&);   // called once, before the fits of the other seeds
template <class Work = detail::InTurn>
StructuredFits fit_structured(const RowSplit& split, const GivenAirframe& airframe,
                              const StructuredSettings& settings = {}, Work&& work = {}) {
  using Altitude = StructuredSettings::Altitude;
  std::optional<detail::StructuredFitter<InverseFeatures>> lower;
  std::optional<detail::StructuredFitter<InverseFeaturesWithAltitude>> higher;
  if (settings.altitude != Altitude::no) higher.emplace(split, airframe, settings);
  if (settings.altitude != Altitude::yes) lower.emplace(split, airframe, settings);
  const auto fit = [&](bool with_altitude, std::uint64_t seed) {
    const auto goes_on = [&work](int epoch) { return work.goes_on(epoch); };
    return with_altitude ? (*higher)(seed, goes_on) : (*lower)(seed, goes_on);
  };

  StructuredFits fits;
  StructuredFits::Choice& choice = fits.altitude;
  choice.taken = settings.altitude == Altitude::yes;
  std::vector<std::optional<StructuredFits::Fit>> made(static_cast<std::size_t>(std::max(settings.seeds, 0)));
  std::size_t next = 0;  // seed that is fitted next
  if (settings.altitude == Altitude::by_validation && !made.empty()) {
    std::optional<StructuredFits::Fit> tried[2];  // without the altitude, with it
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
  for (auto& one : made) {
    if (one) fits.models.push_back(std::move(*one));
  }
  return fits;
}

/// The same for an airframe that the compiler knows.
template <class Vehicle, class Work = detail::InTurn>
StructuredFits fit_structured(const RowSplit& split, const StructuredSettings& settings = {}, Work&& work = {}) {
  return fit_structured(split, GivenAirframe(Vehicle::name, airframe_value<Vehicle, double>()), settings,
                        std::forward<Work>(work));
}

}  // namespace pinnquad
