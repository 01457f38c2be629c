// SPDX-License-Identifier: MIT
// One check over all that a block states beside its shape, for whoever opens it (exported/model_view.hpp,
// exported/run_time_model.hpp): its numbers against each other, and two hashes, which are computed again from its own
// bytes: that of the header beside it, and one of all records. An edited block is refused, though its checksum was made
// again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "pinnquad/core/clock_time.hpp"
#include "pinnquad/exported/block_records.hpp"
#include "pinnquad/exported/contents_hash.hpp"
#include "pinnquad/exported/model.hpp"

namespace pinnquad {
namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// The fixed header and the scalars of a block, in the block.
template <class Scalar>
struct BlockNumbers {
  const Scalar* first = nullptr;
  std::size_t inputs = 0, outputs = 0, golden = 0, parameter_count = 0;
  std::uint32_t training_rows = 0;
  std::uint64_t training_data_hash = 0;

  Scales<Scalar> scales() const noexcept {
    const Scalar* output = first + 2 * inputs;
    const Scalar* envelope = output + 2 * outputs;
    return {first, first + inputs, output, output + outputs, envelope, envelope + inputs};
  }
  const Scalar* golden_features() const noexcept { return first + 4 * inputs + 2 * outputs; }
  const Scalar* golden_commands() const noexcept { return golden_features() + golden * inputs; }
  const Scalar* parameters() const noexcept { return golden_commands() + golden * rotor_count; }
};

/// A vehicle as a block's readers have it: row-major, of Airframe<double>. `signs`: motor_torque_signs().
struct BlockVehicle {
  const double* allocation;
  const int* signs;
};

/// Numbers of an airframe's record that are a Spin.
struct SpinPlaces {
  bool at[airframe_number_count]{};
};
constexpr SpinPlaces spin_places() noexcept {
  SpinPlaces places;
  const Airframe<double> any{};
  int i = 0;
  each_number(any, [&](const auto& number) { places.at[i++] = std::is_same_v<std::decay_t<decltype(number)>, Spin>; });
  return places;
}

/// The hash of a constant's name (exported/contents_hash.hpp), with which that of its value begins. For the compiler
/// alone.
constexpr std::uint64_t seed_of(std::string_view name) noexcept { return ConstantHash(name).value(); }

/// ConstantHash of values that are read when a program runs.
struct RunTimeHash {
  std::uint64_t hash;

  PINNQUAD_ALWAYS_INLINE void add_word(std::uint32_t word) noexcept { hash = (hash ^ word) * ConstantHash::prime; }
  PINNQUAD_ALWAYS_INLINE void add_long(std::uint64_t number) noexcept {
    add_word(static_cast<std::uint32_t>(number));
    add_word(static_cast<std::uint32_t>(number >> 32));
  }
  void add_bytes(const unsigned char* from, std::size_t words) noexcept {
    for (std::size_t i = 0; i < words; ++i) add_word(read_u32(from + 4 * i));
  }
  template <class Number>
  void add_numbers(const Number* from, std::size_t count) noexcept {
    add_bytes(static_cast<const unsigned char*>(static_cast<const void*>(from)), count * sizeof(Number) / 4);
  }
  void add_number(double number) noexcept { add_numbers(&number, 1); }
  void add_text(const BlockText& text) noexcept {
    for (std::size_t i = 0; i < text.count; ++i) add_word(text.first[i]);
    add_word(0x100);
  }
  /// Every second of texts that are each closed by a 0, from the first or the second on.
  void add_every_second(const BlockText& texts, unsigned first) noexcept {
    unsigned place = 0;
    for (std::size_t i = 0; i < texts.count; ++i) {
      const unsigned char letter = texts.first[i];
      if (place % 2 == first) add_word(letter == 0 ? 0x100u : letter);
      place += letter == 0 ? 1 : 0;
    }
  }
};

/// A hash over the bytes of all records, but for its own eight at `own`. contents_hash leaves out limits of trust,
/// bias, certificate, numbers of a schema, the airframe as it flies, provenance.
inline std::uint64_t hash_of_records(const unsigned char* first, std::size_t bytes, const unsigned char* own) noexcept {
  constexpr std::uint64_t seed = seed_of("block records");
  RunTimeHash hash{seed};
  const auto before = static_cast<std::size_t>(own - first);
  hash.add_bytes(first, before / 4);
  hash.add_bytes(own + 8, (bytes - before - 8) / 4);
  return hash.hash;
}

/// The hash of the header beside a block, of what the block says.
template <class Scalar>
class BlockContents {
 public:
  BlockContents(const BlockRecords<Scalar>& said, const BlockNumbers<Scalar>& numbers,
                const BlockVehicle& vehicle) noexcept
      : said_(said), numbers_(numbers), vehicle_(vehicle) {}

