// SPDX-License-Identifier: MIT
// A model as its block describes it: any network, feature set, columns and outputs, of no type that the
// compiler has seen. It commands what the compiled model commands, to the bit of the portable kernel. The numbers stay
// in the block, which must neither move nor change; no heap: the caller owns the workspace.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "pinnquad/exported/block_records.hpp"
#include "pinnquad/exported/run_time_features.hpp"
#include "pinnquad/exported/run_time_network.hpp"
#include "pinnquad/exported/run_time_outputs.hpp"

namespace pinnquad {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// A model of a block that is known at run time alone: every layer, column and schema is as the block describes it.
template <class Scalar>
class RunTimeModel {
 public:
  template <class Number, int Count>
  using Values = RunTimeNetwork::Values<Number, Count>;
  using Records = detail::BlockRecords<Scalar>;
  using Layout = detail::ModelBlockHeader;
  /// In words, for a refusal on the ground.
  struct Fault {
    const char* expected = nullptr;
    const char* found = nullptr;  ///< "" where a number is
    double number = 0;
  };

  /// Makes `model` the model of the block of `length` bytes (or more) at `block`, a multiple of model_block_alignment.
  /// Statuses as ModelView::open(); `block_incompatible` too for a layer, column or schema that this library can't work
  /// out. Unless the Status is ok, `model` is of no use but for its fault(). Weights are not asked: see
  /// golden_difference().
  static Status open(const void* block, std::size_t length, RunTimeModel& model) noexcept {
    return model.read(static_cast<const unsigned char*>(block), length);
  }
  const Fault& fault() const noexcept { return fault_; }

  const RunTimeNetwork& network() const noexcept { return network_; }
  const RunTimeFeatures& features() const noexcept { return features_; }
  const RunTimeOutputs<Scalar>& outputs() const noexcept { return outputs_; }
  const Airframe<double>& airframe() const noexcept { return airframe_; }
  const Airframe<Scalar>& flown_airframe() const noexcept { return flown_; }
  const Records& records() const noexcept { return records_; }
  const detail::Scales<Scalar>& scales() const noexcept { return scales_; }
  const Scalar* parameters() const noexcept { return numbers_.parameters(); }
  int golden_count() const noexcept { return static_cast<int>(numbers_.golden); }
  const Scalar* golden_features(int vector) const noexcept {
    return numbers_.golden_features() + vector * features_.size();
  }
  const Scalar* golden_commands(int vector) const noexcept { return numbers_.golden_commands() + vector * rotor_count; }
  std::uint32_t training_rows() const noexcept { return detail::read_u32(block_ + Layout::training_rows); }
  std::uint64_t training_data_hash() const noexcept { return detail::read_u64(block_ + Layout::training_data_hash); }
  std::uint64_t shape_hash() const noexcept { return detail::read_u64(block_ + Layout::shape_hash); }
  /// As the header beside the block states it.
  std::uint64_t contents_hash() const noexcept { return detail::read_u64(block_ + Layout::contents_hash); }

  /// Entries of Scalar that commands() works in.
  std::size_t workspace() const noexcept {
    return std::size_t(features_.size()) + std::size_t(network_.outputs()) + network_.workspace();
  }

  /// Commands of features in physical units; the envelope is not looked at.
  void commands(const Scalar* x, Scalar* u, Scalar* work) const noexcept {
    commands<detail::RunTimeEntry::value_and_derivatives>(parameters(), x, u, work);
  }
  /// The same of parameters that lie as `Kind` wants them (run_time_row.hpp).
  template <detail::RunTimeEntry Kind>
  void commands(const Scalar* parameters, const Scalar* x, Scalar* u, Scalar* work) const noexcept {
    const auto size = std::size_t(features_.size());
    for (std::size_t i = 0; i < size; ++i) work[i] = (x[i] - scales_.input_mean[i]) / scales_.input_deviation[i];
    saturate_columns(work);
    answer<Kind>(parameters, x, work, u, work + size);
  }
  /// Answers features that the caller has standardised; `work` has network().outputs() and its workspace().
  void answer(const Scalar* x, const Scalar* standardised, Scalar* u, Scalar* work) const noexcept {
    answer<detail::RunTimeEntry::value_and_derivatives>(parameters(), x, standardised, u, work);
  }
  /// As the compiled model does: columns outside their range of the training rows are moved to its edge.
  void saturate_columns(Scalar* standardised) const noexcept {
    for (int i = 0; features_.column_count() > 0 && i < features_.size(); ++i) {
      if (features_.is_column(i)) standardised[i] = detail::saturated(scales_, i, standardised[i]);
    }
  }
  /// As InverseDynamics::inside_envelope().
  bool inside_envelope(const Scalar* x) const noexcept {
    bool inside = true;
    for (int i = 0; i < features_.size(); ++i) {
      inside &= features_.is_column(i) ? is_finite(x[i]) : scales_.lower[i] <= x[i] && x[i] <= scales_.upper[i];
    }
    return inside;
  }

  /// Largest difference of a golden command from what the weights make of its features; NaN where one is none.
  Scalar golden_difference(Scalar* work) const noexcept {
    Scalar largest(0);
    for (int vector = 0; vector < golden_count(); ++vector) {
      Scalar u[rotor_count];
      commands(golden_features(vector), static_cast<Scalar*>(u), work);
      for (int i = 0; i < rotor_count; ++i) {
        const Scalar difference = detail::absolute(u[i] - golden_commands(vector)[i]);
        if (!(difference <= largest)) largest = difference;
      }
    }
    return largest;
  }

  /// A word of the provenance, "" where the block has none of that name.
  std::string_view provenance(std::string_view wanted) const noexcept {
    std::string_view rest = records_.provenance, name, value;
    while (RunTimeFeatures::take_text(rest, name) && RunTimeFeatures::take_text(rest, value)) {
      if (name == wanted) return value;
    }
    return "";
  }
  /// Description, names and units of the outputs, as the block has them.
  std::string_view schema() const noexcept { return schema_; }
  detail::NameAndUnit output(int k) const noexcept {
    std::string_view rest = output_texts_;
    detail::NameAndUnit named;
    for (; k >= 0; --k) {
      RunTimeFeatures::take_text(rest, named.name);
      RunTimeFeatures::take_text(rest, named.unit);
    }
    return named;
  }

 private:
  template <detail::RunTimeEntry Kind>
  void answer(const Scalar* parameters, const Scalar* x, const Scalar* standardised, Scalar* u,
              Scalar* work) const noexcept {
    static_assert(sizeof(Values<Scalar, 1>) == sizeof(Scalar));
    using Entry = Values<Scalar, 1>;
    auto* made = reinterpret_cast<Entry*>(work);
    network_.template forward<Scalar, 1, Kind>(parameters, reinterpret_cast<const Entry*>(standardised), made,
                                               made + network_.outputs());
    for (int k = 0; k < network_.outputs(); ++k) {
      work[k] = work[k] * scales_.output_deviation[k] + scales_.output_mean[k];
    }
    outputs_.commands(x, work, u);
  }

  Status read(const unsigned char* block, std::size_t available) noexcept {
    const Status checked = detail::check_bytes(block, available);
    if (checked == Status::block_truncated) return refuse(checked, "a model block", "one that is cut short");
    if (checked == Status::block_corrupt) {
      return refuse(checked, "a model block", "one whose checksum does not hold");
    }
    if (checked != Status::ok) {
      if (!detail::has_magic(block)) return refuse(checked, "a model block", "another file");
      static_assert(model_format_version == 5);
      fault_ = {"format 5 of a model block (of another: train and export again)", "",
                static_cast<double>(detail::read_u32(block + Layout::version))};
      return checked;
    }
    if (detail::read_u32(block + Layout::scalar_bytes) != sizeof(Scalar)) {
      return refuse(Status::block_incompatible, "numbers of the size that is asked for", "others");
    }
    const std::size_t inputs = detail::read_u32(block + Layout::inputs);
    const std::size_t outputs = detail::read_u32(block + Layout::outputs);
    const std::size_t parameters = detail::read_u32(block + Layout::parameters);
    const std::size_t golden = detail::read_u32(block + Layout::golden_vectors);
    const std::size_t length = detail::read_u32(block + Layout::length);
    if (inputs < 1 || inputs > std::size_t(RunTimeFeatures::most_features) || outputs < 1 ||
        outputs > std::size_t(RunTimeOutputs<Scalar>::most_outputs) || golden < 1 || golden > length ||
        parameters > length) {
      return refuse(Status::block_corrupt, "counts that fit its length, and at most 512 features and 16 outputs",
                    "others");
    }
    records_ = {};
    std::size_t record_bytes = 0;
    const std::size_t behind = length - Layout::size - Layout::checksum_size;
    const Status read =
        detail::read_records<Scalar>(block + Layout::size, behind, inputs, outputs, records_, record_bytes);
    if (read != Status::ok) return refuse(read, records_.fault);
    const std::uint64_t scalars =
        4 * inputs + 2 * outputs + std::uint64_t{golden} * (inputs + rotor_count) + parameters;  // must not wrap around
    if (behind - record_bytes != scalars * sizeof(Scalar)) {
      return refuse(Status::block_corrupt, "counts that fit its length", "others");
    }
    numbers_ = {static_cast<const Scalar*>(static_cast<const void*>(block + Layout::size + record_bytes)), inputs,
                outputs, golden, parameters};
    scales_ = numbers_.scales();
    block_ = block;
    const Status described = describe(inputs, outputs, parameters);
    if (described != Status::ok) return described;
    const detail::StatedNumber number = detail::fault_of_block(block, records_, numbers_);
    return number == detail::StatedNumber::none ? Status::ok
                                                : refuse(Status::block_corrupt, detail::StatedFault{number});
  }

  Status refuse(Status status, const char* expected, const char* found) noexcept {
    fault_ = {expected, found};
    return status;
  }
  Status refuse(Status status, const detail::StatedFault& stated) noexcept {
    const detail::StatedRange& range = detail::stated_ranges[static_cast<std::size_t>(stated.number)];
    fault_ = {range.expected, range.found, stated.value};
    return status;
  }

  /// Takes the description apart and compares what it says twice.
  Status describe(std::size_t inputs, std::size_t outputs, std::size_t parameters) noexcept {
    const auto incompatible = [this](const char* expected, const char* found) {
      return refuse(Status::block_incompatible, expected, found);
    };
    const auto corrupt = [this](const char* expected, const char* found) {
      return refuse(Status::block_corrupt, expected, found);
    };
    if (!records_.describes_itself()) return corrupt("all records of a block that describes itself", "one less");
    if (!network_.parse(records_.answer)) {
      return incompatible("a network of dense layers and known activations, or a monotone model of one", "another");
    }
    if (network_.inputs() != int(inputs) || network_.outputs() != int(outputs) ||
        network_.parameter_count() != int(parameters) || network_.is_double() != (sizeof(Scalar) == 8)) {
      return corrupt("a description of its inputs, outputs and parameters", "one of others");
    }
    const RunTimeFeatures::Window window(static_cast<int>(records_.window_taps < 65 ? records_.window_taps : 65),
                                         records_.causal != 0, detail::seconds_of(records_.sample_period_ns));
    if (window.taps > 1 && !window.causal && window.taps % 2 == 0)
      return corrupt("an odd centred window", "an even one");
    if (!features_.read(records_.features, int(inputs), window)) {
      return corrupt("names and units of its features", "others, or some that its window has not");
    }
    if (!asks_for_columns()) return incompatible("columns by names that are no feature's of the library", "another");
    if (window.taps > 1 && records_.sample_period_ns == 0) return corrupt("the period of its window", "none");
    if (!take_vehicle()) return corrupt("an airframe that can fly, said twice alike", "another");
    if (!take_outputs(int(outputs))) return incompatible("an output schema that is known, or linear", "another");
    const auto own = allocation(flown_);
    const auto expected = [&own](std::size_t row, std::size_t column) { return own[row][column]; };
    if (!detail::same_allocation<Scalar>(detail::RowMajorAllocation<Scalar>{records_.allocation}, expected)) {
      return corrupt("the allocation of its airframe", "another");
    }
    return own_shape_hash() == shape_hash() ? Status::ok
                                            : corrupt("a description that its shape's hash is of", "another");
  }

  /// True where each column that it says is one: a column may have the name of what is worked out from the motion.
  bool asks_for_columns() const noexcept {
    std::string_view rest = records_.columns;
    bool asked = true;
    while (asked && !rest.empty()) {
      detail::NameAndUnit said;
      asked = RunTimeFeatures::take_text(rest, said.name) && RunTimeFeatures::take_text(rest, said.unit);
      int column = 0;
      while (column < features_.column_count() && features_.column(column).name != said.name) ++column;
      asked = asked && column < features_.column_count() && features_.column(column).unit == said.unit;
    }
    return asked;
  }

  bool take_vehicle() noexcept {
    const unsigned char* exact = records_.airframe;
    const Scalar* flown = records_.flown_airframe;
    bool sound = true;
    const auto take = [&sound](auto& number, auto value) {
      if constexpr (std::is_same_v<std::decay_t<decltype(number)>, Spin>) {
        sound &= detail::equal(detail::absolute(value), decltype(value)(1));
        number = value < 0 ? Spin::clockwise : Spin::counter_clockwise;
      } else {
        number = value;
      }
    };
    each_number(airframe_, [&](auto& number) {
      double value = 0;
      std::memcpy(&value, exact, sizeof value);
      exact += sizeof value;
      const double rounding = detail::absolute(value - static_cast<double>(*flown++));  // NaN where one is none
      sound &= rounding <= 1e-5 * detail::absolute(value);
      take(number, value);
    });
    flown = records_.flown_airframe;
    each_number(flown_, [&](auto& number) { take(number, *flown++); });
    return sound && check_airframe(airframe_) == Status::ok && Rotors<double>(airframe_).status() == Status::ok &&
           check_airframe(flown_) == Status::ok && Rotors<Scalar>(flown_).status() == Status::ok;
  }

  bool take_outputs(int count) noexcept {
    std::string_view rest = records_.outputs;
    if (!RunTimeFeatures::take_text(rest, schema_)) return false;
    output_texts_ = rest;
    if (!outputs_.find(schema_)) {
      if (records_.affine == nullptr) return false;
      outputs_.take_affine(records_.affine, count);
    }
    if (outputs_.size() != count) return false;
    for (int k = 0; k < count; ++k) {
      detail::NameAndUnit named;
      if (!RunTimeFeatures::take_text(rest, named.name) || !RunTimeFeatures::take_text(rest, named.unit)) return false;
      if (!outputs_.has(k, named.name, named.unit)) return false;
    }
    bool same_base = true;
    outputs_.with_base([&](auto base) { same_base = detail::describes<decltype(base)>(records_.base); });
    const bool reads = outputs_.reads_its_features(
        features_.size(), [this](int i) { return features_[i].name; }, [this](int i) { return features_[i].unit; });
    outputs_.prepare(flown_);
    return rest.empty() && same_base && reads;
  }

  /// As detail::hash_of_shape().
  std::uint64_t own_shape_hash() const noexcept {
    detail::Fnv1a fnv;
    fnv.absorb_text(records_.answer);
    detail::absorb_shape(
        fnv, std::size_t(features_.size()), [this](std::size_t i) { return features_[int(i)]; },
        std::size_t(outputs_.size()), [this](std::size_t k) { return output(int(k)); }, records_.vehicle_name,
        motor_torque_signs(airframe_));
    return fnv.hash;
  }

  RunTimeNetwork network_;
  RunTimeFeatures features_;
  RunTimeOutputs<Scalar> outputs_;
  Records records_;
  Airframe<double> airframe_;
  Airframe<Scalar> flown_;
  Fault fault_;
  std::string_view schema_, output_texts_;
  detail::BlockNumbers<Scalar> numbers_;
  detail::Scales<Scalar> scales_{};
  const unsigned char* block_ = nullptr;
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad
