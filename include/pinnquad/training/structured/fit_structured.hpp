// SPDX-License-Identifier: MIT
// The structured model, whole: a monotone base in closed form and a residual network, fitted from several seeds. The
// validation rows choose whether the model is shown the altitude, and whether the residual is kept; so do whole
// flights, each left out in turn, where several train. They choose by errors of least squares: rows with noise prefer
// slopes that it bends. What is fitted has the slopes of slopes_under_noise.hpp.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "pinnquad/core/finite.hpp"
#include "pinnquad/data/split.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/training/structured/agreement.hpp"
#include "pinnquad/training/structured/residual_fit.hpp"
#include "pinnquad/training/structured/slopes_under_noise.hpp"

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
  /// The validation rows are fitted too. Then whole flights, each left out in turn, choose alone, and no rows are left
  /// that limits of trust could be found by.
  bool fit_validation = false;
  double least_altitude_gain = 0.2;  ///< by_validation: least share of the error that the altitude must take away
  std::uint64_t first_seed = 1;
  int seeds = 5;
};

/// The training in words, for Provenance::loss.
inline constexpr const char* structured_in_words =
    "least squares, slopes above 0; MSE of the residual, which sees no angular acceleration";

/// The choice of the altitude. Errors are those of the first seed; none where the rule is not by_validation.
struct StructuredAltitude {
  bool taken = false;
  std::optional<double> error_with, error_without;
};

/// The models of all seeds that were finished, in the order of the seeds. A model has its residual where that helps.
/// `Features`: without the altitude; `WithAltitude`: the same with it, or Features again where that was not measured.
template <class Features = InverseFeatures, class WithAltitude = InverseFeaturesWithAltitude>
struct StructuredFitsOf {
  using Lower = Features;
  using Higher = WithAltitude;
  static constexpr bool has_altitude = !std::is_same_v<Features, WithAltitude>;
  /// The residual network.
  template <class Set>
  using Residual = Mlp<float, InputSize<residual_inputs<Set>>, Hidden<2, 32>, OutputSize<4>, Relu>;
  template <class Set, class Predictor>
  using TrainedAs = TrainedModel<Predictor, Context<Set, GivenAirframe, AxisCommandOutputs>>;
  template <class Set>
  using Base = TrainedAs<Set, MonotoneBase<Set>>;
  template <class Set>
  using BaseAndResidual = TrainedAs<Set, MonotonePredictor<Set, Residual<Set>>>;

  /// Base alone or base and residual, without the altitude or with it.
  using Model = std::conditional_t<
      has_altitude,
      std::variant<Base<Features>, BaseAndResidual<Features>, Base<WithAltitude>, BaseAndResidual<WithAltitude>>,
      std::variant<Base<Features>, BaseAndResidual<Features>>>;
  /// The model of one seed.
  struct Fit {
    Model model;
    std::uint64_t seed = 0;
    double validation_error = 0;  ///< mean absolute error of the commands on the validation rows, by least squares
    double training_s = 0;        ///< wall-clock time of the residual's training
    MeasuredSlopes slopes{};      ///< the same of all seeds
  };
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
using StructuredFits = StructuredFitsOf<>;

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

/// The fits of one feature set. The base is the same of all seeds, the residual is not.
template <class Fits, class Features>
class StructuredFitter {
  using ContextType = Context<Features, GivenAirframe, AxisCommandOutputs>;
  using Residual = typename Fits::template Residual<Features>;
  using Fit = typename Fits::Fit;

 public:
  StructuredFitter(const RowSplit& split, const GivenAirframe& airframe, const StructuredSettings& settings)
      : split_(split),
        settings_(settings),
        fitted_(settings.fit_validation ? rows_of({split.train, split.validation}) : split.train),
        context_(make_context<ContextType>(fitted_, airframe)),
        shape_(monotone_shape(context_)) {
    if (settings.pinned_slopes) pinned_ = hover_slopes(airframe.template airframe<double>());
    for (const RowSet& group : left_out_groups(fitted_)) {
      RegressionSums sums = regression_sums(context_, group);
      if (!(sums.rows() > 0)) continue;  // no window is complete there
      groups_.push_back(group);
      sums_.push_back(std::move(sums));
    }
    if constexpr (is_windowed<Features>) hold_thrust(airframe);
    measured_ = map_ = fit_monotone_base(shape_, sums_, pinned_);
    if (!shape_.noisy.empty()) {
      slopes_ = measure_slopes(shape_, instrumented_blocks(context_, fitted_, shape_.noisy), pinned_, measured_);
    }
    whole_flights_ = whole_flight_groups(fitted_).size() > 1 && groups_.size() > 1;
  }

  /// None where `goes_on` stopped it.
  template <class GoesOn>
  std::optional<Fit> operator()(std::uint64_t seed, const GoesOn& goes_on) const {
    const auto start = std::chrono::steady_clock::now();
    const auto done = [&](const auto& predictor, double error) {
      Fit made{make_trained_model(with_measured_slopes(predictor), context_, fitted_), seed, error, 0, slopes_};
      made.training_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      return made;
    };
    if (settings_.fit_validation) return fit_by_groups(seed, goes_on, done);
    const auto fit = fitted(split_.train, map_, seed, goes_on);
    if (!fit.finished) return {};
    bool kept = fit.residual_kept;
    if (kept && whole_flights_) {
      const std::optional<bool> gains = gains_on_flights_left_out(seed, goes_on);
      if (!gains) return {};
      kept = *gains;
    }
    return kept ? done(fit.predictor, fit.error) : done(fit.base, fit.base_error);
  }

 private:
  /// A window's taps would be their own instruments. What a held force takes is the same without a window: where noise
  /// bends it there, the sum over all taps is held at what instruments say there.
  void hold_thrust(const GivenAirframe& airframe) {
    using Present = Context<typename Features::TapFeatures, GivenAirframe, AxisCommandOutputs>;
    const auto present = make_context<Present>(fitted_, airframe);
    const MonotoneShape shape = monotone_shape(present);
    if (shape.thrusts.size() != 1) return;
    AffineMap map = fit_monotone_base(present, fitted_);
    const MeasuredSlope thrust =
        measure_slopes(shape, instrumented_blocks(present, fitted_, shape.noisy), {}, map).of[0];
    if (!thrust.by_instruments) return;
    slopes_.of[0] = thrust;
    shape_.held_thrust = thrust.slope;
    slopes_.noisy = shape_.thrusts;
    slopes_.denoised = denoised_taps<Features>(shape_, total(instrumented_blocks(context_, fitted_, slopes_.noisy)));
  }

  template <class GoesOn>
  auto fitted(const RowSet& training, const AffineMap& map, std::uint64_t seed, const GoesOn& goes_on) const {
    std::mt19937_64 engine(seed);
    return fit_monotone<Residual>(context_, training, split_.validation, map, settings_.residual, engine, goes_on);
  }

  static RowSet rows_of(const std::vector<RowSet>& groups) {
    RowSet rows;
    for (const RowSet& group : groups) {
      for (const FlightRows& piece : group.pieces()) rows.add(*piece.flight, piece.rows);
    }
    return rows;
  }

  /// The base with its measured slopes. A sum that has them by instruments has no residual: what a network is shown, it
  /// would use to take them back.
  template <class Predictor>
  Predictor with_measured_slopes(Predictor predictor) const {
    using Bound = MonotoneResidual<Features, Residual>;
    if (!slopes_.by_instruments()) return predictor;
    const auto base = monotone_base<ContextType>(measured_);
    auto* const residual = std::copy(base.parameters.begin(), base.parameters.end(), predictor.parameters.data());
    if constexpr (Predictor::parameter_count > MonotoneBase<Features>::parameter_count) {
      for (std::size_t k = 0; k < slopes_.of.size(); ++k) {
        if (slopes_.of[k].by_instruments) residual[Bound::lower + int(k)] = residual[Bound::upper + int(k)] = 0;
      }
    }
    return predictor;
  }

