// SPDX-License-Identifier: MIT
// Reads the records of a model block (exported/model_block.hpp): each is compared with the shape, or kept.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "pinnquad/core/finite.hpp"
#include "pinnquad/core/first_of.hpp"
#include "pinnquad/exported/model_block.hpp"

namespace pinnquad {

inline namespace PINNQUAD_INSTRUCTION_SET {

/// A block's records, as far as they are not compared with the shape. As made, none is stated.
template <class Scalar>
struct ModelRecords {
  bool stated = false;  ///< false for a block of version 1: the next five are not said
  CommandMeaning command_meaning = CommandMeaning::thrust;
  Scalar command_lower = Scalar(0);
  Scalar command_upper = Scalar(1);
  std::uint32_t sample_period_ns = 0;  ///< 0: not said
  std::uint32_t lag_removed_ns = 0;    ///< of the rotors, taken out of the commands before the training
  bool has_verdict = false;
  bool worse_than_mean = false;  ///< than the mean of the commands, and exported all the same
  bool beats_linear_regression = false;
  // In the block, or null; as BlockRecord describes them. A LoadedModel has none.
  const signed char* slope_signs = nullptr;
  const Scalar* residual_range = nullptr;
  const Scalar* distance = nullptr;
};

}  // namespace PINNQUAD_INSTRUCTION_SET

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// Reads the records of a block whose header and checksum have been checked.
template <class Shape>
class RecordReader {
 public:
  using Scalar = typename Shape::Scalar;
  using Records = ModelRecords<Scalar>;

  /// `first` is behind the fixed header, `available` the bytes from there to the checksum; `size` becomes those of the
  /// records with their counts. `block_corrupt`: they do not fit there, or contradict themselves. `block_incompatible`:
  /// a mandatory one is unknown, or one says another thing than the shape.
  static Status read(const unsigned char* first, std::size_t available, Records& records, std::size_t& size) noexcept {
    using Header = ModelBlockHeader;
    if (available < Header::record_counts) return Status::block_corrupt;
    const std::uint32_t count = read_u32(first);
    const std::uint32_t bytes = read_u32(first + 4);
    if (bytes % 8 != 0 || bytes > available - Header::record_counts) return Status::block_corrupt;
    const unsigned char* at = first + Header::record_counts;
    std::size_t left = bytes;
    std::uint32_t seen = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      if (left < Header::record_head) return Status::block_corrupt;
      const std::uint32_t word = read_u32(at);
      const std::uint32_t length = read_u32(at + 4);
      if (word > 0xffff || length > left - Header::record_head) return Status::block_corrupt;
      const std::uint32_t type = word & (mandatory_record - 1u);
      if (type >= 1 && type <= block_record_types) {
        if ((seen >> type & 1u) != 0) return Status::block_corrupt;
        seen |= 1u << type;
        const Status status = take(static_cast<BlockRecord>(type), at + Header::record_head, length, records);
        if (status != Status::ok) return status;
      } else if ((word & mandatory_record) != 0) {
        return Status::block_incompatible;
      }
      const std::size_t whole = Header::record_head + Header::padded(length);  // both multiples of 8, as `left` is
      at += whole;
      left -= whole;
    }
    if (left != 0) return Status::block_corrupt;
    size = Header::record_counts + bytes;
    return complete(seen) && fits_header(records) ? Status::ok : Status::block_incompatible;
  }

 private:
  using Features = typename Shape::Features;
  using Outputs = typename Shape::Outputs;
  using Base = typename BaseOf<Outputs>::type;
  using Window = WindowOf<Features>;
  static constexpr std::size_t inputs = std::size_t(Features::size);
  static constexpr std::size_t outputs = std::size_t(OutputMap<Outputs>::size);
  static constexpr bool has_base = !std::is_same_v<Base, NoBase>;
  static constexpr bool has_columns = columns_length<Features>() > 0;

  static Status take(BlockRecord type, const unsigned char* bytes, std::uint32_t length, Records& to) noexcept {
    static constexpr RecordLengths lengths = record_lengths(sizeof(Scalar), inputs, outputs);
    const std::uint32_t sized = lengths.of[static_cast<unsigned>(type)];
    if (sized != 0 && length != sized) return Status::block_corrupt;
    const auto* scalars = static_cast<const Scalar*>(static_cast<const void*>(bytes));  // at a multiple of 8
    bool sound = true, fits = true;                                                     // in itself, to the shape
    switch (type) {
      case BlockRecord::commands: {
        const std::uint32_t meaning = read_u32(bytes);
        const Scalar* range = scalars + 8 / sizeof(Scalar);
        sound = read_u32(bytes + 4) == 0 && all_finite(range, 2) && range[0] <= range[1];
        fits = meaning < command_meaning_count;
        to.stated = true;
        to.command_meaning = static_cast<CommandMeaning>(meaning);
        to.command_lower = range[0];
        to.command_upper = range[1];
        break;
      }
      case BlockRecord::clock: {
        constexpr std::uint32_t window_ns = nanoseconds(Window::period_s), longest_ns = nanoseconds(longest_clock_s);
        to.sample_period_ns = read_u32(bytes);
        to.lag_removed_ns = read_u32(bytes + 4);
        sound = to.sample_period_ns <= longest_ns && to.lag_removed_ns <= longest_ns;
        fits = window_ns == 0 || same_period_ns(to.sample_period_ns, window_ns);
        break;
      }
      case BlockRecord::window:
        fits = read_u32(bytes) == std::uint32_t(Window::taps) && read_u32(bytes + 4) == std::uint32_t(Window::causal);
        break;
      case BlockRecord::columns: {
        constexpr auto columns = column_bytes<Features>();
        fits = length == columns.count && std::memcmp(bytes, &columns.text[0], length) == 0;
        break;
      }
      case BlockRecord::allocation: {
        constexpr AllocationMatrix<Scalar> expected = allocation(airframe_value<typename Shape::Vehicle, Scalar>());
        const auto entry_of = [](const Scalar* matrix) {
          return [matrix](std::size_t row, std::size_t column) { return matrix[row * rotor_count + column]; };
        };
        fits = same_allocation<Scalar>(entry_of(scalars), entry_of(first_of<Scalar>(expected)));
        break;
      }
      case BlockRecord::base: {
        constexpr auto letters = description_letters<Base>();
        fits = same_letters(&letters.text[0], letters.count, bytes, length);
        break;
      }
      case BlockRecord::verdict:
        to.has_verdict = true;
        to.worse_than_mean = (read_u32(bytes) & judged_bits(true, false)) != 0;
        to.beats_linear_regression = (read_u32(bytes) & judged_bits(false, true)) != 0;
        break;
      case BlockRecord::slope_signs: {
        constexpr TorqueSigns torque_signs = motor_torque_signs<typename Shape::Vehicle>();
        const int* own = first_of<int>(torque_signs);
        to.slope_signs = static_cast<const signed char*>(static_cast<const void*>(bytes));
        for (std::size_t i = 0; i < length; ++i) {
          const int sign = to.slope_signs[i];
          sound &= -1 <= sign && sign <= 1;
          if (StatedStructure<typename Shape::Network>::known) sound &= true_slope_sign(sign, own[i]);
        }
        break;
      }
      case BlockRecord::residual_range:
        to.residual_range = scalars;
        sound = all_finite(scalars, 2 * int(outputs));
        for (std::size_t i = 0; i < outputs; ++i) sound &= scalars[i] <= scalars[outputs + i];
        break;
      case BlockRecord::distance: {
        constexpr std::size_t last = inputs + triangle(inputs);
        to.distance = scalars;
        sound = all_finite(scalars, int(last) + 1) && scalars[last] > Scalar(0);
        break;
      }
    }
    if (!sound) return Status::block_corrupt;
    return fits ? Status::ok : Status::block_incompatible;
  }

  /// Every record that the shape asks for is there.
  static bool complete(std::uint32_t seen) noexcept {
    const auto said = [seen](BlockRecord record) { return (seen >> static_cast<unsigned>(record) & 1u) != 0; };
    return said(BlockRecord::commands) && said(BlockRecord::clock) && said(BlockRecord::window) &&
           said(BlockRecord::allocation) && (!has_base || said(BlockRecord::base)) &&
           (!has_columns || said(BlockRecord::columns));
  }

  /// Where the shape is an exported header: its commands mean the same, as often.
  static bool fits_header(const Records& records) noexcept {
    if constexpr (is_model<Shape>) {
      // constants: worked out by the compiler
      constexpr std::uint32_t period = nanoseconds(header_period_s<Shape>());
      constexpr CommandMeaning meaning = header_command_meaning<Shape>();
      return records.command_meaning == meaning && (period == 0 || same_period_ns(records.sample_period_ns, period));
    }
    return true;
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail
}  // namespace pinnquad
