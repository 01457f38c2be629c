// SPDX-License-Identifier: MIT
// Bodies of fitted_model.hpp.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include "pinnquad/deploy/fitted_model.hpp"

namespace pinnquad {
namespace detail {

/// Standardised features of a written model, columns within their range as they fly.
PINNQUAD_BODY std::vector<float> standardised(const WrittenModel<float>& model, const std::vector<bool>& is_column,
                                              const float* x) {
  const Scales<float> scales{model.input_mean.data(),       model.input_deviation.data(), model.output_mean.data(),
                             model.output_deviation.data(), model.envelope_lower.data(),  model.envelope_upper.data()};
  std::vector<float> z(model.input_mean.size());
  for (std::size_t i = 0; i < z.size(); ++i) {
    z[i] = (x[i] - model.input_mean[i]) / model.input_deviation[i];
    if (is_column[i]) z[i] = saturated(scales, static_cast<int>(i), z[i]);
  }
  return z;
}

PINNQUAD_BODY WrittenRecords records_of(const FitContext& context, const PredictorText& predictor) {
  const GroundFeatures& features = context.features;
  WrittenRecords records;
  records.window_taps = static_cast<std::uint32_t>(features.window.taps);
  records.causal = features.window.causal;
  for (const ColumnName& column : features.columns) {
    records.column_names.push_back(column.name);
    records.column_units.push_back(column.unit);
  }
  records.answer = predictor.description;
  records.base = context.schema.base;
  append_texts(records.feature_texts, features.names, features.units);
  records.network_type = predictor.type;
  records.features_type = features.type;
  records.outputs_type = context.schema.type;
  records.output_texts = {context.schema.description};
  append_texts(records.output_texts, context.schema.names, context.schema.units);
  take_airframe(records, printable(context.airframe_name), context.airframe, airframe_in<float>(context.airframe));
  records.affine = context.schema.affine;
  return records;
}

PINNQUAD_BODY GroundModel<float> fitted_model(const FitContext& context, const PredictorText& predictor,
                                              const std::vector<float>& parameters, const RowSet& fitted) {
  GroundModel<float> ground{{}, {}, context.features.window.period_s};
  WrittenModel<float>& written = ground.written;
  static_cast<WrittenRecords&>(written) = records_of(context, predictor);
  written.input_mean = converted<float>(context.input_mean);
  written.input_deviation = converted<float>(context.input_deviation);
  written.output_mean = converted<float>(context.output_mean);
  written.output_deviation = converted<float>(context.output_deviation);
  for (const float weight : parameters) written.parameters.push_back(without_negligible(weight));
  AskedModel& asked = ground;
  asked.airframe_name = context.airframe_name;
  asked.airframe = context.airframe;
  asked.units = context.features.units;
  for (std::size_t i = 0; i < context.features.size(); ++i) asked.is_column.push_back(context.features.is_column(i));
  asked.each_row = context.features.each_row;
  asked.each_exact_row = context.features.each_exact_row;
  for (const ColumnStatistics& column : feature_statistics(asked, fitted)) {
    const double margin = column.margin(affine_reach(asked.units[written.envelope_lower.size()]));
    written.envelope_lower.push_back(static_cast<float>(column.lowest - margin));
    written.envelope_upper.push_back(static_cast<float>(column.highest + margin));
  }
  asked.envelope_lower = converted<double>(written.envelope_lower);
  asked.envelope_upper = converted<double>(written.envelope_upper);
  asked.predict = [numbers = std::make_shared<const WrittenModel<float>>(written), is_column = asked.is_column,
                   commands = context.schema.commands,
                   answer = DescribedPredictor(predictor, written.parameters)](const double* x) {
    const std::vector<float> own(x, x + is_column.size());
    std::vector<float> y = answer(standardised(*numbers, is_column, own.data()).data());
    for (std::size_t k = 0; k < y.size(); ++k) y[k] = y[k] * numbers->output_deviation[k] + numbers->output_mean[k];
    return in_double(commands(own.data(), y.data()));
  };
  return ground;
}

}  // namespace detail

PINNQUAD_BODY GroundModel<float> affine_model(const FitContext& context, const AffineMap& map, const RowSet& fitted) {
  if (map.inputs != context.inputs() || map.outputs != context.outputs()) {
    throw std::invalid_argument("affine_model: expected a map of " + std::to_string(context.inputs()) +
                                " features to " + std::to_string(context.outputs()) + " outputs, found another");
  }
  std::vector<float> parameters = detail::converted<float>(map.weights);
  for (const double intercept : map.intercept) parameters.push_back(static_cast<float>(intercept));
  const auto text = [&map](const char* inputs) {
    return std::string("pinnquad::Network<float, pinnquad::") + inputs + "<" + std::to_string(map.inputs) +
           ">, pinnquad::Dense<" + std::to_string(map.outputs) + ">>";
  };
  return detail::fitted_model(context, {text("Inputs"), text("InputSize")}, parameters, fitted);
}

}  // namespace pinnquad
