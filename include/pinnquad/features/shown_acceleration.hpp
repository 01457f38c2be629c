// SPDX-License-Identifier: MIT
// The angular acceleration that a feature shows, known by its name and unit alone, as they stand in a block: a
// certificate counts each such feature (exported/certificate.hpp), a search for a counterexample moves each.
#pragma once

#include <string_view>

#include "pinnquad/features/chosen_features.hpp"

namespace pinnquad {

/// About its axis; `none`: the feature stands as it is, whatever angular acceleration is asked; `unknown`: a feature of
/// one's own, which may be worked out from it.
enum class ShownAcceleration { about_x, about_y, about_z, none, unknown };

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// "wdot_x" of "wdot_x[-1]"; no substr(): noexcept.
constexpr std::string_view name_at_tap(std::string_view name) noexcept {
  const std::size_t bracket = name.find('[');
  return {name.data(), bracket < name.size() ? bracket : name.size()};
}
constexpr bool is_of_present(std::string_view name) noexcept { return name_at_tap(name).size() == name.size(); }

/// True of an angular acceleration, whatever its unit of angle, and of a torque, which is made for one: "rad/s^2",
/// "deg/s/s", "rpm/s", "N m". Not of "m/s^2".
constexpr bool is_unit_of_turning(std::string_view unit) noexcept {
  for (const std::string_view whole : {"N m", "Nm", "N*m", "N.m", "N·m", "rpm/s", "dps/s", "Hz/s"}) {
    if (unit.find(whole) < unit.size()) return true;
  }
  for (const std::string_view squared : {"/s^2", "/s2", "/s²", "/s/s", "s^-2", "s-2", "s⁻²"}) {
    std::size_t at = unit.find(squared);
    if (at > unit.size()) continue;
    while (at > 0 && (unit[at - 1] == ' ' || unit[at - 1] == '*')) --at;
    if (at == 0 || unit[at - 1] != 'm') return true;
  }
  return false;
}

/// Names mean the same in each feature set of the library. A column stands as it was measured; nobody knows of one that
/// is an angular acceleration by its name or unit, or a torque.
constexpr ShownAcceleration shown_acceleration(std::string_view name, std::string_view unit, bool is_column) noexcept {
  const std::string_view own = name_at_tap(name);
  if (is_column) {
    return same_start(own, "wdot") || is_unit_of_turning(unit) ? ShownAcceleration::unknown : ShownAcceleration::none;
  }
  if (own == "altitude") return unit == "m" ? ShownAcceleration::none : ShownAcceleration::unknown;
  for (int i = 0; i < NamedFeatures::size; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (own != NamedFeatures::names[at] || unit != NamedFeatures::units[at]) continue;
    const int axis = i - NamedFeatures::angular_acceleration;
    return axis >= 0 && axis < 3 ? static_cast<ShownAcceleration>(axis) : ShownAcceleration::none;
  }
  return ShownAcceleration::unknown;
}
/// The angular acceleration that entry `feature` of X shows.
template <class Features>
constexpr ShownAcceleration shown_acceleration_of(int feature) noexcept {
  const auto at = static_cast<std::size_t>(feature);
  return shown_acceleration(Features::names[at], Features::units[at], is_column<Features>(feature));
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail
}  // namespace pinnquad
