// SPDX-License-Identifier: MIT
// The structured model, whole: fitted (training/structured), judged and exported as a value, compiled once for all
// feature sets.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/deploy/written_model.hpp"
#include "pinnquad/training/structured/fit_structured.hpp"

namespace pinnquad {

/// A feature set whose structured models are fitted and exported.
struct StructuredExport {
  GivenAirframe airframe;
  StructuredSet set;
  detail::WrittenRecords base, whole;  ///< texts of a model without its residual, and with it
  AskedModel rows;                     ///< how rows show the features
  double window_s = 0;
  bool can_be_proven = false;
  int thrusts_of_present = 0;
};

/// Fits and exports of structured models of `Features` for an airframe.
template <class Features>
StructuredExport structured_export(const GivenAirframe& airframe) {
  using Base = detail::StructuredBase<Features>;
  using Whole = detail::StructuredWhole<Features>;
  StructuredExport made{airframe,
                        structured_set<Features>(airframe),
                        detail::records_of_types<Base>(),
                        detail::records_of_types<Whole>(),
                        {},
                        detail::WindowOf<Features>::period_s,
                        has_certificate<Base>,
                        detail::thrust_places<Features>().present};
  made.rows.airframe_name = airframe.airframe_name();
  made.rows.airframe = airframe.airframe<double>();
  detail::take_features<Features>(made.rows);
  made.rows.each_row = detail::rows_of_features<Features, float>();
  made.rows.each_exact_row = detail::rows_of_features<Features, double>();
  return made;
}

namespace detail {

/// Standardised features of a written model, columns within their range as they fly.
std::vector<float> standardised(const WrittenModel<float>& model, const Scales<float>& scales, const double* x);

Scales<float> scales_of(const WrittenModel<float>& model);

/// Numbers of a context and of the rows that it is of, as make_trained_model() makes them.
void take_numbers(WrittenModel<float>& written, const FitContext& context, const AskedModel& rows,
                  const RowSet& fitted);

}  // namespace detail

/// The model of a fit. `fitted`: the rows that it was fitted to, those of its context.
GroundModel<float> ground_model(const StructuredExport& from, const StructuredFit& fit, const FitContext& context,
                                const RowSet& fitted);

/// A structured model of one seed: judged, exported and asked as any other.
struct StructuredModelFit : StructuredFit {
  GroundModel<float> model;
};
using StructuredFits = StructuredFitsIn<StructuredModelFit>;

/// Fits as fit_structured() of sets does, and makes a model of each. `higher` is null where there is no choice of the
/// altitude.
StructuredFits fit_structured(const StructuredExport& lower, const StructuredExport* higher, const RowSplit& split,
                              const StructuredSettings& settings = {}, const FitWork& work = FitWork());

/// The same of feature sets. `WithAltitude`: Features and the altitude, which the validation rows choose or do not;
/// Features again where that was not measured.
template <class Features = InverseFeatures, class WithAltitude = InverseFeaturesWithAltitude>
StructuredFits fit_structured(const RowSplit& split, const GivenAirframe& airframe,
                              const StructuredSettings& settings = {}, const FitWork& work = FitWork()) {
  std::optional<StructuredExport> higher;
  if constexpr (!std::is_same_v<Features, WithAltitude>) higher = structured_export<WithAltitude>(airframe);
  return fit_structured(structured_export<Features>(airframe), higher ? &*higher : nullptr, split, settings, work);
}

}  // namespace pinnquad

#ifdef PINNQUAD_COMPILED
namespace pinnquad {
extern template StructuredExport structured_export<InverseFeatures>(const GivenAirframe&);
extern template StructuredExport structured_export<InverseFeaturesWithAltitude>(const GivenAirframe&);
}  // namespace pinnquad
#else
#include "pinnquad/deploy/impl/structured_model.hpp"
#endif
