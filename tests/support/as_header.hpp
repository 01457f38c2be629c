// SPDX-License-Identifier: MIT
// Numbers of a test as an exported header: what its writer would say of their types, and the hash over it.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "pinnquad/exported/model.hpp"

namespace pinnquad::test {

/// A description as the writer of a header writes it, spaces among it.
template <std::size_t Most>
struct DescriptionWords {
  char text[Most + 1] = {};
  std::size_t count = 0;
  constexpr void add(std::string_view piece) noexcept {
    for (const char letter : piece) text[count++] = letter;
  }
  constexpr void add(int number) noexcept {
    if (number >= 10) add(number / 10);
    text[count++] = static_cast<char>('0' + number % 10);
  }
};
template <class T>
constexpr auto description_words() noexcept {
  DescriptionWords<pinnquad::detail::description_length<T>()> words;
  pinnquad::detail::describe<T>(words);
  return words;
}

/// `Model` with the hash over what it says.
template <class Model>
struct Hashed : Model {
  static constexpr std::uint64_t contents_hash = pinnquad::detail::contents_hash_of<Model>();
};

/// All that a header says besides types and numbers.
template <class Numbers>
struct Described : Numbers {
  using Map = OutputMap<typename Numbers::Outputs>;
  using Window = pinnquad::detail::WindowOf<typename Numbers::Features>;
  static constexpr auto airframe = airframe_value<typename Numbers::Vehicle, double>();
  static constexpr auto answer_letters = description_words<typename Numbers::Network>();
  static constexpr auto base_letters =
      description_words<typename pinnquad::detail::BaseOf<typename Numbers::Outputs>::type>();

  static constexpr int format_version = model_format_version;
  static constexpr std::uint64_t training_data_hash = 0x0123456789abcdefu;
  static constexpr int training_rows = 6000;
  static constexpr const char* frame = model_frame;
  static constexpr auto feature_names = Numbers::Features::names;
  static constexpr auto feature_units = Numbers::Features::units;
  static constexpr auto output_names = Map::names;
  static constexpr auto output_units = Map::units;
  static constexpr const char* vehicle_name = Numbers::Vehicle::name;
  static constexpr auto motor_torque_signs = pinnquad::motor_torque_signs<typename Numbers::Vehicle>();
  static constexpr auto records = [] {
    std::array<const char*, known_records.size()> names{};
    for (std::size_t i = 0; i < names.size(); ++i) names[i] = known_records[i].data();
    return names;
  }();
  static constexpr const char* answer = static_cast<const char*>(answer_letters.text);
  static constexpr CommandMeaning command_meaning = command_meaning_of(airframe);
  static constexpr double command_lower = 0.0;
  static constexpr double command_upper = 1.0;
  static constexpr double sample_period_s = Window::period_s;
  static constexpr double lag_removed_s = 0.0;
  static constexpr int window_taps = Window::taps;
  static constexpr bool causal = Window::causal;
  static constexpr auto column_names = extra_column_names<typename Numbers::Features>;
  static constexpr auto column_units = extra_column_units<typename Numbers::Features>;
  static constexpr AllocationMatrix<double> allocation = pinnquad::allocation(airframe);
  static constexpr const char* base = static_cast<const char*>(base_letters.text);
};

template <class Numbers>
using AsHeader = Hashed<Described<Numbers>>;

/// Numbers that no header may have, as an instance: whoever makes one checks it.
template <class Header>
struct Unchecked : Header {
  static constexpr ModelKind kind = ModelKind::instance;
  void forward(const typename Header::Scalar* x, typename Header::Scalar* y) const noexcept {
    Header::Network::forward(Header::parameters.data(), x, y);
  }
};

}  // namespace pinnquad::test
