// SPDX-License-Identifier: MIT
// Two slots for models and one atomic pointer to the one that flies. The control thread never waits; another thread
// opens a block, tests the model and publishes it, or says why not and nothing changes.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "pinnquad/exported/model_view.hpp"
#include "pinnquad/inference/self_test.hpp"

namespace pinnquad::autopilot {

/// `Inverse`: an InverseDynamics of a ModelView. An accepted block must stay in place while its model flies.
/// The old slot is free once the control thread has said that it took the new one: it says so at each tick, and its
/// loads of one atomic never go back in time.
template <class Inverse>
class ModelSlots {
  using View = typename Inverse::Model;

 public:
  explicit ModelSlots(const typename Inverse::Guard& guard) noexcept
      : slots_{Inverse(View{}, guard), Inverse(View{}, guard)} {}

  /// Control thread, once per tick: the model of this tick; null before the first was accepted.
  const Inverse* take() noexcept {
    const Inverse* current = published_.load(std::memory_order_acquire);  // its numbers were written before
    taken_.store(current, std::memory_order_release);                     // reads of the other slot lie before this
    return current;
  }

  /// Control thread: the checksum of the block whose model take() gave, 0 for null.
  std::uint32_t checksum(const Inverse* taken) const noexcept {
    return taken == nullptr ? 0 : checksums_[taken == &slots_[0] ? 0 : 1];
  }

  /// The other thread. True once the control thread has taken the model accepted last: the block before it is free.
  bool settled() const noexcept {
    return taken_.load(std::memory_order_acquire) == published_.load(std::memory_order_relaxed);
  }

  /// The other thread. The Status of ModelView::open() or self_test(); `out_of_range` while not settled(): try again
  /// after the control thread's next tick; `block_incompatible` for other training data, where a hash is given.
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
    spare.set_model(view);
    checksums_[&spare == &slots_[0] ? 0 : 1] = checksum_of(block);
    const Status tested = self_test(spare);
    if (tested == Status::ok) published_.store(&spare, std::memory_order_release);
    return tested;
  }

 private:
  using Header = pinnquad::detail::ModelBlockHeader;
  static_assert(std::atomic<const Inverse*>::is_always_lock_free);

  /// Checksum of a block that was opened, so that its length is known.
  static std::uint32_t checksum_of(const void* block) noexcept {
    using pinnquad::detail::read_u32;
    const auto* bytes = static_cast<const unsigned char*>(block);
    return read_u32(bytes + read_u32(bytes + Header::length) - Header::checksum_size);
  }
  static std::uint64_t training_data_of(const void* block) noexcept {
    return pinnquad::detail::read_u64(static_cast<const unsigned char*>(block) + Header::training_data_hash);
  }

  Inverse slots_[2];
  std::uint32_t checksums_[2]{};  ///< written and read as the slots are
  std::atomic<const Inverse*> published_{nullptr};
  std::atomic<const Inverse*> taken_{nullptr};
};

}  // namespace pinnquad::autopilot
