// SPDX-License-Identifier: MIT
// Bodies of structured_model.hpp.
#pragma once

#include <algorithm>
#include <memory>

#include "pinnquad/deploy/structured_model.hpp"

namespace pinnquad {
namespace detail {

/// The certificate of a written model that has the structure.
PINNQUAD_BODY Certificate certificate_of_structured(const WrittenModel<float>& model, const FitContext& context,
                                                    bool has_residual) {
  const GroundFeatures& features = context.features;
  const std::vector<int> thrusts = features.thrusts();
  const auto of_present = std::count_if(thrusts.begin(), thrusts.end(), [&](int place) {
    return is_of_present(features.names[static_cast<std::size_t>(place)]);
  });
  return certificate_of(
      CertifiedNumbers<float>{context.inputs(),
                              static_cast<int>(features.accelerations.size()),
                              features.accelerations.data(),
                              static_cast<int>(thrusts.size()),
                              static_cast<int>(of_present),
                              thrusts.data(),
                              model.parameters.data(),
                              has_residual,
                              {model.input_mean.data(), model.input_deviation.data(), model.output_mean.data(),
                               model.output_deviation.data(), model.envelope_lower.data(), model.envelope_upper.data()},
                              certified_vehicle<AxisCommandOutputs>(airframe_in<float>(model.airframe))});
}

/// The model of a fit. `fitted`: the rows that it was fitted to, those of its context.
PINNQUAD_BODY GroundModel<float> structured_model(const StructuredSet& from, const SeedFit& fit,
                                                  const FitContext& context, const RowSet& fitted) {
  GroundModel<float> ground =
      fitted_model(context, fit.has_residual ? from.residual.predictor : from.residual.base, fit.parameters, fitted);
  WrittenModel<float>& written = ground.written;
  written.certificate = certificate_of_structured(written, context, fit.has_residual);
  if (!fit.has_residual) return ground;
  const std::vector<int> others = other_features(context.inputs(), context.features.accelerations);
  const auto base_size = 3 * context.features.accelerations.size() + AxisCommandOutputs::size * (1 + others.size());
  const auto bounds = written.parameters.begin() + static_cast<std::ptrdiff_t>(base_size);
  const auto own = bounds + 2 * AxisCommandOutputs::size;
  ground.residual_lower.assign(bounds, bounds + AxisCommandOutputs::size);
  ground.residual_upper.assign(bounds + AxisCommandOutputs::size, own);
  ground.residual = [numbers = std::make_shared<const WrittenModel<float>>(written), others,
                     network = DescribedPredictor(from.residual.network, {own, written.parameters.end()})](
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

}  // namespace detail

PINNQUAD_BODY StructuredFits fit_structured(const StructuredBases& bases, const StructuredSettings& settings,
                                            const FitWork& work) {
  detail::SeedFits made = bases.fit(settings, work);
  StructuredFits fits{made.altitude, {}, std::move(made.context)};
  for (const detail::SeedFit& fit : made.fits) {
    fits.models.push_back(
        {fit, detail::structured_model(bases.set(made.altitude.taken), fit, fits.context, made.fitted)});
  }
  return fits;
}

}  // namespace pinnquad
