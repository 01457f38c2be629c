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
  RunTimeFeatures::Named said;
  while (RunTimeFeatures::take_text(rest, said.name) && RunTimeFeatures::take_text(rest, said.unit)) {
    is_column = is_column || said.name == name || said.name == detail::name_at_tap(name);
  }
  return detail::shown_acceleration(name, unit, is_column);
}

/// Dense layers, at most 3, with activations between them whose slope is from 0 to 1 (model/path_bound.hpp). `widths`
/// become the outputs of each.
inline bool has_path_bound(const RunTimeNetwork& network, const RunTimePart& part, int (&widths)[3],
                           int& layers) noexcept {
  if (part.axis_aligned || part.layer_count > 5 || part.layer_count % 2 == 0 || network.is_double()) return false;
  layers = (part.layer_count + 1) / 2;
  for (int i = 0; i < part.layer_count; ++i) {
    const RunTimeLayer& layer = part.layers[i];
    if (i % 2 == 0) {
      if (layer.outputs == 0 || !layer.has_bias) return false;
      widths[i / 2] = layer.outputs;
    } else if (layer.activation < 0 || !detail::run_time_activations<double>[layer.activation].slopes_from_0_to_1) {
      return false;
    }
  }
  return true;
}
/// Entries of the workspace of run_time_certificate() and path bounds.
inline std::size_t path_workspace(const RunTimePart& part) noexcept { return std::size_t(4 * part.widest); }

/// False, and nothing is written, for a model whose structure says nothing of its slopes: other outputs than axis
/// commands, an affine base that does not cover every feature that shows an angular acceleration, a feature of which
/// nobody knows, a residual that is shown the angular acceleration without a bound of its paths.
template <class Scalar>
bool run_time_certificate(const RunTimeModel<Scalar>& model, double* work, Certificate& certificate) noexcept {
  const RunTimeNetwork& network = model.network();
  const RunTimeFeatures& features = model.features();
  const RunTimePart& base = network.part(0);
  if (!model.outputs().is_axis_commands() || !base.axis_aligned || network.part_count() > 2) return false;
  if (!detail::threes_cover_acceleration(
          static_cast<const int*>(base.threes), base.three_count, features.size(),
          [&model](int feature) { return shown_acceleration(model, feature); },
          [&features](int feature) { return detail::is_of_present(features[feature].name); })) {
    return false;
  }
  detail::PathBound<4> paths[3 * detail::most_certified_taps];
  const bool has_residual = network.part_count() == 2;
  bool has_paths = false;
  if (has_residual) {
    const RunTimePart& residual = network.part(1);
    if (!residual.bounded || residual.axis_aligned) return false;
    has_paths = residual.path_bounded;
    bool withheld = residual.three_count == base.three_count;
    for (int tap = 0; withheld && tap < base.three_count; ++tap) withheld = residual.threes[tap] == base.threes[tap];
    if (!withheld && !has_paths) return false;
    int widths[3], layers = 0;
    if (has_paths && !has_path_bound(network, residual, widths, layers)) return false;
    for (int i = 0; has_paths && i < 3 * base.three_count; ++i) {
      path_bound(model.parameters() + base.parameter_count + 8, residual.inputs, static_cast<const int*>(widths),
                 layers, base.threes[i / 3] + i % 3, work, residual.widest, static_cast<double*>(paths[i].lower),
                 static_cast<double*>(paths[i].upper));
    }
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
      static_cast<const int*>(thrusts), model.parameters(), has_residual,
      static_cast<const detail::PathBound<4>*>(paths), has_paths, model.scales(), vehicle});
  return true;
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad
