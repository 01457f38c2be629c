// SPDX-License-Identifier: MIT
// The model that flies and the place for the next one: two slots, one atomic pointer. The control thread never waits;
// another thread opens a block, tests the model and publishes it, or says why not and all stays as it was.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "pinnquad/exported/loaded_model.hpp"
#include "pinnquad/inference/self_test.hpp"

namespace pinnquad::autopilot {

/// `Inverse` is an InverseDynamics of a ModelView. A block that was accepted must stay where it is while its model
/// flies.
/// How the old slot is known to be unused: the control thread says at each tick which slot it took, and its loads of one
/// atomic never go back in time; once it has said the new one it will not read the old one again.
template <class Inverse>
class ModelSlots {
  using View = typename Inverse::Model;

 public:
  explicit ModelSlots(const typename Inverse::Guard& guard) noexcept
      : slots_{Inverse(View{}, guard), Inverse(View{}, guard)} {}

  /// Control thread, once per tick: the model of this tick, or null before the first was accepted.
  const Inverse* take() noexcept {
    const Inverse* current = published_.load(std::memory_order_acquire);  // its numbers were written before
    taken_.store(current, std::memory_order_release);                     // reads of the other slot lie before this
    return current;
  }

  /// Control thread: the checksum that the block of a model that take() gave has at its end, 0 for null.
  std::uint32_t checksum(const Inverse* taken) const noexcept {
    return taken == nullptr ? 0 : checksums_[taken == &slots_[0] ? 0 : 1];
  }

  /// The other thread. True once the control thread has taken the model accepted last: the block of the one before is
  /// unused.
  bool settled() const noexcept {
    return taken_.load(std::memory_order_acquire) == published_.load(std::memory_order_relaxed);
  }

  /// The other thread. What ModelView::open() and self_test() say of the block; `out_of_range` while not settled(): try
  /// again after the control thread's next tick; `block_incompatible` for other training data, where some are asked for.
  Status offer(const void* block, std::size_t length, const std::uint64_t* training_data_hash = nullptr) noexcept {
    if (!settled()) return Status::out_of_range;
    const Inverse* current = published_.load(std::memory_order_relaxed);  // only this thread writes it
    View view;
    const Status opened = View::open(block, length, view);
    if (opened != Status::ok) return opened;
    if (training_data_hash != nullptr && *training_data_hash != training_data_of(block)) {
      return Status::block_incompatible;
    }
    Inverse& spare = current == &slots_[0] ? slots_[1] : slots_[0];
    spare = Inverse(view, spare.guard());
    checksums_[&spare == &slots_[0] ? 0 : 1] = checksum_of(block);
    const Status tested = self_test(spare);
    if (tested == Status::ok) published_.store(&spare, std::memory_order_release);
    return tested;
  }

 private:
  static_assert(std::atomic<const Inverse*>::is_always_lock_free);

  /// Of a block that was opened: it says how long it is.
  static std::uint32_t checksum_of(const void* block) noexcept {
    using Header = ModelBlockHeader;
    return number(block, number(block, Header::length) - Header::checksum_size);
  }
  static std::uint64_t training_data_of(const void* block) noexcept {
    constexpr std::size_t at = ModelBlockHeader::training_data_hash;
    return std::uint64_t{number(block, at)} | std::uint64_t{number(block, at + 4)} << 32;
  }
  static std::uint32_t number(const void* block, std::size_t at) noexcept {
    const auto* bytes = static_cast<const unsigned char*>(block);
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;) value = (value << 8) | bytes[at + i];
    return value;
  }

  Inverse slots_[2];
  std::uint32_t checksums_[2]{};  ///< written and read as the slots are
  std::atomic<const Inverse*> published_{nullptr};
  std::atomic<const Inverse*> taken_{nullptr};
};

}  // namespace pinnquad::autopilot
