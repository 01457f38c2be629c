// SPDX-License-Identifier: MIT
// The certificate (exported/certificate.hpp) of a model that is known at run time alone.
#pragma once

#include "pinnquad/exported/certificate.hpp"
#include "pinnquad/exported/run_time_model.hpp"

namespace pinnquad {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// The angular acceleration that a feature of a model shows: `unknown` of one that is neither the library's nor said to
/// be a column.
template <class Scalar>
ShownAcceleration shown_acceleration(const RunTimeModel<Scalar>& model, int feature) noexcept {
  const auto [name, unit] = model.features()[feature];
  bool is_column = false;
  std::string_view rest = model.records().columns;
  detail::NameAndUnit said;
  while (RunTimeFeatures::take_text(rest, said.name) && RunTimeFeatures::take_text(rest, said.unit)) {
    is_column = is_column || said.name == name || said.name == detail::name_at_tap(name);
  }
  return detail::shown_acceleration(name, unit, is_column);
}

/// False, and nothing is written, for a model whose structure says nothing of its slopes: other outputs than axis
/// commands, an affine base that does not cover every feature that shows an angular acceleration, a feature of which
/// nobody knows, a residual that is shown the angular acceleration.
template <class Scalar>
bool run_time_certificate(const RunTimeModel<Scalar>& model, Certificate& certificate) noexcept {
  const RunTimeNetwork& network = model.network();
  const RunTimeFeatures& features = model.features();
  const RunTimeNetwork::Part& base = network.part(0);
  if (!model.outputs().is_axis_commands() || !base.axis_aligned || network.part_count() > 2) return false;
  if (!detail::threes_cover_acceleration(
          static_cast<const int*>(base.threes), base.three_count, features.size(),
          [&model](int feature) { return shown_acceleration(model, feature); },
          [&features](int feature) { return detail::is_of_present(features[feature].name); })) {
    return false;
  }
  const bool has_residual = network.part_count() == 2;
  if (has_residual) {
    const RunTimeNetwork::Part& residual = network.part(1);
    if (!residual.bounded || residual.axis_aligned) return false;
    bool withheld = residual.three_count == base.three_count;
    for (int tap = 0; withheld && tap < base.three_count; ++tap) withheld = residual.threes[tap] == base.threes[tap];
    if (!withheld) return false;
  }
  int thrusts[RunTimeFeatures::most_features];
  int thrust_count = 0, present = 0;
  for (const bool now : {true, false}) {
    for (int i = 0; i < features.size(); ++i) {
      if (!detail::is_thrust(features[i].name) || detail::is_of_present(features[i].name) != now) continue;
      thrusts[thrust_count++] = i;
      present += now ? 1 : 0;
    }
  }
  const auto vehicle = model.records().base.count == 0
                           ? detail::certified_vehicle<AxisCommandOutputs>(model.flown_airframe())
                           : detail::certified_vehicle<SignedSumsOn<RigidBodyBase>>(model.flown_airframe());
  certificate = certificate_of(detail::CertifiedNumbers<Scalar>{
      features.size(), base.three_count, static_cast<const int*>(base.threes), thrust_count, present,
      static_cast<const int*>(thrusts), model.parameters(), has_residual, model.scales(), vehicle});
  return true;
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad
