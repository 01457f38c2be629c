// SPDX-License-Identifier: MIT
// An output schema that is known at run time alone, from its description: one of the library, or a linear one of a
// user's own, of which the block holds the numbers.
#pragma once

#include <array>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "pinnquad/exported/model_records.hpp"
#include "pinnquad/outputs/axis_command_outputs.hpp"
#include "pinnquad/outputs/residual_outputs.hpp"
#include "pinnquad/outputs/rigid_body_base.hpp"
#include "pinnquad/outputs/wrench_outputs.hpp"

namespace pinnquad {

namespace detail {

/// The output schemas of the library. A block names one by its description.
using OutputSchemas =
    std::tuple<CommandOutputs, RotorSpeedOutputs, AxisCommandOutputs, WrenchOutputs, AccelerationOutputs,
               ResidualOutputs<LinearizedBase>, ResidualOutputs<RigidBodyBase>, SignedSumsOn<RigidBodyBase>>;

template <class Schema, class List>
inline constexpr bool is_among = false;
template <class Schema, class... Known>
inline constexpr bool is_among<Schema, std::tuple<Known...>> = (std::is_same_v<Schema, Known> || ...);
template <class Schema>
inline constexpr bool is_known_schema = is_among<Schema, OutputSchemas>;

template <class Schema>
using IsLinear = std::enable_if_t<Schema::linear>;

inline namespace PINNQUAD_INSTRUCTION_SET {

template <class Number, class List>
struct SchemaSettings;
template <class Number, class... Schema>
struct SchemaSettings<Number, std::tuple<Schema...>> {
  static constexpr std::size_t count = sizeof...(Schema);
  std::tuple<decltype(OutputMap<Schema>::setting(std::declval<const Airframe<Number>&>()))...> of;
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

inline namespace PINNQUAD_INSTRUCTION_SET {

/// Commands of outputs, and their derivatives, in `Number`.
template <class Number>
class RunTimeOutputs {
  using Settings = detail::SchemaSettings<Number, detail::OutputSchemas>;

 public:
  using Schemas = detail::OutputSchemas;
  /// Features that a base may read: the first of them.
  static constexpr int base_features = 16;
  /// Outputs that a schema may have.
  static constexpr int most_outputs = 16;

  /// Finds the schema by the letters of its description. False where the library has none of that name.
  bool find(std::string_view description) noexcept {
    bool found = false;
    each_schema([&](auto schema, std::size_t place) {
      using Schema = decltype(schema);
      if (!detail::describes<Schema>(description)) return;
      found = true;
      place_ = place;
      size_ = OutputMap<Schema>::size;
      axis_commands_ = is_signed_sums<Schema>;
    });
    return found;
  }
  /// A schema of a user's own: `numbers` are commands at outputs 0, then by each output, row by row.
  void take_affine(const Number* numbers, int size) noexcept {
    place_ = Settings::count;
    size_ = size;
    for (int i = 0; i < rotor_count * (1 + size); ++i) affine_[i] = numbers[i];
  }
  void prepare(const Airframe<Number>& airframe) noexcept {
    each_schema([&](auto schema, std::size_t place) {
      using Schema = decltype(schema);
      if (place == place_) setting<Schema>() = OutputMap<Schema>::setting(airframe);
    });
  }

  int size() const noexcept { return size_; }
  bool is_axis_commands() const noexcept { return axis_commands_; }
  /// True where commands are an affine map of outputs and angular acceleration; `curved`: a rotor's curve is between.
  /// A schema that is added is none until it stands here: nothing is proven of it.
  bool is_affine(bool curved) const noexcept {
    using Always =
        std::tuple<CommandOutputs, AxisCommandOutputs, ResidualOutputs<RigidBodyBase>, SignedSumsOn<RigidBodyBase>>;
    using OfThrusts = std::tuple<WrenchOutputs, AccelerationOutputs, ResidualOutputs<LinearizedBase>>;
    bool affine = place_ == Settings::count;
    visit([&](auto schema) {
      using Schema = decltype(schema);
      affine = detail::is_among<Schema, Always> || (!curved && detail::is_among<Schema, OfThrusts>);
    });
    return affine;
  }
  /// True where `name(place)` and `unit(place)` are what its base reads at each place.
  template <class Name, class Unit>
  bool reads_its_features(int features, const Name& name, const Unit& unit) const noexcept {
    bool reads = true;
    visit([&](auto schema) {
      for (const ReadFeature& read : detail::BaseOf<decltype(schema)>::type::reads) {
        reads = reads && read.place < features && name(read.place) == read.name && unit(read.place) == read.unit;
      }
    });
    return reads;
  }
  /// Calls `use(base)` with the base of a schema of the library, or detail::NoBase.
  template <class Use>
  void with_base(const Use& use) const noexcept {
    visit([&](auto schema) { use(typename detail::BaseOf<decltype(schema)>::type{}); });
  }
  /// Calls `use(schema)` where it is one of the library.
  template <class Use>
  void visit(const Use& use) const noexcept {
    each_schema([&](auto schema, std::size_t place) {
      if (place == place_) use(schema);
    });
  }
  /// Name and unit of an output of the library's schema match.
  bool has(int output, std::string_view name, std::string_view unit) const noexcept {
    bool same = true;
    visit([&](auto schema) {
      using Map = OutputMap<decltype(schema)>;
      same = name == Map::names[std::size_t(output)] && unit == Map::units[std::size_t(output)];
    });
    return same;
  }

  /// u of features x and outputs y, physical units.
  void commands(const Number* x, const Number* y, Number* u) const noexcept {
    if (place_ == Settings::count) {
      for (int rotor = 0; rotor < rotor_count; ++rotor) {
        u[rotor] = affine_[rotor];
        for (int k = 0; k < size_; ++k) u[rotor] += by_output(rotor, k) * y[k];
      }
      return;
    }
    visit([&](auto schema) {
      using Schema = decltype(schema);
      OutputMap<Schema>::commands(x, y, setting<Schema>(), u);
    });
  }
  /// du/dy, rotor_count x size, and du/dx of the first `base_features` features, both row-major.
  void slopes(const Number* x, const Number* y, Number* by_outputs, Number* by_x) const noexcept {
    for (int i = 0; i < rotor_count * base_features; ++i) by_x[i] = Number(0);
    if (place_ == Settings::count) {
      for (int i = 0; i < rotor_count * size_; ++i) by_outputs[i] = affine_[rotor_count + i];
      return;
    }
    visit([&](auto schema) {
      using Schema = decltype(schema);
      using Map = OutputMap<Schema>;
      Number own[Map::slope_count];
      Map::slopes(x, y, setting<Schema>(), own);
      for (int rotor = 0; rotor < rotor_count; ++rotor) {
        for (int k = 0; k < Map::size; ++k) {
          const bool reads = k >= Map::first_output(rotor) && k < Map::last_output(rotor);
          by_outputs[rotor * Map::size + k] = reads ? own[Map::slope_index(rotor, k)] : Number(0);
        }
      }
      if constexpr (Map::has_feature_slopes) {
        Map::template feature_slopes<base_features>(x, y, setting<Schema>(), by_x);
      }
    });
  }

 private:
  template <class Use, std::size_t... Place>
  static void each_of(const Use& use, std::index_sequence<Place...>) noexcept {
    (use(std::tuple_element_t<Place, Schemas>{}, Place), ...);
  }
  template <class Use>
  static void each_schema(const Use& use) noexcept {
    each_of(use, std::make_index_sequence<Settings::count>{});
  }
  template <class Schema, std::size_t... Place>
  static constexpr std::size_t place_among(std::index_sequence<Place...>) noexcept {
    return ((std::is_same_v<Schema, std::tuple_element_t<Place, Schemas>> ? Place : 0) + ...);
  }
  template <class Schema>
  static constexpr std::size_t place_of = place_among<Schema>(std::make_index_sequence<Settings::count>{});
  template <class Schema>
  auto& setting() noexcept {
    return std::get<place_of<Schema>>(settings_.of);
  }
  template <class Schema>
  const auto& setting() const noexcept {
    return std::get<place_of<Schema>>(settings_.of);
  }
  Number by_output(int rotor, int k) const noexcept { return affine_[rotor_count + rotor * size_ + k]; }

  Settings settings_{};
  Number affine_[rotor_count * (1 + most_outputs)] = {};
  std::size_t place_ = Settings::count;
  int size_ = 0;
  bool axis_commands_ = false;
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad
