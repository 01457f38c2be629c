// SPDX-License-Identifier: MIT
// Bodies of fit_context.hpp.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string_view>

#include "pinnquad/training/structured/fit_context.hpp"

namespace pinnquad {
namespace detail {

PINNQUAD_BODY std::vector<int> other_features(int count, const std::vector<int>& threes) {
  std::vector<int> others;
  for (int i = 0; i < count; ++i) {
    bool other = true;
    for (const int first : threes) other = other && (i < first || i > first + 2);
    if (other) others.push_back(i);
  }
  return others;
}

}  // namespace detail

PINNQUAD_BODY void FitContext::each_row(const RowSet& rows, const Visit& visit) const {
  std::vector<double> y(schema.names.size());
  features.each_exact_row(rows, [&](const Flight& flight, std::size_t row, const double* x) {
    schema.from_commands(x, flight[row].commands.data(), y.data());
    visit(flight, row, x, y.data());
  });
}

PINNQUAD_BODY void FitContext::each_standardised(const RowSet& rows, const Visit& visit) const {
  std::vector<double> z(input_mean.size() + output_mean.size());
  each_row(rows, [&](const Flight& flight, std::size_t row, const double* x, const double* y) {
    double* const outputs_from = z.data() + input_mean.size();
    for (std::size_t i = 0; i < input_mean.size(); ++i) z[i] = (x[i] - input_mean[i]) / input_deviation[i];
    for (std::size_t k = 0; k < output_mean.size(); ++k) {
      outputs_from[k] = (y[k] - output_mean[k]) / output_deviation[k];
    }
    visit(flight, row, z.data(), outputs_from);
  });
}

PINNQUAD_BODY FitContext fit_context(GroundFeatures features, GroundOutputs schema, const GivenAirframe& airframe,
                                     const RowSet& rows) {
  FitContext context{
      std::move(features), std::move(schema), airframe.airframe_name(), airframe.airframe<double>(), {}, {}, {}, {}};
  std::vector<std::string_view> units(context.features.units.begin(), context.features.units.end());
  units.insert(units.end(), context.schema.units.begin(), context.schema.units.end());
  const std::size_t inputs = context.features.size();
  std::vector<double> values(units.size());
  bool any = false;
  const auto columns = detail::column_statistics(units, [&](const detail::RowVisit& visit) {
    context.each_row(rows, [&](const Flight&, std::size_t, const double* x, const double* y) {
      std::copy_n(x, inputs, values.begin());
      std::copy_n(y, values.size() - inputs, values.begin() + static_cast<std::ptrdiff_t>(inputs));
      any = true;
      visit(values.data());
    });
  });
  if (!any) throw std::invalid_argument("no row has all features that are asked for");
  for (std::size_t i = 0; i < columns.size(); ++i) {
    (i < inputs ? context.input_mean : context.output_mean).push_back(columns[i].mean);
    (i < inputs ? context.input_deviation : context.output_deviation).push_back(columns[i].scale());
  }
  return context;
}

}  // namespace pinnquad
