// SPDX-License-Identifier: MIT
// The records of a model block of version 2: what its numbers mean, between header and scalars. Each is
//   u16 type (bit 15: mandatory), u16 0, u32 length, bytes, zeros up to a multiple of 8.
// A reader refuses a mandatory record that it does not know and skips any other one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "pinnquad/core/first_of.hpp"
#include "pinnquad/core/status.hpp"
#include "pinnquad/exported/model.hpp"

namespace pinnquad {

/// Types, and what the bytes are; "scalar" is the block's.
enum class BlockRecord : std::uint16_t {
  commands = 1,        ///< u32 CommandMeaning, u32 0, scalars lower and upper command
  clock = 2,           ///< u32 sample period in ns (0: not said), u32 lag removed in ns
  window = 3,          ///< u32 taps, u32 1 if causal
  columns = 4,         ///< name and unit of each extra column, every text closed by a 0
  allocation = 5,      ///< 16 scalars, row-major
  base = 6,            ///< description of what the outputs add to
  verdict = 7,         ///< u32 bits of Judged, u32 0; optional
  slope_signs = 8,     ///< 12 x i8: of du_i/d(angular acceleration), rotor by rotor about x, y, z, 0 unproven; optional
  residual_range = 9,  ///< scalars: lower bounds of all outputs, then upper ones; optional
  distance = 10,  ///< scalars: means of all features, lower triangle of L^-1 row by row, limit of the norm; optional
};

inline constexpr std::uint16_t mandatory_record = 0x8000;

/// How a model was judged before it was exported (evaluation/errors.hpp), as bits.
struct Judged {
  static constexpr std::uint32_t worse_than_mean = 1;  ///< not for flight
  static constexpr std::uint32_t beats_linear_regression = 2;
  static constexpr std::uint32_t bits(bool is_worse_than_mean, bool does_beat_linear_regression) noexcept {
    return (is_worse_than_mean ? worse_than_mean : 0u) | (does_beat_linear_regression ? beats_linear_regression : 0u);
  }
};

/// Sizes of a block's records.
struct BlockRecordLayout {
  static constexpr std::size_t counts = 8;  ///< u32 number of records, u32 bytes of them all, before the first
  static constexpr std::size_t head = 8;    ///< type and length
  static PINNQUAD_ALWAYS_INLINE constexpr std::size_t padded(std::size_t length) noexcept {
    return (length + 7) / 8 * 8;
  }
};

namespace detail {

PINNQUAD_ALWAYS_INLINE constexpr std::uint32_t read_u32(const unsigned char* from) noexcept {
  return std::uint32_t{from[0]} | std::uint32_t{from[1]} << 8 | std::uint32_t{from[2]} << 16 |
         std::uint32_t{from[3]} << 24;
}
PINNQUAD_ALWAYS_INLINE constexpr std::uint64_t read_u64(const unsigned char* from) noexcept {
  return std::uint64_t{read_u32(from)} | std::uint64_t{read_u32(from + 4)} << 32;
}

inline namespace PINNQUAD_INSTRUCTION_SET {

/// Texts, each with its closing 0, against bytes: what is left to compare.
struct BytesMatch {
  const unsigned char* at;
  const unsigned char* end;
  bool same = true;

  constexpr void take(unsigned char byte) noexcept {
    same = same && at != end && *at == byte;
    if (at != end) ++at;
  }
  constexpr void take_text(const char* text) noexcept {
    for (; *text != '\0'; ++text) take(static_cast<unsigned char>(*text));
    take(0);
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

inline namespace PINNQUAD_INSTRUCTION_SET {

/// A block's records, as far as they are not compared with the shape. As made, none is stated.
template <class Scalar, int Features, int Outputs>
struct ModelRecords {
  bool stated = false;  ///< false for a block of version 1: the next five are not said
  CommandMeaning command_meaning = CommandMeaning::thrust;
  Scalar command_lower = Scalar(0);
  Scalar command_upper = Scalar(1);
  std::uint32_t sample_period_ns = 0;  ///< 0: not said
  std::uint32_t lag_removed_ns = 0;    ///< of the rotors, taken out of the commands before the training
  std::uint32_t judged = 0;            ///< bits of Judged
  bool has_verdict = false;
  bool has_slope_signs = false;
  bool has_residual_range = false;
  std::array<std::array<std::int8_t, 3>, std::size_t(rotor_count)> slope_signs{};
  std::array<Scalar, std::size_t(Outputs)> residual_lower{};
  std::array<Scalar, std::size_t(Outputs)> residual_upper{};
  /// In the block, or null: means, triangle and limit as in BlockRecord::distance.
  const Scalar* distance = nullptr;

  /// The model was worse than the mean of the commands, and exported all the same.
  bool worse_than_mean() const noexcept { return (judged & Judged::worse_than_mean) != 0; }
};

/// Reads the records of a block whose header and checksum have been checked.
template <class Shape>
class BlockRecordReader {
 public:
  using Scalar = typename Shape::Scalar;
  using Features = typename Shape::Features;
  using Outputs = typename Shape::Outputs;
  static constexpr int inputs = Features::size;
  static constexpr int outputs = OutputMap<Outputs>::size;
  using Records = ModelRecords<Scalar, inputs, outputs>;

  /// `first` is behind the fixed header, `available` the bytes from there to the checksum; `size` becomes those of the records
  /// with their counts. `block_corrupt`: they do not fit there, or contradict themselves. `block_incompatible`: a mandatory
  /// one is unknown, or one says another thing than the shape.
  static Status read(const unsigned char* first, std::size_t available, Records& records, std::size_t& size) noexcept {
    using Layout = BlockRecordLayout;
    if (available < Layout::counts) return Status::block_corrupt;
    const std::uint32_t count = detail::read_u32(first);
    const std::uint32_t bytes = detail::read_u32(first + 4);
    if (bytes % 8 != 0 || bytes > available - Layout::counts) return Status::block_corrupt;
    const unsigned char* at = first + Layout::counts;
    std::size_t left = bytes;
    std::uint32_t seen = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      if (left < Layout::head) return Status::block_corrupt;
      const std::uint32_t word = detail::read_u32(at);
      const std::uint32_t length = detail::read_u32(at + 4);
      if (word > 0xffff || length > left - Layout::head) return Status::block_corrupt;
      const std::uint32_t type = word & (mandatory_record - 1u);
      if (type >= 1 && type <= known_types) {
        if ((seen >> type & 1u) != 0) return Status::block_corrupt;
        seen |= 1u << type;
        const Status status = take(static_cast<BlockRecord>(type), at + Layout::head, length, records);
        if (status != Status::ok) return status;
      } else if ((word & mandatory_record) != 0) {
        return Status::block_incompatible;
      }
      const std::size_t whole = Layout::head + Layout::padded(length);  // both multiples of 8, as `left` is
      at += whole;
      left -= whole;
    }
    if (left != 0) return Status::block_corrupt;
    size = Layout::counts + bytes;
    return complete(seen) && fits_header(records) ? Status::ok : Status::block_incompatible;
  }

 private:
  static constexpr std::uint32_t known_types = 10;
  static constexpr std::size_t column_count = extra_column_names<Features>.size();
  using Base = typename detail::BaseOf<Outputs>::type;
  static constexpr bool has_base = !std::is_same_v<Base, detail::NoBase>;
  using Window = detail::WindowOf<Features>;
  static constexpr std::uint32_t window_ns = detail::nanoseconds(Window::period_s);
  static constexpr std::uint32_t longest_time_ns = detail::nanoseconds(longest_clock_s);

  static Status take(BlockRecord type, const unsigned char* bytes, std::uint32_t length, Records& to) noexcept {
    const auto scalars = [&](std::size_t offset) {  // records begin at multiples of 8
      return static_cast<const Scalar*>(static_cast<const void*>(bytes + offset));
    };
    const auto holds = [&](bool fits) { return fits ? Status::ok : Status::block_incompatible; };
    switch (type) {
      case BlockRecord::commands: {
        if (length != 8 + 2 * sizeof(Scalar) || detail::read_u32(bytes + 4) != 0) return Status::block_corrupt;
        const std::uint32_t meaning = detail::read_u32(bytes);
        const Scalar* range = scalars(8);
        if (!all_finite(range, 2) || !(range[0] <= range[1])) return Status::block_corrupt;
        if (meaning >= command_meaning_count) return Status::block_incompatible;
        to.stated = true;
        to.command_meaning = static_cast<CommandMeaning>(meaning);
        to.command_lower = range[0];
        to.command_upper = range[1];
        return Status::ok;
      }
      case BlockRecord::clock:
        if (length != 8) return Status::block_corrupt;
        to.sample_period_ns = detail::read_u32(bytes);
        to.lag_removed_ns = detail::read_u32(bytes + 4);
        if (to.sample_period_ns > longest_time_ns || to.lag_removed_ns > longest_time_ns) {
          return Status::block_corrupt;
        }
        return holds(window_ns == 0 || detail::same_period_ns(to.sample_period_ns, window_ns));
      case BlockRecord::window:
        if (length != 8) return Status::block_corrupt;
        return holds(detail::read_u32(bytes) == std::uint32_t(Window::taps) &&
                     detail::read_u32(bytes + 4) == std::uint32_t(Window::causal));
      case BlockRecord::columns: {
        detail::BytesMatch match{bytes, bytes + length};
        if constexpr (column_count > 0) {
          const auto* names = detail::first_of<const char*>(extra_column_names<Features>);
          const auto* units = detail::first_of<const char*>(extra_column_units<Features>);
          for (std::size_t i = 0; i < column_count; ++i) {
            match.take_text(names[i]);
            match.take_text(units[i]);
          }
        }
        return holds(match.same && match.at == match.end);
      }
      case BlockRecord::allocation: {
        if (length != 16 * sizeof(Scalar)) return Status::block_corrupt;
        const Scalar* entries = scalars(0);
        constexpr AllocationMatrix<Scalar> expected = allocation(airframe_value<typename Shape::Vehicle, Scalar>());
        const Scalar* own = detail::first_of<Scalar>(expected);
        const auto entry_of = [](const Scalar* matrix) {
          return [matrix](std::size_t row, std::size_t column) { return matrix[row * rotor_count + column]; };
        };
        return holds(detail::same_allocation<Scalar>(entry_of(entries), entry_of(own)));
      }
      case BlockRecord::base: {
        constexpr auto letters = detail::description_letters<Base>();
        return holds(detail::same_letters(&letters.text[0], letters.count, bytes, length));
      }
      case BlockRecord::verdict:
        if (length != 8) return Status::block_corrupt;
        to.judged = detail::read_u32(bytes);
        to.has_verdict = true;
        return Status::ok;
      case BlockRecord::slope_signs: {
        if (length != 3 * rotor_count) return Status::block_corrupt;
        bool signs = true;
        constexpr auto torque_signs = motor_torque_signs<typename Shape::Vehicle>();
        const int* own = detail::first_of<int>(torque_signs);
        auto* slope_signs = detail::first_of<std::int8_t>(to.slope_signs);
        for (std::size_t i = 0; i < 3 * std::size_t(rotor_count); ++i) {
          slope_signs[i] = bytes[i] == 0xff ? std::int8_t(-1) : static_cast<std::int8_t>(bytes[i] & 1);
          signs &= bytes[i] <= 1 || bytes[i] == 0xff;
          if (detail::StatedStructure<typename Shape::Network>::known) {
            signs &= detail::true_slope_sign(slope_signs[i], own[i]);
          }
        }
        to.has_slope_signs = true;
        return signs ? Status::ok : Status::block_corrupt;
      }
      case BlockRecord::residual_range: {
        if (length != 2 * std::size_t(outputs) * sizeof(Scalar)) return Status::block_corrupt;
        const Scalar* lower = scalars(0);
        const Scalar* upper = lower + outputs;
        auto* to_lower = detail::first_of<Scalar>(to.residual_lower);
        auto* to_upper = detail::first_of<Scalar>(to.residual_upper);
        bool sound = all_finite(lower, 2 * outputs);
        for (int i = 0; i < outputs; ++i) {
          sound &= lower[i] <= upper[i];
          to_lower[i] = lower[i];
          to_upper[i] = upper[i];
        }
        to.has_residual_range = true;
        return sound ? Status::ok : Status::block_corrupt;
      }
      case BlockRecord::distance: {
        constexpr std::size_t numbers = std::size_t(inputs) + detail::triangle(std::size_t(inputs)) + 1;
        if (length != numbers * sizeof(Scalar)) return Status::block_corrupt;
        to.distance = scalars(0);
        const bool sound = all_finite(to.distance, int(numbers)) && to.distance[numbers - 1] > Scalar(0);
        return sound ? Status::ok : Status::block_corrupt;
      }
    }
    return Status::block_corrupt;  // read() asks for known types alone
  }

  /// What the shape has cannot be left unsaid.
  static bool complete(std::uint32_t seen) noexcept {
    const auto said = [seen](BlockRecord record) { return (seen >> static_cast<unsigned>(record) & 1u) != 0; };
    return said(BlockRecord::commands) && said(BlockRecord::clock) && said(BlockRecord::window) &&
           said(BlockRecord::allocation) && (!has_base || said(BlockRecord::base)) &&
           (column_count == 0 || said(BlockRecord::columns));
  }

  /// Where the shape is an exported header: its commands mean the same, as often.
  static bool fits_header(const Records& records) noexcept {
    if constexpr (is_model<Shape>) {
      // constants: worked out by the compiler
      constexpr std::uint32_t period = detail::nanoseconds(detail::header_period_s<Shape>());
      constexpr CommandMeaning meaning = detail::header_command_meaning<Shape>();
      return records.command_meaning == meaning &&
             (period == 0 || detail::same_period_ns(records.sample_period_ns, period));
    }
    return true;
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad
