// SPDX-License-Identifier: MIT
// Reads the records of a model block (exported/model_block.hpp), and compares them with a shape.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

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
  bool has_bias = false;              ///< the next is said
  Scalar bias_time_constants_s[4]{};  ///< sum by sum, of a bias learnt in flight; 0: none of this sum
  // In the block, or null; as BlockRecord describes them.
  const signed char* slope_signs = nullptr;
  const Scalar* residual_range = nullptr;
  const Scalar* distance = nullptr;
};

}  // namespace PINNQUAD_INSTRUCTION_SET

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// A text in the block. What flies asks std::string_view nothing: at -O0 its members are functions that translation
/// units of other instruction sets would share.
struct BlockText {
  const unsigned char* first = nullptr;
  std::size_t count = 0;

  operator std::string_view() const noexcept {
    return {static_cast<const char*>(static_cast<const void*>(first)), count};
  }
  bool is(const char* letters, std::size_t letter_count) const noexcept {
    return same_letters(letters, letter_count, first, count);
  }
};

/// All records of a block, in the block. A text or pointer that is null is not said.
template <class Scalar>
struct BlockRecords : ModelRecords<Scalar> {
  std::uint32_t window_taps = 1;
  std::uint32_t causal = 1;
  BlockText columns, base, answer, features, outputs, vehicle_name, provenance;
  const Scalar* allocation = nullptr;
  const unsigned char* airframe = nullptr;  ///< f64
  const Scalar* flown_airframe = nullptr;
  std::uint64_t contents_hash = 0;
  const unsigned char* trust = nullptr;        ///< five f64
  const unsigned char* certificate = nullptr;  ///< twelve f64
  const Scalar* affine = nullptr;
  std::uint32_t seen = 0;  ///< a bit per type

  constexpr bool said(BlockRecord record) const noexcept { return (seen >> static_cast<unsigned>(record) & 1u) != 0; }

  /// `block_corrupt` for a record of another length than its type has, and for numbers that are none.
  Status take(BlockRecord type, const unsigned char* bytes, std::uint32_t length, std::size_t inputs,
              std::size_t outputs_count) noexcept {
    const RecordLengths lengths =
        record_lengths(sizeof(Scalar), static_cast<std::uint32_t>(inputs), static_cast<std::uint32_t>(outputs_count));
    const std::uint32_t sized = lengths.of[static_cast<unsigned>(type)];
    if (sized != 0 && length != sized) return Status::block_corrupt;
    const auto* scalars = static_cast<const Scalar*>(static_cast<const void*>(bytes));  // at a multiple of 8
    const BlockText text{bytes, length};
    bool sound = true;
    switch (type) {
      case BlockRecord::commands: {
        const std::uint32_t meaning = read_u32(bytes);
        const Scalar* range = scalars + 8 / sizeof(Scalar);
        if (read_u32(bytes + 4) != 0 || !all_finite(range, 2) || !(range[0] <= range[1])) return Status::block_corrupt;
        if (meaning >= command_meaning_count) return Status::block_incompatible;
        this->stated = true;
        this->command_meaning = static_cast<CommandMeaning>(meaning);
        this->command_lower = range[0];
        this->command_upper = range[1];
        break;
      }
      case BlockRecord::clock: {
        constexpr std::uint32_t longest_ns = nanoseconds(longest_clock_s);
        this->sample_period_ns = read_u32(bytes);
        this->lag_removed_ns = read_u32(bytes + 4);
        sound = this->sample_period_ns <= longest_ns && this->lag_removed_ns <= longest_ns;
        break;
      }
      case BlockRecord::window:
        window_taps = read_u32(bytes);
        causal = read_u32(bytes + 4);
        break;
      case BlockRecord::columns: columns = text; break;
      case BlockRecord::allocation: allocation = scalars; break;
      case BlockRecord::base: base = text; break;
      case BlockRecord::verdict:
        this->has_verdict = true;
        this->worse_than_mean = (read_u32(bytes) & judged_bits(true, false)) != 0;
        this->beats_linear_regression = (read_u32(bytes) & judged_bits(false, true)) != 0;
        break;
      case BlockRecord::slope_signs:
        this->slope_signs = static_cast<const signed char*>(static_cast<const void*>(bytes));
        for (std::size_t i = 0; i < length; ++i) sound &= -1 <= this->slope_signs[i] && this->slope_signs[i] <= 1;
        break;
      case BlockRecord::residual_range:
        this->residual_range = scalars;
        sound = all_finite(scalars, static_cast<int>(2 * outputs_count));
        for (std::size_t i = 0; i < outputs_count; ++i) sound &= scalars[i] <= scalars[outputs_count + i];
        break;
      case BlockRecord::distance: {
        const std::size_t last = inputs + triangle(inputs);
        this->distance = scalars;
        sound = all_finite(scalars, static_cast<int>(last) + 1) && scalars[last] > Scalar(0);
        break;
      }
      case BlockRecord::answer: answer = text; break;
      case BlockRecord::features: features = text; break;
      case BlockRecord::outputs: outputs = text; break;
      case BlockRecord::vehicle: {
        constexpr std::size_t exact = airframe_number_count * 8, flown = airframe_number_count * sizeof(Scalar);
        if (length <= exact + flown) return Status::block_corrupt;
        airframe = bytes;
        flown_airframe = scalars + exact / sizeof(Scalar);
        vehicle_name = {bytes + exact + flown, length - exact - flown};
        break;
      }
      case BlockRecord::contents: contents_hash = read_u64(bytes); break;
      case BlockRecord::trust: trust = bytes; break;
      case BlockRecord::certificate: certificate = bytes; break;
      case BlockRecord::provenance: provenance = text; break;
      case BlockRecord::bias:
        this->has_bias = true;
        for (std::size_t i = 0; i < 4; ++i) this->bias_time_constants_s[i] = scalars[i];
        sound = are_bias_time_constants(scalars);
        break;
      case BlockRecord::affine:
        affine = scalars;
        sound = all_finite(scalars, static_cast<int>(length / sizeof(Scalar)));
        break;
    }
    return sound ? Status::ok : Status::block_corrupt;
  }
};