  /// Numbers of the header that the block rounds, where it states them: they round to those of the other records.
  bool rounds() const noexcept {
    if (said_.unrounded == nullptr) return true;
    const double period = unrounded(2), lag = unrounded(3);
    bool same = is_clock_time(period) && is_clock_time(lag) &&
                same_scalar(unrounded(0), static_cast<Scalar>(said_.command_lower)) &&
                same_scalar(unrounded(1), static_cast<Scalar>(said_.command_upper));
    same = same && nanoseconds(period) == said_.sample_period_ns && nanoseconds(lag) == said_.lag_removed_ns;
    for (std::size_t i = 0; i < allocation_size; ++i) same = same && same_scalar(unrounded(4 + i), said_.allocation[i]);
    return same;
  }

  std::uint64_t hash() const noexcept {
    constexpr std::uint64_t version = constant_hash("format_version", model_format_version);
    return version + of_description() + of_records();
  }

 private:
  static constexpr std::size_t allocation_size = std::size_t(4) * rotor_count;

  double unrounded(std::size_t place) const noexcept {
    double value = 0;
    std::memcpy(&value, said_.unrounded + 8 * place, sizeof value);
    return value;
  }
  static bool same_scalar(double value, Scalar rounded) noexcept {
    const auto own = static_cast<Scalar>(value);
    return is_finite(value) && own <= rounded && own >= rounded;
  }

  std::uint64_t of_description() const noexcept {
    constexpr std::uint64_t frame = constant_hash("frame", model_frame);
    constexpr std::uint64_t data = seed_of("training_data_hash"), rows = seed_of("training_rows"),
                            worse = seed_of("worse_than_mean"), beats = seed_of("beats_linear_regression"),
                            names = seed_of("feature_names"), units = seed_of("feature_units"),
                            outputs = seed_of("output_names"), output_units = seed_of("output_units"),
                            vehicle = seed_of("vehicle_name"), order = seed_of("motor_torque_signs"),
                            airframe = seed_of("Vehicle"), signs = seed_of("slope_signs"),
                            lower = seed_of("residual_lower"), upper = seed_of("residual_upper"),
                            input = seed_of("input"), output = seed_of("output"), least = seed_of("envelope_lower"),
                            most = seed_of("envelope_upper"), golden = seed_of("golden_features"),
                            commands = seed_of("golden_commands"), weights = seed_of("parameters");
    constexpr SpinPlaces spins = spin_places();
    const std::size_t inputs = numbers_.inputs, sums = numbers_.outputs;
    const Scales<Scalar> scales = numbers_.scales();
    const auto scalars = [](std::uint64_t seed, const Scalar* from, std::size_t count) {
      RunTimeHash hash{seed};
      hash.add_numbers(from, count);
      return hash.hash;
    };
    const auto every_second = [](std::uint64_t seed, const BlockText& texts, unsigned first) {
      RunTimeHash hash{seed};
      hash.add_every_second(texts, first);
      return hash.hash;
    };
    std::uint64_t sum = frame;
    RunTimeHash one{data};
    one.add_long(numbers_.training_data_hash);
    sum += one.hash;
    one = {rows};
    one.add_word(numbers_.training_rows);
    sum += one.hash;
    if (said_.has_verdict) {
      one = {worse};
      one.add_word(said_.worse_than_mean ? 1 : 0);
      sum += one.hash;
      one = {beats};
      one.add_word(said_.beats_linear_regression ? 1 : 0);
      sum += one.hash;
    }
    sum += every_second(names, said_.features, 0) + every_second(units, said_.features, 1);
    sum += every_second(outputs, output_texts(), 0) + every_second(output_units, output_texts(), 1);
    one = {vehicle};
    one.add_text(said_.vehicle_name);
    sum += one.hash;
    one = {order};
    for (int i = 0; i < 3 * rotor_count; ++i) one.add_word(static_cast<std::uint32_t>(vehicle_.signs[i]));
    sum += one.hash;
    one = {airframe};
    for (std::size_t i = 0; i < std::size_t(airframe_number_count); ++i) {
      const unsigned char* number = said_.airframe + 8 * i;
      if (spins.at[i]) {
        double spin = 0;
        std::memcpy(&spin, number, sizeof spin);
        one.add_word(spin < 0 ? 0xffffffffu : 1u);
      } else {
        one.add_bytes(number, 2);
      }
    }
    sum += one.hash;
    if (said_.slope_signs != nullptr) {
      one = {signs};
      for (int i = 0; i < 3 * rotor_count; ++i) {
        one.add_word(static_cast<std::uint32_t>(int{static_cast<signed char>(said_.slope_signs[i])}));
      }
      sum += one.hash;
    }
    if (said_.residual_range != nullptr) {
      sum += scalars(lower, said_.residual_range, sums) + scalars(upper, said_.residual_range + sums, sums);
    }
    sum += scalars(input, scales.input_mean, 2 * inputs) + scalars(output, scales.output_mean, 2 * sums);
    sum += scalars(least, scales.lower, inputs) + scalars(most, scales.upper, inputs);
    sum += scalars(golden, numbers_.golden_features(), numbers_.golden * inputs);
    sum += scalars(commands, numbers_.golden_commands(), numbers_.golden * rotor_count);
    return sum + scalars(weights, numbers_.parameters(), numbers_.parameter_count);
  }

  std::uint64_t of_records() const noexcept {
    constexpr std::uint64_t records = constant_hash("records", known_records);
    constexpr std::uint64_t meanings[] = {constant_hash("command_meaning", CommandMeaning::thrust),
                                          constant_hash("command_meaning", CommandMeaning::throttle),
                                          constant_hash("command_meaning", CommandMeaning::speed)};
    static_assert(sizeof meanings / sizeof meanings[0] == command_meaning_count);
    constexpr std::uint64_t answer = seed_of("answer"), lower = seed_of("command_lower"),
                            upper = seed_of("command_upper"), period = seed_of("sample_period_s"),
                            lag = seed_of("lag_removed_s"), taps = seed_of("window_taps"), causal = seed_of("causal"),
                            names = seed_of("column_names"), units = seed_of("column_units"),
                            allocation = seed_of("allocation"), base = seed_of("base");
    const bool stated = said_.unrounded != nullptr;
    const auto number = [](std::uint64_t seed, double value) {
      RunTimeHash hash{seed};
      hash.add_number(value);
      return hash.hash;
    };
    std::uint64_t sum = records + meanings[static_cast<unsigned>(said_.command_meaning)];
    sum += number(lower, stated ? unrounded(0) : said_.command_lower);
    sum += number(upper, stated ? unrounded(1) : said_.command_upper);
    sum += number(period, stated ? unrounded(2) : said_.sample_period_s);
    sum += number(lag, stated ? unrounded(3) : said_.lag_removed_s);
    RunTimeHash one{answer};
    one.add_text(said_.answer);
    sum += one.hash;
    one = {taps};
    one.add_word(said_.window_taps);
    sum += one.hash;
    one = {causal};
    one.add_word(said_.causal);
    sum += one.hash;
    one = {names};
    one.add_every_second(said_.columns, 0);
    sum += one.hash;
    one = {units};
    one.add_every_second(said_.columns, 1);
    sum += one.hash;
    one = {base};
    one.add_text(said_.base);
    sum += one.hash;
    one = {allocation};
    for (std::size_t i = 0; i < allocation_size; ++i) {
      const bool exact = sizeof(Scalar) == sizeof(double);
      const double own = exact ? static_cast<double>(said_.allocation[i]) : vehicle_.allocation[i];
      one.add_number(stated ? unrounded(4 + i) : own);
    }
    return sum + one.hash;
  }

  /// Names and units of the outputs, behind the schema's description.
  BlockText output_texts() const noexcept {
    std::size_t at = 0;
    while (at < said_.outputs.count && said_.outputs.first[at] != 0) ++at;
    if (at == said_.outputs.count) return {};
    return {said_.outputs.first + at + 1, said_.outputs.count - at - 1};
  }

  const BlockRecords<Scalar>& said_;
  const BlockNumbers<Scalar>& numbers_;
  const BlockVehicle& vehicle_;
};

/// The first fault of a block whose records were read and fit its shape.
template <class Scalar>
StatedNumber fault_of_block(const BlockRecords<Scalar>& said, const BlockNumbers<Scalar>& numbers,
                            const BlockVehicle& vehicle) noexcept {
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
  const BlockContents<Scalar> contents(said, numbers, vehicle);
  if (!contents.rounds()) return StatedNumber::unrounded;
  const unsigned char* own = said.records_hash;
  const bool same_records = own == nullptr || hash_of_records(said.whole, said.whole_bytes, own) == read_u64(own);
  return contents.hash() == said.contents_hash && same_records ? StatedNumber::none : StatedNumber::contents;
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail
}  // namespace pinnquad
