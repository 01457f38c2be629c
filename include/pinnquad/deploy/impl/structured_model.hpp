// SPDX-License-Identifier: MIT
// Bodies of structured_model.hpp.
#pragma once

#include "pinnquad/deploy/structured_model.hpp"

namespace pinnquad {
namespace detail {

PINNQUAD_BODY std::vector<float> standardised(const WrittenModel<float>& model, const Scales<float>& scales,
                                              const double* x) {
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

PINNQUAD_BODY Scales<float> scales_of(const WrittenModel<float>& model) {
  return {model.input_mean.data(),       model.input_deviation.data(), model.output_mean.data(),
          model.output_deviation.data(), model.envelope_lower.data(),  model.envelope_upper.data()};
}

PINNQUAD_BODY void take_numbers(WrittenModel<float>& written, const FitContext& context, const AskedModel& rows,
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
PINNQUAD_BODY Certificate certificate_of_structured(const WrittenModel<float>& model, const FitContext& context,
                                                    int thrusts_of_present, bool has_residual) {
  const Airframe<float> airframe = airframe_in<float>(model.airframe);
  const PathBound<4> none{};
  return certificate_of(CertifiedNumbers<float>{
      context.inputs(), static_cast<int>(context.accelerations.size()), context.accelerations.data(),
      static_cast<int>(context.thrusts.size()), thrusts_of_present, context.thrusts.data(), model.parameters.data(),
      has_residual, &none, false, scales_of(model), certified_vehicle<AxisCommandOutputs>(airframe)});
}

}  // namespace detail

PINNQUAD_BODY GroundModel<float> ground_model(const StructuredExport& from, const StructuredFit& fit,
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
  AskedModel& asked = ground;
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

PINNQUAD_BODY StructuredFits fit_structured(const StructuredExport& lower, const StructuredExport* higher,
                                            const RowSplit& split, const StructuredSettings& settings,
                                            const FitWork& work) {
  auto made = fit_structured(lower.set, higher != nullptr ? &higher->set : nullptr, split, settings, work);
  StructuredFits fits{made.altitude, {}};
  if (made.models.empty()) return fits;
  const RowSet rows = detail::fitted_rows(split, settings);
  const StructuredExport& set = made.altitude.taken ? *higher : lower;  // of every seed
  const FitContext context = set.set.context(rows);
  for (const StructuredFit& fit : made.models) fits.models.push_back({fit, ground_model(set, fit, context, rows)});
  return fits;
}

#ifdef PINNQUAD_COMPILED
template StructuredExport structured_export<InverseFeatures>(const GivenAirframe&);
template StructuredExport structured_export<InverseFeaturesWithAltitude>(const GivenAirframe&);
#endif

}  // namespace pinnquad
