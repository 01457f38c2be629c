// SPDX-License-Identifier: MIT
// Values whose end is the end of a page, with nothing readable behind it: one scalar too far is a segmentation fault,
// which doctest reports, at any optimisation and in code that no sanitizer sees.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <memory>
#include <new>

namespace pinnquad::test {

/// `count` values; their first one is aligned as far as the size of a value is.
template <class Value>
class EndOfPage {
 public:
  explicit EndOfPage(std::size_t count) : count_(count) {
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    const std::size_t used = (count * sizeof(Value) + page - 1) / page * page;
    bytes_ = used + page;
    pages_ = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (pages_ == MAP_FAILED) throw std::bad_alloc();
    auto* const end = static_cast<unsigned char*>(pages_) + used;
    if (mprotect(end, page, PROT_NONE) != 0) {
      munmap(pages_, bytes_);
      throw std::bad_alloc();
    }
    first_ = new (end - count * sizeof(Value)) Value();
    std::uninitialized_value_construct_n(first_ + 1, count - 1);
  }
  ~EndOfPage() {
    std::destroy_n(first_, count_);
    munmap(pages_, bytes_);
  }
  EndOfPage(const EndOfPage&) = delete;
  EndOfPage& operator=(const EndOfPage&) = delete;

  Value* data() noexcept { return first_; }
  const Value* data() const noexcept { return first_; }
  Value* begin() noexcept { return first_; }
  Value* end() noexcept { return first_ + count_; }
  const Value* begin() const noexcept { return first_; }
  const Value* end() const noexcept { return first_ + count_; }

 private:
  std::size_t count_;
  std::size_t bytes_ = 0;
  void* pages_ = nullptr;
  Value* first_ = nullptr;
};

}  // namespace pinnquad::test