/// `first` is behind the fixed header, `available` the bytes from there to the checksum; `size` becomes those of the
/// records with their counts. `block_corrupt`: they do not fit there, or contradict themselves. `block_incompatible`: a
/// mandatory one is unknown.
template <class Scalar>
Status read_records(const unsigned char* first, std::size_t available, std::size_t inputs, std::size_t outputs,
                    BlockRecords<Scalar>& records, std::size_t& size) noexcept {
  using Header = ModelBlockHeader;
  if (available < Header::record_counts) return Status::block_corrupt;
  const std::uint32_t count = read_u32(first);
  const std::uint32_t bytes = read_u32(first + 4);
  if (bytes % 8 != 0 || bytes > available - Header::record_counts) return Status::block_corrupt;
  const unsigned char* at = first + Header::record_counts;
  std::size_t left = bytes;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (left < Header::record_head) return Status::block_corrupt;
    const std::uint32_t word = read_u32(at);
    const std::uint32_t length = read_u32(at + 4);
    if (word > 0xffff || length > left - Header::record_head) return Status::block_corrupt;
    const std::uint32_t type = word & (mandatory_record - 1u);
    if (type >= 1 && type <= block_record_types) {
      if ((records.seen >> type & 1u) != 0) return Status::block_corrupt;
      records.seen |= 1u << type;
      const Status status =
          records.take(static_cast<BlockRecord>(type), at + Header::record_head, length, inputs, outputs);
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
  return Status::ok;
}

/// Entries of a matrix that is stored row by row.
template <class Scalar>
struct RowMajorAllocation {
  const Scalar* first;
  constexpr Scalar operator()(std::size_t row, std::size_t column) const noexcept {
    return first[row * rotor_count + column];
  }
};

/// Compares the records of a block with a shape.
template <class Shape>
struct RecordReader {
  using Scalar = typename Shape::Scalar;
  using Records = ModelRecords<Scalar>;
  using Features = typename Shape::Features;
  using Outputs = typename Shape::Outputs;
  using Base = typename BaseOf<Outputs>::type;
  using Window = WindowOf<Features>;

  /// As read_records(); `block_incompatible` too where a record is missing that the shape asks for, or says another
  /// thing than the shape.
  static Status read(const unsigned char* first, std::size_t available, Records& records, std::size_t& size) noexcept {
    constexpr std::size_t inputs = std::size_t(Features::size), outputs = std::size_t(OutputMap<Outputs>::size);
    BlockRecords<Scalar> all;
    const Status status = read_records(first, available, inputs, outputs, all, size);
    if (status != Status::ok) return status;
    if (all.slope_signs != nullptr && !true_slope_signs(all.slope_signs)) return Status::block_corrupt;
    records = all;
    return fits(all) && fits_header(all) ? Status::ok : Status::block_incompatible;
  }

 private:
  static bool true_slope_signs(const signed char* stated) noexcept {
    constexpr TorqueSigns torque_signs = motor_torque_signs<typename Shape::Vehicle>();
    const int* own = first_of<int>(torque_signs);
    bool sound = true;
    if (StatedStructure<typename Shape::Network>::known) {
      for (int i = 0; i < 3 * rotor_count; ++i) sound &= true_slope_sign(stated[i], own[i]);
    }
    return sound;
  }

  /// No std::memcmp: a text that is not said is null.
  static bool same_start(const char* letters, const BlockText& text) noexcept {
    bool same = true;
    for (std::size_t i = 0; i < text.count; ++i) same &= letters[i] == static_cast<char>(text.first[i]);
    return same;
  }

  static bool fits(const BlockRecords<Scalar>& said) noexcept {
    constexpr bool has_base = !std::is_same_v<Base, NoBase>;
    constexpr std::uint32_t window_ns = nanoseconds(Window::period_s);
    constexpr auto columns = column_bytes<Features>();
    constexpr auto base = description_letters<Base>();
    constexpr AllocationMatrix<Scalar> expected = allocation(airframe_value<typename Shape::Vehicle, Scalar>());
    if (!said.said(BlockRecord::commands) || !said.said(BlockRecord::clock) || !said.said(BlockRecord::window)) {
      return false;
    }
    if (said.allocation == nullptr || (has_base && !said.said(BlockRecord::base))) return false;
    bool fits = said.window_taps == std::uint32_t(Window::taps) && said.causal == std::uint32_t(Window::causal);
    fits &= window_ns == 0 || same_period_ns(said.sample_period_ns, window_ns);
    fits &= said.columns.count == columns.count && same_start(&columns.text[0], said.columns);
    fits &= !said.said(BlockRecord::base) || said.base.is(&base.text[0], base.count);
    fits &= same_allocation<Scalar>(RowMajorAllocation<Scalar>{said.allocation},
                                    RowMajorAllocation<Scalar>{first_of<Scalar>(expected)});
    if (said.said(BlockRecord::answer)) {
      constexpr auto answer = description_letters<typename Shape::Network>();
      fits &= said.answer.is(&answer.text[0], answer.count);
    }
    return fits;
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
