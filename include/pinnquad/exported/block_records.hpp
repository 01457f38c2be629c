// SPDX-License-Identifier: MIT
// Reads the records of a model block (exported/model_block.hpp), compares them with a shape, and checks all that a
// block states beside it, for whoever opens it (exported/model_view.hpp, exported/run_time_model.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "pinnquad/core/finite.hpp"
#include "pinnquad/core/first_of.hpp"
#include "pinnquad/exported/model_block.hpp"

namespace pinnquad {

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
struct BlockRecords : ModelFacts {
  std::uint32_t sample_period_ns = 0;  ///< as the block has the times of its facts
  std::uint32_t lag_removed_ns = 0;
  std::uint32_t window_taps = 1;
  std::uint32_t causal = 1;
  BlockText columns, base, answer, features, outputs, vehicle_name, provenance;
  const Scalar* allocation = nullptr;
  const unsigned char* airframe = nullptr;  ///< f64
  const Scalar* flown_airframe = nullptr;
  const unsigned char* trust = nullptr;  ///< five f64
  const Scalar* affine = nullptr;
  std::uint32_t seen = 0;  ///< a bit per type
  StatedFault fault{};     ///< where take() refuses

  constexpr bool said(BlockRecord record) const noexcept { return (seen >> static_cast<unsigned>(record) & 1u) != 0; }
  /// Says all that a block must.
  constexpr bool describes_itself() const noexcept {
    constexpr BlockRecord must[] = {BlockRecord::commands,   BlockRecord::clock,  BlockRecord::window,
                                    BlockRecord::allocation, BlockRecord::answer, BlockRecord::features,
                                    BlockRecord::outputs,    BlockRecord::vehicle};
    bool all = true;
    for (const BlockRecord record : must) all = all && said(record);
    return all;
  }

  /// `block_corrupt` for a record of another length than its type has, and for numbers out of their range
  /// (exported/stated_numbers.hpp): `fault` says which.
  Status take(BlockRecord type, const unsigned char* bytes, std::uint32_t length, std::size_t inputs,
              std::size_t outputs_count) noexcept {
    const RecordLengths lengths =
        record_lengths(sizeof(Scalar), static_cast<std::uint32_t>(inputs), static_cast<std::uint32_t>(outputs_count));
    const std::uint32_t sized = lengths.of[static_cast<unsigned>(type)];
    fault = {StatedNumber::layout};
    if (sized != 0 && length != sized) return Status::block_corrupt;
    const auto* scalars = static_cast<const Scalar*>(static_cast<const void*>(bytes));  // at a multiple of 8
    const BlockText text{bytes, length};
    const FiniteNumber finite{};
    switch (type) {
      case BlockRecord::commands: {
        const std::uint32_t meaning = read_u32(bytes);
        const Scalar* range = scalars + 8 / sizeof(Scalar);
        if (read_u32(bytes + 4) != 0) return refuse(StatedNumber::command_meaning);
        if (meaning >= command_meaning_count) {
          fault = {StatedNumber::command_meaning};
          return Status::block_incompatible;
        }
        command_meaning = static_cast<CommandMeaning>(meaning);
        command_lower = static_cast<double>(range[0]);
        command_upper = static_cast<double>(range[1]);
        break;
      }
      case BlockRecord::clock:
        sample_period_ns = read_u32(bytes);
        lag_removed_ns = read_u32(bytes + 4);
        sample_period_s = seconds_of(sample_period_ns);
        lag_removed_s = seconds_of(lag_removed_ns);
        break;
      case BlockRecord::window:
        window_taps = read_u32(bytes);
        causal = read_u32(bytes + 4);
        if (window_taps < 1 || causal > 1) return refuse(StatedNumber::window);
        break;
      case BlockRecord::columns: columns = text; break;
      case BlockRecord::allocation: allocation = scalars; break;
      case BlockRecord::base: base = text; break;
      case BlockRecord::verdict: {
        const std::uint32_t bits = read_u32(bytes);
        if (bits > judged_bits(true, true) || read_u32(bytes + 4) != 0) return refuse(StatedNumber::verdict);
        has_verdict = true;
        worse_than_mean = (bits & judged_bits(true, false)) != 0;
        beats_linear_regression = (bits & judged_bits(false, true)) != 0;
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
      case BlockRecord::trust: {
        double limits[5];
        std::memcpy(static_cast<double*>(limits), bytes, sizeof limits);
        trust = bytes;
        fault = fault_of_trust(limits);
        if (fault.number != StatedNumber::none) return Status::block_corrupt;
        const Scalar* mean = scalars + 5 * sizeof(double) / sizeof(Scalar);
        if (!are_finite(finite, mean, inputs)) return refuse(StatedNumber::trust_mean);
        if (!is_triangle(mean + inputs, inputs)) return refuse(StatedNumber::trust_whitening);
        break;
      }
      case BlockRecord::provenance: {
        provenance = text;
        std::uint32_t ends = 0;
        for (std::uint32_t i = 0; i < length; ++i) ends += bytes[i] == 0 ? 1 : 0;
        if (ends % 2 != 0 || (length > 0 && bytes[length - 1] != 0)) return refuse(StatedNumber::words);
        break;
      }
      case BlockRecord::bias:
        has_bias = true;
        for (std::size_t i = 0; i < 4; ++i) bias_time_constants_s[i] = static_cast<double>(scalars[i]);
        break;
      case BlockRecord::affine:
        affine = scalars;
        if (!are_finite(finite, scalars, length / sizeof(Scalar))) return refuse(StatedNumber::affine);
        break;
    }
    fault = {};
    return Status::ok;
  }

 private:
  Status refuse(StatedNumber number, double value = 0) noexcept {
    fault = {number, value};
    return Status::block_corrupt;
  }
};

/// `first` is behind the fixed header, `available` the bytes from there to the checksum; `size` becomes those of the
/// records with their counts. `block_corrupt`: they do not fit there, or contradict themselves. `block_incompatible`: a
/// mandatory one is unknown.
template <class Scalar>
Status read_records(const unsigned char* first, std::size_t available, std::size_t inputs, std::size_t outputs,
                    BlockRecords<Scalar>& records, std::size_t& size) noexcept {
  using Header = ModelBlockHeader;
  records.fault = {StatedNumber::layout};
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
      records.fault = {StatedNumber::layout};
    } else if ((word & mandatory_record) != 0) {
      records.fault = {StatedNumber::unknown_record};
      return Status::block_incompatible;
    }
    const std::size_t whole = Header::record_head + Header::padded(length);  // both multiples of 8, as `left` is
    at += whole;
    left -= whole;
  }
  if (left != 0) return Status::block_corrupt;
  records.fault = fault_of(records, FiniteNumber{});
  if (records.fault.number != StatedNumber::none) return Status::block_corrupt;
  size = Header::record_counts + bytes;
  return Status::ok;
}

