// SPDX-License-Identifier: MIT
// Numbers of a test as an exported header: what its writer would say of their types, and the hash over it.
#pragma once

#include <cstdint>

#include "pinnquad/exported/model.hpp"

namespace pinnquad::test {

/// `Model` with the hashes over what it says.
template <class Model>
struct Hashed : Model {
  static constexpr std::uint64_t shape_hash = pinnquad::shape_hash<Model>;
  static constexpr std::uint64_t contents_hash = pinnquad::detail::contents_hash_of<Model>();
};

/// All that a header says besides types and numbers.
template <class Numbers>
struct Described : Numbers {
  using Window = pinnquad::detail::WindowOf<typename Numbers::Features>;
  static constexpr auto airframe = airframe_value<typename Numbers::Vehicle, double>();

  static constexpr int format_version = header_format_version;
  static constexpr std::uint64_t training_data_hash = 0x0123456789abcdefu;
  static constexpr int training_rows = 6000;
  static constexpr CommandMeaning command_meaning = command_meaning_of(airframe);
  static constexpr double command_lower = 0.0;
  static constexpr double command_upper = 1.0;
  static constexpr double sample_period_s = Window::period_s;
  static constexpr double lag_removed_s = 0.0;
  static constexpr AllocationMatrix<double> allocation = pinnquad::allocation(airframe);
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
