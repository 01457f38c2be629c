// SPDX-License-Identifier: MIT
// Structured models (training/structured) exported without their types: as values, compiled once for all feature sets.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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
  made.rows.units.assign(Features::units.begin(), Features::units.end());
  made.rows.each_row = detail::rows_of_features<Features, float>();
  made.rows.each_exact_row = detail::rows_of_features<Features, double>();
  return made;
}

namespace detail {

/// Standardised features of a written model, columns within their range as they fly.
inline std::vector<float> standardised(const WrittenModel<float>& model, const Scales<float>& scales, const double* x) {
  std::vector<float> z(model.input_mean.size());
  for (std::size_t i = 0; i < z.size(); ++i) {
    z[i] = (static_cast<float>(x[i]) - model.input_mean[i]) / model.input_deviation[i];
    const std::string_view name = name_at_tap(model.feature_texts[2 * i]);
    if (std::find(model.column_names.begin(), model.column_names.end(), name) != model.column_names.end()) {
      z[i] = saturated(scales, static_cast<int>(i), z[i]);
    }
  }
  return z;
}

inline Scales<float> scales_of(const WrittenModel<float>& model) {
  return {model.input_mean.data(),       model.input_deviation.data(), model.output_mean.data(),
          model.output_deviation.data(), model.envelope_lower.data(),  model.envelope_upper.data()};
}

/// Numbers of a context and of the rows that it is of, as make_trained_model() makes them.
inline void take_numbers(WrittenModel<float>& written, const FitContext& context, const AskedModel& rows,
                         const RowSet& fitted) {
  written.input_mean = converted<float>(context.input_mean);
  written.input_deviation = converted<float>(context.input_deviation);
  written.output_mean = converted<float>(context.output_mean);
  written.output_deviation = converted<float>(context.output_deviation);
  for (const ColumnStatistics& column : feature_statistics(rows, fitted)) {
    const double margin = column.margin(affine_reach(rows.units[written.envelope_lower.size()]));
    written.envelope_lower.push_back(static_cast<float>(column.lowest - margin));
    written.envelope_upper.push_back(static_cast<float>(column.highest + margin));
  }
}

/// The certificate of a written model that has the structure.
inline Certificate certificate_of_structured(const WrittenModel<float>& model, const FitContext& context,
                                             int thrusts_of_present, bool has_residual) {
  const Airframe<float> airframe = airframe_in<float>(model.airframe);
  const PathBound<4> none{};
  return certificate_of(CertifiedNumbers<float>{
      context.inputs(), static_cast<int>(context.accelerations.size()), context.accelerations.data(),
      static_cast<int>(context.thrusts.size()), thrusts_of_present, context.thrusts.data(), model.parameters.data(),
      has_residual, &none, false, scales_of(model), certified_vehicle<AxisCommandOutputs>(airframe)});
}

}  // namespace detail

/// The model of a fit. `fitted`: the rows that it was fitted to, those of its context.
inline GroundModel<float> ground_model(const StructuredExport& from, const StructuredFit& fit,
                                       const FitContext& context, const RowSet& fitted) {
  GroundModel<float> ground{from.rows, {}, from.window_s};
  detail::WrittenModel<float>& written = ground.written;
  static_cast<detail::WrittenRecords&>(written) = fit.has_residual ? from.whole : from.base;
  detail::take_numbers(written, context, from.rows, fitted);
  written.parameters = fit.parameters;
  for (float& weight : written.parameters) weight = detail::without_negligible(weight);
  detail::take_airframe<AxisCommandOutputs>(written, printable(from.airframe.airframe_name()),
                                            from.airframe.airframe<double>(), from.airframe.airframe<float>());
  if (from.can_be_proven) {
    written.certificate =
        detail::certificate_of_structured(written, context, from.thrusts_of_present, fit.has_residual);
  }
  AskedModel& asked = ground.asked;
  asked.envelope_lower = detail::converted<double>(written.envelope_lower);
  asked.envelope_upper = detail::converted<double>(written.envelope_upper);
  const auto numbers = std::make_shared<const detail::WrittenModel<float>>(written);
  const std::string& answer = numbers->answer;
  const auto mix = OutputMap<AxisCommandOutputs>::setting(from.airframe.airframe<float>());
  asked.predict = [numbers, mix, predictor = detail::DescribedPredictor(answer, written.parameters)](const double* x) {
    float outputs[AxisCommandOutputs::size];
    Commands<float> commands{};
    const std::vector<float> z = detail::standardised(*numbers, detail::scales_of(*numbers), x);
    const std::vector<float> made = predictor(z.data());
    for (std::size_t k = 0; k < made.size(); ++k) {
      outputs[k] = made[k] * numbers->output_deviation[k] + numbers->output_mean[k];
    }
    AxisCommandOutputs::commands(static_cast<const float*>(nullptr), static_cast<const float*>(outputs), mix,
                                 commands.data());
    return detail::in_double(commands);
  };
  if (!fit.has_residual) return ground;
  const std::vector<int> others = detail::other_features(context.inputs(), context.accelerations);
  const auto base_size = 3 * context.accelerations.size() + AxisCommandOutputs::size * (1 + others.size());
  const auto bounds = written.parameters.begin() + static_cast<std::ptrdiff_t>(base_size);
  const auto own = bounds + 2 * AxisCommandOutputs::size;
  asked.residual_lower.assign(bounds, bounds + AxisCommandOutputs::size);
  asked.residual_upper.assign(bounds + AxisCommandOutputs::size, own);
  asked.residual = [numbers, others,
                    network = detail::DescribedPredictor(from.set.residual.network, {own, written.parameters.end()})](
                       const double* x, double* y) {
    std::vector<float> shown;
    for (const int i : others) {
      const auto place = static_cast<std::size_t>(i);
      shown.push_back((static_cast<float>(x[place]) - numbers->input_mean[place]) / numbers->input_deviation[place]);
    }
    const std::vector<float> made = network(shown.data());
    for (std::size_t k = 0; k < made.size(); ++k) y[k] = static_cast<double>(made[k]);
  };
  return ground;
}

}  // namespace pinnquad
