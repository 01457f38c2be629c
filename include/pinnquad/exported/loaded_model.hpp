// SPDX-License-Identifier: MIT
// A model loaded from a block into memory of its own, arranged for the vector unit: the block may go afterwards.
// A value without heap; the place for it (a static, a slot of two) is the caller's.
#pragma once

#include "pinnquad/exported/model_view.hpp"
#include "pinnquad/nn/packed_network.hpp"

namespace pinnquad {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// Golden vectors that a LoadedModel keeps; `train` writes as many.
inline constexpr std::size_t loaded_golden_vectors = 8;

/// A model as `InverseDynamics` reads it, with weights of its own: as in the block, for batches and derivatives, and
/// packed for prediction where there is a vector unit. About as large as its weights, twice with a vector unit, so not
/// a thing for a small stack; with a vector unit it is aligned to 64 bytes, as a PackedNetwork is. As made, it
/// declines: its envelope is empty and its self test fails.
template <class ShapeType>
class LoadedModel : public detail::ModelScales<ShapeType> {
 public:
  static constexpr ModelKind kind = ModelKind::loaded;
  using Scales = detail::ModelScales<ShapeType>;
  using typename Scales::Features;
  using typename Scales::Network;
  using typename Scales::Scalar;

  /// Rows of scalars, up to loaded_golden_vectors of them. As made, one row of zeros.
  template <int Columns>
  class Rows {
   public:
    using value_type = std::array<Scalar, static_cast<std::size_t>(Columns)>;

    constexpr std::size_t size() const noexcept { return count_; }
    constexpr const value_type& operator[](std::size_t row) const noexcept { return rows_[row]; }

    /// Keeps the first rows of `source`, as many as there is room for.
    template <class Source>
    void copy(const Source& source) noexcept {
      count_ = source.size() < loaded_golden_vectors ? source.size() : loaded_golden_vectors;
      for (std::size_t row = 0; row < count_; ++row) rows_[row] = source[row];
    }

   private:
    value_type rows_[loaded_golden_vectors]{};
    std::size_t count_ = 1;
  };

  Rows<Features::size> golden_features{};
  Rows<rotor_count> golden_commands{};

  /// Copies a view that open() has filled, in place. `block_truncated` for a view of no block: nothing is changed then.
  /// Not to be called while another thread predicts with this model (examples/model_swap.cpp).
  Status load(const ModelView<ShapeType>& view) noexcept {
    if (view.parameters() == nullptr) return Status::block_truncated;
    static_cast<Scales&>(*this) = view;
    this->records.slope_signs = nullptr;  // these lie in the block, which may go
    this->records.residual_range = this->records.distance = nullptr;
    golden_features.copy(view.golden_features);
    golden_commands.copy(view.golden_commands);
    std::memcpy(&network_.parameters, view.parameters(), sizeof network_.parameters);
    if constexpr (packs) packed_.assign(view.parameters());
    return Status::ok;
  }

  /// The bare network, standardised in and out: the vector unit's kernel where there is one, else the portable one.
  PINNQUAD_ALWAYS_INLINE void forward(const Scalar* standardised, Scalar* outputs) const noexcept {
    if constexpr (packs) {
      packed_.forward(standardised, outputs);
    } else {
      network_.forward(standardised, outputs);
    }
  }

  /// The weights as in the block; zeros before load().
  const Scalar* parameters() const noexcept { return detail::first_of<Scalar>(network_.parameters); }

  /// The weights as the vector unit's kernel reads them; empty without a vector unit.
  const auto& packed() const noexcept { return packed_; }

 private:
  static constexpr bool packs = has_vector_unit<Scalar> && is_network<Network>;

  template <class Answer, bool Packs>
  struct PackedFor {
    struct type {};
  };
  template <class Answer>
  struct PackedFor<Answer, true> {
    using type = PackedNetwork<Answer>;
  };

  Network network_{};
  typename PackedFor<Network, packs>::type packed_{};
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad
