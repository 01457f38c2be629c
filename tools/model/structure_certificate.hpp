// SPDX-License-Identifier: MIT
// The certificate (exported/certificate.hpp) of a model that is known at run time.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "model/asked_model.hpp"
#include "model/block.hpp"
#include "model/identity.hpp"
#include "pinnquad/exported/certificate.hpp"
#include "pinnquad/outputs/rigid_body_base.hpp"

namespace programs {

namespace detail {

/// Of a network that is shown the angular acceleration: by tap and axis.
template <class Scalar>
std::vector<pinnquad::detail::PathBound<4>> path_bounds(const NetworkSpec& network, const Scalar* parameters,
                                                const std::vector<int>& taps) {
  std::vector<int> widths;
  for (const LayerSpec& layer : network.layers) {
    if (layer.size > 0) widths.push_back(layer.size);
  }
  const int widest = *std::max_element(widths.begin(), widths.end());
  std::vector<double> work(4 * static_cast<std::size_t>(widest));
  std::vector<pinnquad::detail::PathBound<4>> all;
  for (const int place : taps) {
    for (int axis = 0; axis < 3; ++axis) {
      pinnquad::detail::PathBound<4>& bound = all.emplace_back();
      pinnquad::path_bound(parameters, network.inputs, widths.data(), static_cast<int>(widths.size()), place + axis,
                           work.data(), widest, static_cast<double*>(bound.lower), static_cast<double*>(bound.upper));
    }
  }
  return all;
}

/// Places of the features that more thrust moves, those of the present instant first; how many those are.
inline std::pair<std::vector<int>, int> thrust_places(const std::vector<std::string>& names) {
  std::vector<int> places, of_taps;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!pinnquad::detail::is_thrust(names[i])) continue;
    (names[i].back() == ']' ? of_taps : places).push_back(static_cast<int>(i));
  }
  const int present = static_cast<int>(places.size());
  places.insert(places.end(), of_taps.begin(), of_taps.end());
  return {places, present};
}

}  // namespace detail

/// The airframe, and the formula that a block's outputs add to, as a certificate reads them.
template <class Scalar>
pinnquad::detail::CertifiedVehicle<Scalar> certified_vehicle_of(const Block& block, const Identity& identity) {
  using namespace pinnquad;
  const Airframe<Scalar> airframe = airframe_in<Scalar>(identity.airframe.value);
  return block.base.empty() ? pinnquad::detail::certified_vehicle<AxisCommandOutputs>(airframe)
                            : pinnquad::detail::certified_vehicle<SignedSumsOn<RigidBodyBase>>(airframe);
}

namespace detail {

template <class Scalar>
std::optional<pinnquad::Certificate> certificate_in(const Block& block, const Identity& identity,
                                                    const AskedModel& model) {
  const std::vector<int>& taps = model.taps;
  const std::vector<NetworkSpec>& parts = identity.networks;
  const NetworkSpec& base = parts.front();
  if (!base.axis_aligned || base.threes != taps || parts.size() > 2) return {};
  if (!block.base.empty() && block.base != pinnquad::RigidBodyBase::description) return {};
  const auto in_scalar = [](const std::vector<double>& values) {
    std::vector<Scalar> result;
    for (const double value : values) result.push_back(static_cast<Scalar>(value));
    return result;
  };
  const std::vector<Scalar> parameters = in_scalar(block.parameters);
  const std::vector<Scalar> scales[] = {in_scalar(block.input_mean),     in_scalar(block.input_deviation),
                                        in_scalar(block.output_mean),    in_scalar(block.output_deviation),
                                        in_scalar(block.envelope_lower), in_scalar(block.envelope_upper)};
  std::vector<pinnquad::detail::PathBound<4>> paths;
  if (parts.size() == 2) {
    const bool withheld = parts[1].threes == taps;
    if (!parts[1].bounded || parts[1].axis_aligned || !(withheld || parts[1].path_bounded)) return {};
    if (parts[1].path_bounded) {
      paths = path_bounds(parts[1], parameters.data() + base.parameter_count() + 8, taps);
    }
  }
  const auto [thrusts, present] = thrust_places(model.names);
  return pinnquad::certificate_of(pinnquad::detail::CertifiedNumbers<Scalar>{
      block.inputs,
      static_cast<int>(taps.size()),
      taps.data(),
      static_cast<int>(thrusts.size()),
      present,
      thrusts.data(),
      parameters.data(),
      parts.size() == 2,
      paths.data(),
      !paths.empty(),
      {scales[0].data(), scales[1].data(), scales[2].data(), scales[3].data(), scales[4].data(), scales[5].data()},
      certified_vehicle_of<Scalar>(block, identity)});
}

}  // namespace detail

/// Of a model of signed sums that has the structure; nothing of one that has not.
inline std::optional<pinnquad::Certificate> certificate_of_block(const Block& block, const Identity& identity,
                                                                 const AskedModel& model) {
  if (!model.signed_sums || model.taps.empty()) return {};
  return block.is_double ? detail::certificate_in<double>(block, identity, model)
                         : detail::certificate_in<float>(block, identity, model);
}

}  // namespace programs
