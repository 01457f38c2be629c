// SPDX-License-Identifier: MIT
// A model whose weights lie in a memory block, checked when it is opened and read in place, or packed for the vector
// unit in memory of the caller's. The block must neither move nor change while a view of it is used.
#pragma once

#include <cstring>
#include <limits>

#include "pinnquad/core/finite.hpp"
#include "pinnquad/exported/block_records.hpp"
#include "pinnquad/exported/certificate.hpp"
#include "pinnquad/exported/model_block.hpp"
#include "pinnquad/model/predictor.hpp"

namespace pinnquad {

namespace detail {
template <class Scalar>
inline constexpr bool reads_in_place = __BYTE_ORDER__ ==
                                           __ORDER_LITTLE_ENDIAN__&& std::numeric_limits<Scalar>::is_iec559 &&
                                       (sizeof(Scalar) == 4 || sizeof(Scalar) == 8);

inline namespace PINNQUAD_INSTRUCTION_SET {

/// The members that a model has besides its weights. As made, the envelope is empty: every input lies outside.
template <class ShapeType>
struct ModelScales {
  using Shape = ShapeType;
  using Scalar = typename Shape::Scalar;
  using Network = typename Shape::Network;
  using Features = typename Shape::Features;
  using Outputs = typename Shape::Outputs;
  using Vehicle = typename Shape::Vehicle;
  static_assert(require_shape<Shape>());
  static_assert(reads_in_place<Scalar>,
                "pinnquad: a model block is read in place: float or double of IEEE 754, on a little-endian machine");
  using FeatureVector = std::array<Scalar, static_cast<std::size_t>(Features::size)>;

  Scaler<Scalar, Features::size> input{};
  Scaler<Scalar, OutputMap<Outputs>::size> output{};
  FeatureVector envelope_lower = ones<Scalar, Features::size>;
  FeatureVector envelope_upper{};
  std::uint64_t training_data_hash = 0;
  std::uint32_t training_rows = 0;
  ModelFacts facts{};
};

/// A predictor's weights as the vector unit's kernel reads them, and where a view finds them; nothing without a vector
/// unit, and for a predictor that it can't run.
template <class Answer, bool Packs = has_vector_unit<typename Answer::Scalar>&& is_packable<Answer>>
struct PackedWeights {
  static constexpr bool exist = true;
  using type = PackedPredictor<Answer>;
  const type* packed = nullptr;
};
template <class Answer>
struct PackedWeights<Answer, false> {
  static constexpr bool exist = false;
  struct type {};
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

inline namespace PINNQUAD_INSTRUCTION_SET {

/// A model as `InverseDynamics` reads it, for weights that stay in a block. `Shape` says what the block must hold: an
/// exported header, or any type with Scalar, Network, Features, Outputs and Vehicle.
/// Lifetime: scalers, envelope and facts are copied; weights and golden vectors are read in the block each time. A copy
/// of a view looks into the same block, and at the same packed weights. As made, a view declines: its envelope is
/// empty, its self test fails, forward() gives NaN.
template <class ShapeType>
class ModelView : public detail::ModelScales<ShapeType>, private detail::PackedWeights<typename ShapeType::Network> {
  using Place = detail::PackedWeights<typename ShapeType::Network>;

 public:
  static constexpr ModelKind kind = ModelKind::view;
  using Scales = detail::ModelScales<ShapeType>;
  using typename Scales::Features;
  using typename Scales::Network;
  using typename Scales::Scalar;
  /// Memory for the weights as the vector unit wants them: about as large as they are and aligned to 64 bytes; empty
  /// where there is no vector unit, and for a predictor that it can't run.
  using Packed = typename Place::type;

  /// Rows of scalars in the block. As made, one row of zeros.
  template <int Columns>
  struct Rows {
    using value_type = std::array<Scalar, static_cast<std::size_t>(Columns)>;

    const Scalar* first = nullptr;
    std::size_t count = 1;

    std::size_t size() const noexcept { return count; }
    /// A copy of a row.
    value_type operator[](std::size_t row) const noexcept {
      value_type result{};
      if (first != nullptr) std::memcpy(&result, first + row * std::size_t(Columns), sizeof result);
      return result;
    }
  };

  Rows<Features::size> golden_features{};
  Rows<rotor_count> golden_commands{};

  /// Makes `view` a view of the block of `length` bytes (or more) at `block`, a multiple of model_block_alignment.
  /// `block_truncated`: null, misaligned, or shorter than it says. `block_incompatible`: no block, of another format,
  /// for another shape, or with a mandatory record that is unknown. `block_corrupt`: wrong checksum, records that do
  /// not fit their place, no golden vector or one outside the envelope, a value that is NaN or Inf, a deviation that is
  /// not positive, an envelope upside down or out of reach, a time above 4 s, what is said twice and contradicts itself
  /// (exported/stated_bounds.hpp), a model of proven structure whose certificate its numbers don't fulfil. `view` is
  /// untouched unless the Status is ok. Reads the whole block, twice: not for a control loop.
  static Status open(const void* block, std::size_t length, ModelView& view) noexcept {
    using Layout = ModelBlockLayout<ShapeType>;
    using Header = detail::ModelBlockHeader;
    const auto* bytes = static_cast<const unsigned char*>(block);
    const Status checked = detail::check_block(
        bytes, length,
        {sizeof(Scalar), Layout::inputs, Layout::outputs, Layout::parameter_count, shape_hash<ShapeType>});
    if (checked != Status::ok) return checked;
    const std::size_t whole = detail::read_u32(bytes + Header::length);
    detail::BlockRecords<Scalar> records;
    std::size_t record_bytes = 0;
    const Status read = detail::RecordReader<ShapeType>::read(
        bytes + Header::size, whole - Header::size - Header::checksum_size, records, record_bytes);
    if (read != Status::ok) return read;
    const std::uint32_t golden = detail::read_u32(bytes + Header::golden_vectors);
    if (golden == 0 || Layout::length(golden) != whole - record_bytes) return Status::block_corrupt;
    // aligned, and of this scalar type: the header says so
    const auto* scalars = static_cast<const Scalar*>(static_cast<const void*>(bytes + Header::size + record_bytes));
    const detail::BlockNumbers<Scalar> numbers{scalars, Layout::inputs, Layout::outputs, golden,
                                               Layout::parameter_count};
    if (!sound(bytes, records, numbers)) return Status::block_corrupt;

    copy(scalars + Layout::input_mean, view.input.mean);
    copy(scalars + Layout::input_deviation, view.input.standard_deviation);
    copy(scalars + Layout::output_mean, view.output.mean);
    copy(scalars + Layout::output_deviation, view.output.standard_deviation);
    copy(scalars + Layout::envelope_lower, view.envelope_lower);
    copy(scalars + Layout::envelope_upper, view.envelope_upper);
    view.golden_features = {scalars + Layout::golden_features, golden};
    view.golden_commands = {scalars + Layout::golden_commands(golden), golden};
    view.parameters_ = scalars + Layout::parameters(golden);
    view.training_data_hash = detail::read_u64(bytes + Header::training_data_hash);
    view.training_rows = detail::read_u32(bytes + Header::training_rows);
    view.facts = records;
    if constexpr (Place::exist) view.Place::packed = nullptr;
    return Status::ok;
  }
  /// The same, and the weights are packed in `memory`, which then must neither move nor change either: predictions as
  /// fast as a header's, to its bits. Without it the portable kernel reads the block.
  static Status open(const void* block, std::size_t length, ModelView& view, Packed& memory) noexcept {
    const Status status = open(block, length, view);
    if constexpr (Place::exist) {
      if (status == Status::ok) {
        memory.assign(view.parameters_);
        view.Place::packed = &memory;
      }
    }
    return status;
  }

  /// The bare network, standardised in and out: the vector unit's kernel where the weights were packed, else the
  /// portable one.
  PINNQUAD_ALWAYS_INLINE void forward(const Scalar* standardised, Scalar* outputs) const noexcept {
    if (parameters_ == nullptr) {
      constexpr Scalar nothing = std::numeric_limits<Scalar>::quiet_NaN();
      for (int i = 0; i < Network::outputs; ++i) outputs[i] = nothing;
      return;
    }
    if constexpr (Place::exist) {
      if (Place::packed != nullptr) {
        return Place::packed->forward(standardised, outputs);
      }
    }
    Network::forward(parameters_, standardised, outputs);
  }

  /// The weights in the block, or null.
  const Scalar* parameters() const noexcept { return parameters_; }
  /// The packed weights, or null.
  const Packed* packed() const noexcept {
    if constexpr (Place::exist) {
      return Place::packed;
    } else {
      return nullptr;
    }
  }

 private:
  template <class Array>
  static void copy(const Scalar* from, Array& to) noexcept {
    std::memcpy(&to, from, sizeof to);
  }

  static bool sound(const unsigned char* block, const detail::BlockRecords<Scalar>& records,
                    const detail::BlockNumbers<Scalar>& numbers) noexcept {
    bool sound = detail::fault_of_block(block, records, numbers) == detail::StatedNumber::none;
    if constexpr (has_certificate<ShapeType>) {
      constexpr auto certified =
          detail::certified_vehicle<typename ShapeType::Outputs>(airframe_value<typename ShapeType::Vehicle, Scalar>());
      sound &= certificate_of<ShapeType>(certified, numbers.parameters(), numbers.scales()).proven();
    }
    return sound;
  }

  const Scalar* parameters_ = nullptr;
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad
