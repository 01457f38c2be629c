// SPDX-License-Identifier: MIT
// The structured model, whole: a monotone base in closed form and a residual network, fitted from several seeds. The
// validation rows choose whether the model is shown the altitude, and whether the residual is kept; so do whole
// flights, each left out in turn, where several train. They choose by errors of least squares: rows with noise prefer
// slopes that it bends. What is fitted has the slopes of slopes_under_noise.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/core/finite.hpp"
#include "pinnquad/data/split.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/training/structured/residual_fit.hpp"
#include "pinnquad/training/structured/slopes_under_noise.hpp"

namespace pinnquad {

/// The training in words, for Provenance::loss.
inline constexpr const char* structured_in_words =
    "least squares, slopes above 0; MSE of the residual, which sees no angular acceleration";

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

/// A feature set as fit_structured() takes it.
struct StructuredSet {
  GroundFeatures features;
  GivenAirframe airframe;
  detail::ResidualKind residual;

  FitContext context(const RowSet& training) const {
    return fit_context(features, ground_outputs<AxisCommandOutputs>(airframe), airframe, training);
  }
};

/// The residual network of so many inputs.
template <int Inputs>
using StructuredResidual = Mlp<float, InputSize<Inputs>, Hidden<2, 32>, OutputSize<4>, Relu>;

/// A set of features, the angular acceleration among them. `trainer`: detail::residual_trainer() of a
/// StructuredResidual of as many inputs as there are other features, or of more: the bits are the same. Throws
/// std::invalid_argument for features without the angular acceleration.
StructuredSet structured_set(GroundFeatures features, const GivenAirframe& airframe,
                             detail::ResidualTrainer::Make trainer);

/// The set of a type. The residual trains with its inputs filled up to a multiple of sixteen: few networks are
/// compiled, whatever the features.
template <class Features>
StructuredSet structured_set(const GivenAirframe& airframe) {
  return structured_set(ground_features<Features>(), airframe,
                        detail::residual_trainer<StructuredResidual<(residual_inputs<Features> + 15) / 16 * 16>>());
}

/// Runs the fits of fit_structured(): one after the other. A class of one's own, with threads, progress and interrupts,
/// overrides what it does otherwise.
class FitWork {
 public:
  /// The choice of the altitude. Errors are those of the first seed; none where the rule is not by_validation.
  struct Altitude {
    bool taken = false;
    std::optional<double> error_with, error_without;
  };

  virtual ~FitWork() = default;
  /// Calls job(i) for each i below `count`, also from several threads. A job that returns false was stopped: no further
  /// one need be started.
  virtual void run(std::size_t count, const std::function<bool(std::size_t)>& job) const {
    for (std::size_t i = 0; i < count && job(i); ++i) {
    }
  }
  /// Asked before each epoch of each fit; false stops it.
  virtual bool goes_on(int /*epoch*/) const { return true; }
  /// Called once, before the fits of the other seeds.
  virtual void chose(const Altitude& /*choice*/) const {}
};

namespace detail {

/// The model of one seed: parameters of a MonotoneBase, or of a MonotonePredictor with its residual.
struct SeedFit {
  std::vector<float> parameters;
  bool has_residual = false;
  bool with_altitude = false;
  std::uint64_t seed = 0;
  double validation_error = 0;  ///< mean absolute error of the commands on the validation rows, by least squares
  double training_s = 0;        ///< wall-clock time of the residual's training
  MeasuredSlopes slopes{};      ///< the same of all seeds
};

class StructuredFitter;

/// The fits of seeds that were finished, in the order of the seeds.
struct SeedFits {
  FitWork::Altitude altitude;
  std::vector<SeedFit> fits;
  FitContext context;  ///< of the fits
  RowSet fitted;       ///< the rows that they were fitted to
};

}  // namespace detail

/// The feature sets of a structured model on one split. Their bases are the same of all seeds: each is fitted once,
/// when it is first asked for, by one of several threads too.
class StructuredBases {
 public:
  /// `higher`: the features and the altitude; none where there is no such choice.
  StructuredBases(StructuredSet lower, std::optional<StructuredSet> higher, RowSplit split)
      : lower_(std::move(lower)), higher_(std::move(higher)), split_(std::move(split)) {}

  bool chooses_altitude() const { return higher_.has_value(); }
  const StructuredSet& set(bool with_altitude) const { return with_altitude ? *higher_ : lower_; }
  /// Fits from each seed. The first seed tries both feature sets where the altitude is chosen by_validation. Settings
  /// but for altitude and seeds are the same each time. Throws std::invalid_argument for rows that are too few.
  detail::SeedFits fit(const StructuredSettings& settings, const FitWork& work) const;

 private:
  const detail::StructuredFitter& fitter(bool with_altitude, const StructuredSettings& settings) const;

  StructuredSet lower_;
  std::optional<StructuredSet> higher_;
  RowSplit split_;
  mutable std::mutex mutex_;
  mutable std::array<std::shared_ptr<const detail::StructuredFitter>, 2> fitters_;
};

}  // namespace pinnquad

#ifdef PINNQUAD_COMPILED
namespace pinnquad::detail {
extern template class ResidualTrainerOf<StructuredResidual<16>, NoProjection>;
extern template class ResidualTrainerOf<StructuredResidual<32>, NoProjection>;
}  // namespace pinnquad::detail
#else
#include "pinnquad/training/structured/impl/fit_structured.hpp"
#endif