  /// Calls `use(others, base without the group, the group)`, each group left out in turn.
  template <class Use>
  void each_left_out(const Use& use) const {
    for (std::size_t out = 0; out < groups_.size(); ++out) {
      std::vector<RowSet> others = groups_;
      std::vector<RegressionSums> sums = sums_;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(out));
      sums.erase(sums.begin() + static_cast<std::ptrdiff_t>(out));
      use(rows_of(others), fit_monotone_base(shape_, sums, pinned_), groups_[out]);
    }
  }

  /// Does the residual lower the error on whole flights, each left out in turn of the rows that it is fitted to? None
  /// where `goes_on` stopped it.
  template <class GoesOn>
  std::optional<bool> gains_on_flights_left_out(std::uint64_t seed, const GoesOn& goes_on) const {
    double base_error = 0, error = 0;
    bool finished = true;
    each_left_out([&](const RowSet& others, const AffineMap& map, const RowSet& group) {
      if (!finished) return;
      const auto fit = fitted(others, map, seed, goes_on);
      finished = fit.finished;
      const auto unseen = standardised<float>(context_, group);
      base_error += unseen.size() * command_error(context_, fit.base, unseen);
      error += unseen.size() * command_error(context_, fit.predictor, unseen);
    });
    if (!finished) return {};
    return error < (1 - settings_.residual.least_gain) * base_error;
  }

  /// The residual that a base leaves of rows, as the network is shown it.
  auto left_by(const AffineMap& map, const RowSet& rows) const {
    auto data = standardised<float>(context_, rows);
    take_away(map, data);
    return residual_rows<Features>(data);
  }

  template <class GoesOn, class Visit>
  bool train(const AffineMap& map, const RowSet& rows, int epochs, std::uint64_t seed, const GoesOn& goes_on,
             const Visit& visit) const {
    std::mt19937_64 engine(seed);
    return train_residual<Residual>(
        residual_context(context_), left_by(map, rows), [](const auto&) {}, settings_.residual, epochs, engine, goes_on,
        visit);
  }

  /// Groups left out in turn say how long the residual is trained and what share of each output counts; then base and
  /// residual are fitted to all rows.
  template <class GoesOn, class Done>
  std::optional<Fit> fit_by_groups(std::uint64_t seed, const GoesOn& goes_on, const Done& done) const {
    const auto base = monotone_base<ContextType>(map_);
    if (groups_.size() < 2) return done(base, std::numeric_limits<double>::quiet_NaN());  // nothing to choose by
    const int epochs = settings_.residual.epochs;
    std::vector<Agreement> by_epoch(static_cast<std::size_t>(epochs));
    bool finished = true;
    each_left_out([&](const RowSet& others, const AffineMap& map, const RowSet& group) {
      const auto unseen = left_by(map, group);
      finished = finished && train(map, others, epochs, seed, goes_on, [&](auto& trainer, int epoch) {
                   agree(by_epoch[static_cast<std::size_t>(epoch)], trainer, unseen);
                 });
    });
    if (!finished) return {};
    std::size_t best = 0;
    for (std::size_t epoch = 1; epoch < by_epoch.size(); ++epoch) {
      if (by_epoch[epoch].gain() > by_epoch[best].gain()) best = epoch;
    }
    const Agreement& chosen = by_epoch[best];
    const double error = chosen.error();
    if (!(chosen.gain() > 0)) return done(base, error);
    Residual residual{};
    if (!train(map_, fitted_, static_cast<int>(best) + 1, seed, goes_on,
               [&](const auto& trainer, int) { residual = trainer.network(); })) {
      return {};
    }
    take_shares(residual, chosen);
    using Bound = MonotoneResidual<Features, Residual>;
    return done(base_and_residual<Bound, MonotonePredictor<Features, Residual>>(base, residual, left_by(map_, fitted_)),
                error);
  }

