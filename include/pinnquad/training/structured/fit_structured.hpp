// SPDX-License-Identifier: MIT
// The structured model, whole: a monotone base in closed form and a residual network, fitted from several seeds. The
// validation rows choose whether the model is shown the altitude, and whether the residual is kept; so do whole
// flights, each left out in turn, where several train. They choose by errors of least squares: rows with noise prefer
// slopes that it bends. What is fitted has the slopes of slopes_under_noise.hpp.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "pinnquad/core/finite.hpp"
#include "pinnquad/data/split.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/training/structured/structured_fitter.hpp"

namespace pinnquad {

/// The training in words, for Provenance::loss.
inline constexpr const char* structured_in_words =
    "least squares, slopes above 0; MSE of the residual, which sees no angular acceleration";

/// The choice of the altitude. Errors are those of the first seed; none where the rule is not by_validation.
struct StructuredAltitude {
  bool taken = false;
  std::optional<double> error_with, error_without;
};

/// The fits of all seeds that were finished, in the order of the seeds. A model has its residual where that helps.
template <class Fit>
struct StructuredFitsIn {
  StructuredAltitude altitude;
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
template <class Set, class Predictor>
using StructuredModel = TrainedModel<Predictor, Context<Set, GivenAirframe, AxisCommandOutputs>>;
/// The residual network.
template <class Set>
using StructuredResidual = pinnquad::Mlp<float, InputSize<residual_inputs<Set>>, Hidden<2, 32>, OutputSize<4>, Relu>;
template <class Set>
using StructuredBase = StructuredModel<Set, MonotoneBase<Set>>;
template <class Set>
using StructuredWhole = StructuredModel<Set, MonotonePredictor<Set, StructuredResidual<Set>>>;
}  // namespace detail

/// The set of these types. The residual trains with its inputs filled up to a multiple of sixteen: few networks are
/// compiled, whatever the features, and the bits are the same.
template <class Features>
StructuredSet structured_set(const GivenAirframe& airframe) {
  using Setting = Context<Features, GivenAirframe, AxisCommandOutputs>;
  using Residual = detail::StructuredResidual<Features>;
  using Trained =
      pinnquad::Mlp<float, InputSize<(residual_inputs<Features> + 15) / 16 * 16>, Hidden<2, 32>, OutputSize<4>, Relu>;
  return {[airframe](const RowSet& training) { return fit_context(make_context<Setting>(training, airframe)); },
          detail::residual_kind<Trained, Residual, MonotonePredictor<Features, Residual>, MonotoneBase<Features>>(
              false, detail::NoProjection{})};
}

namespace detail {

/// Runs the fits of fit_structured() one after the other.
struct InTurn {
  template <class Job>
  void run(std::size_t count, const Job& job) const {
    for (std::size_t i = 0; i < count && job(i); ++i) {
    }
  }
  bool goes_on(int /*epoch*/) const { return true; }
  void chose(const StructuredAltitude&) const {}
};

}  // namespace detail

/// Fits a structured model from each seed. The first seed tries both feature sets where the altitude is chosen
/// by_validation; `higher` is null where there is no such choice. Throws std::invalid_argument for rows that are too
/// few.
/// `work` runs the fits; without it they run one after the other. A class of one's own, with threads, progress and
/// interrupts, has
///   template <class Job> void run(std::size_t count, const Job& job);  // calls job(i) for each i below `count`, also
///       // from several threads. A job that returns false was stopped: no further one need be started.
///   bool goes_on(int epoch);                     // asked before each epoch of each fit; false stops it
///   void chose(const StructuredAltitude&);   // called once, before the fits of the other seeds
template <class Work = detail::InTurn>
StructuredFitsIn<StructuredFit> fit_structured(const StructuredSet& without_altitude, const StructuredSet* higher,
                                               const RowSplit& split, const StructuredSettings& settings = {},
                                               Work&& work = {}) {
  using Altitude = StructuredSettings::Altitude;
  std::optional<detail::StructuredFitter> fitters[2];  // without the altitude, with it
  const Altitude rule = higher != nullptr ? settings.altitude : Altitude::no;
  if (rule != Altitude::no) fitters[1].emplace(*higher, split, settings);
  if (rule != Altitude::yes) fitters[0].emplace(without_altitude, split, settings);
  const auto fit = [&](bool with_altitude, std::uint64_t seed) {
    auto made = (*fitters[with_altitude ? 1 : 0])(seed, [&work](int epoch) { return work.goes_on(epoch); });
    if (made) made->with_altitude = with_altitude;
    return made;
  };

  StructuredFitsIn<StructuredFit> fits;
  StructuredAltitude& choice = fits.altitude;
  choice.taken = rule == Altitude::yes;
  std::vector<std::optional<StructuredFit>> made(static_cast<std::size_t>(std::max(settings.seeds, 0)));
  std::size_t next = 0;  // seed that is fitted next
  if (rule == Altitude::by_validation && !made.empty()) {
    std::optional<StructuredFit> tried[2];
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

}  // namespace pinnquad
