// SPDX-License-Identifier: MIT
// The library's activations as functions that are chosen at run time, in the order of Activations (nn/activations.hpp).
#pragma once

#include <cstddef>
#include <string_view>
#include <tuple>

#include "pinnquad/nn/activations.hpp"
#include "pinnquad/nn/kernel/pack.hpp"

namespace pinnquad::detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

template <class Number>
struct RunTimeActivation {
  std::string_view description;
  Number (*activate)(Number) noexcept;
  void (*activate_all)(Number*, std::size_t) noexcept;
  Number (*slope)(Number) noexcept;  ///< by its input
};
template <class Spec, class Number>
constexpr RunTimeActivation<Number> run_time_activation() noexcept {
  using Layer = typename Spec::template Bind<Number, 1>;
  const auto all = [](Number* values, std::size_t count) noexcept {
    std::size_t i = 0;
    if constexpr (has_vector_unit<Number> && is_detected<PackActivateOf, Layer, pinnquad::NativePack<Number>>) {
      using Pack = pinnquad::NativePack<Number>;
      constexpr auto width = static_cast<std::size_t>(Pack::width);
      for (; i + width <= count; i += width) Layer::activate(Pack::load(values + i)).store(values + i);
    }
    for (; i < count; ++i) values[i] = Number(Layer::activate(values[i]));
  };
  return {Spec::description, [](Number v) noexcept { return Number(Layer::activate(v)); }, all,
          [](Number v) noexcept { return Number(slope_at<Layer>(slopes_from_input<Layer> ? v : Layer::activate(v))); }};
}
template <class Number, class List>
struct ActivationTable;
template <class Number, class... Specs>
struct ActivationTable<Number, std::tuple<Specs...>> {
  static constexpr RunTimeActivation<Number> of[] = {run_time_activation<Specs, Number>()...};
};
/// Those of the library, in the order of Activations.
template <class Number>
inline constexpr auto& run_time_activations = ActivationTable<Number, Activations>::of;

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad::detail