  template <class Trainer, class Data>
  void agree(Agreement& agreement, Trainer& trainer, const Data& unseen) const {
    agreement.begin_group();
    trainer.each_prediction(unseen, [&](int row, int k, double said) {
      const double unit = context_.output.standard_deviation[static_cast<std::size_t>(k)];
      agreement.add(k, unit * said, unit * static_cast<double>(unseen.outputs_of(row)[k]));
    });
  }

  /// In the last layer, which is affine: weights by output, then biases.
  static void take_shares(Residual& residual, const Agreement& agreement) {
    constexpr int width = Residual::template Layer<Residual::layer_count - 1>::inputs;
    auto weight = residual.parameters.end() - Residual::outputs * (width + 1);
    for (int k = 0; k < Residual::outputs; ++k) {
      const auto share = static_cast<float>(agreement.share(k));
      for (int i = 0; i < width; ++i) *weight++ *= share;
      *(residual.parameters.end() - Residual::outputs + k) *= share;
    }
  }

  const RowSplit& split_;
  const StructuredSettings& settings_;
  RowSet fitted_;
  ContextType context_;
  MonotoneShape shape_;
  std::optional<AxisSlopes> pinned_;
  std::vector<RowSet> groups_;
  std::vector<RegressionSums> sums_;  ///< of the groups
  AffineMap map_;                     ///< by least squares
  AffineMap measured_;                ///< by instruments where noise bends it
  MeasuredSlopes slopes_;
  bool whole_flights_ = false;
};

}  // namespace detail

/// Fits a structured model from each seed. The first seed tries both feature sets where the altitude is chosen
/// by_validation. Throws std::invalid_argument for rows that are too few, and for an airframe that can't fly.
/// `work` runs the fits; without it they run one after the other. A class of one's own, with threads, progress and
/// interrupts, has
///   template <class Job> void run(std::size_t count, const Job& job);  // calls job(i) for each i below `count`, also
///       // from several threads. A job that returns false was stopped: no further one need be started.
///   bool goes_on(int epoch);                     // asked before each epoch of each fit; false stops it
///   void chose(const StructuredAltitude&);   // called once, before the fits of the other seeds
template <class Fits = StructuredFits, class Work = detail::InTurn>
Fits fit_structured(const RowSplit& split, const GivenAirframe& airframe, const StructuredSettings& settings = {},
                    Work&& work = {}) {
  using Altitude = StructuredSettings::Altitude;
  using Fit = typename Fits::Fit;
  std::optional<detail::StructuredFitter<Fits, typename Fits::Lower>> lower;
  std::optional<detail::StructuredFitter<Fits, typename Fits::Higher>> higher;
  const Altitude rule = Fits::has_altitude ? settings.altitude : Altitude::no;
  if (rule != Altitude::no) higher.emplace(split, airframe, settings);
  if (rule != Altitude::yes) lower.emplace(split, airframe, settings);
  const auto fit = [&](bool with_altitude, std::uint64_t seed) {
    const auto goes_on = [&work](int epoch) { return work.goes_on(epoch); };
    return with_altitude ? (*higher)(seed, goes_on) : (*lower)(seed, goes_on);
  };

  Fits fits;
  StructuredAltitude& choice = fits.altitude;
  choice.taken = rule == Altitude::yes;
  std::vector<std::optional<Fit>> made(static_cast<std::size_t>(std::max(settings.seeds, 0)));
  std::size_t next = 0;  // seed that is fitted next
  if (rule == Altitude::by_validation && !made.empty()) {
    std::optional<Fit> tried[2];  // without the altitude, with it
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