/// The scalars of a block, in the block.
template <class Scalar>
struct BlockNumbers {
  const Scalar* first = nullptr;
  std::size_t inputs = 0, outputs = 0, golden = 0, parameter_count = 0;

  Scales<Scalar> scales() const noexcept {
    const Scalar* output = first + 2 * inputs;
    const Scalar* envelope = output + 2 * outputs;
    return {first, first + inputs, output, output + outputs, envelope, envelope + inputs};
  }
  const Scalar* golden_features() const noexcept { return first + 4 * inputs + 2 * outputs; }
  const Scalar* golden_commands() const noexcept { return golden_features() + golden * inputs; }
  const Scalar* parameters() const noexcept { return golden_commands() + golden * rotor_count; }
};

/// The first fault of the numbers of a block whose records were read and fit its shape, and of its hash.
template <class Scalar>
StatedNumber fault_of_block(const unsigned char* block, const BlockRecords<Scalar>& said,
                            const BlockNumbers<Scalar>& numbers) noexcept {
  using Header = ModelBlockHeader;
  const Scales<Scalar> scales = numbers.scales();
  const std::size_t inputs = numbers.inputs;
  const Scalar* features = numbers.golden_features();
  const Scalar* commands = numbers.golden_commands();
  const StatedNumber fault = fault_of_numbers(
      FiniteNumber{}, scales, inputs, numbers.outputs, numbers.parameters(), numbers.parameter_count,
      [&](std::size_t i) { return features + i * inputs; }, [&](std::size_t i) { return commands + i * rotor_count; },
      numbers.golden);
  if (fault != StatedNumber::none) return fault;
  if (said.trust != nullptr) {
    const auto* mean = static_cast<const Scalar*>(static_cast<const void*>(said.trust + 5 * sizeof(double)));
    if (!inside_envelope(scales.lower, mean, scales.upper, inputs)) return StatedNumber::trust_mean;
  }
  const bool same = hash_of_block(block, read_u32(block + Header::length)) == read_u64(block + Header::own_hash);
  return same ? StatedNumber::none : StatedNumber::contents;
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
  using Features = typename Shape::Features;
  using Outputs = typename Shape::Outputs;
  using Base = typename BaseOf<Outputs>::type;
  using Window = WindowOf<Features>;

  /// As read_records(); `block_incompatible` too where a record is missing or says another thing than the shape.
  static Status read(const unsigned char* first, std::size_t available, BlockRecords<Scalar>& records,
                     std::size_t& size) noexcept {
    constexpr std::size_t inputs = std::size_t(Features::size), outputs = std::size_t(OutputMap<Outputs>::size);
    const Status status = read_records(first, available, inputs, outputs, records, size);
    if (status != Status::ok) return status;
    return records.describes_itself() && fits(records) && fits_header(records) ? Status::ok
                                                                               : Status::block_incompatible;
  }

 private:
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
    if (has_base && !said.said(BlockRecord::base)) return false;
    bool fits = said.window_taps == std::uint32_t(Window::taps) && said.causal == std::uint32_t(Window::causal);
    fits &= window_ns == 0 || same_period_ns(said.sample_period_ns, window_ns);
    fits &= said.columns.count == columns.count && same_start(&columns.text[0], said.columns);
    fits &= !said.said(BlockRecord::base) || said.base.is(&base.text[0], base.count);
    fits &= same_allocation<Scalar>(RowMajorAllocation<Scalar>{said.allocation},
                                    RowMajorAllocation<Scalar>{first_of<Scalar>(expected)});
    constexpr auto answer = description_letters<typename Shape::Network>();
    return fits && said.answer.is(&answer.text[0], answer.count);
  }

  /// Where the shape is an exported header: its commands mean the same, as often.
  static bool fits_header(const BlockRecords<Scalar>& records) noexcept {
    if constexpr (is_detected<DescriptionOf, Shape>) {
      constexpr std::uint32_t period = nanoseconds(Shape::sample_period_s);  // worked out by the compiler
      return records.command_meaning == Shape::command_meaning &&
             (period == 0 || same_period_ns(records.sample_period_ns, period));
    }
    return true;
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail
}  // namespace pinnquad
