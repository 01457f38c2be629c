// SPDX-License-Identifier: MIT
// libFuzzer target over the loader of model blocks: whatever the bytes, open() reads none beyond the block and leaves
// the view alone unless it accepts; what it accepts is sound, and can be flown and self-tested without a trap. The
// mutator makes most inputs pass the checksum, the magic and the shape: chance would not in a lifetime. Build and run:
// scripts/heavy/fuzz.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>

#include "fuzz/fuzzing.hpp"
#include "pinnquad/exported/model_view.hpp"
#include "pinnquad/inference/self_test.hpp"
#include "support/small_model_variants.hpp"

namespace {

using namespace pinnquad;
using pinnquad::test::DoubleModel;
using pinnquad::test::SmallModel;
using Header = detail::ModelBlockHeader;

using pinnquad_test::expect;
pinnquad_test::Tally tally;

/// Bytes in memory of their own, exactly as many as there are: the sanitizer sees a read past the end.
/// `offset` of them before: operator new aligns to 16, so that is the misalignment.
class Memory {
 public:
  Memory(const std::uint8_t* data, std::size_t size, std::size_t offset)
      : begin_(static_cast<unsigned char*>(std::malloc(size + offset == 0 ? 1 : size + offset))), offset_(offset) {
    expect(begin_ != nullptr, "memory");
    if (size > 0) std::memcpy(begin_ + offset, data, size);
  }
  ~Memory() { std::free(begin_); }
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;
  const unsigned char* block() const { return begin_ + offset_; }

 private:
  unsigned char* begin_;
  std::size_t offset_;
};

/// std::isfinite, and not the library's own test of the bits.
template <class Rows>
bool rows_finite(const Rows& rows) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (const auto v : rows[i]) {
      if (!std::isfinite(v)) return false;
    }
  }
  return true;
}

/// CRC-32 bit by bit, and not the library's own.
std::uint32_t plain_crc32(const unsigned char* bytes, std::size_t length) {
  std::uint32_t remainder = 0xffffffffu;
  for (std::size_t i = 0; i < length; ++i) {
    remainder ^= bytes[i];
    for (int bit = 0; bit < 8; ++bit) remainder = (remainder >> 1) ^ ((remainder & 1u) != 0 ? 0xedb88320u : 0u);
  }
  return ~remainder;
}

/// Bytes between header and scalars, by the counts that the block states.
std::size_t record_bytes(const unsigned char* block) {
  return detail::ModelBlockHeader::record_counts + detail::read_u32(block + Header::size + 4);
}

/// An accepted block, looked at again and flown.
template <class Shape, class Model>
void fly(const Model& model) {
  using Scalar = typename Shape::Scalar;
  using Inverse = InverseDynamics<Model>;
  const Inverse inverse(model);
  const Status tested = self_test(inverse);
  expect(tested == Status::ok || tested == Status::self_test_failed, "a self test passes or fails");
  for (std::size_t i = 0; i < std::min<std::size_t>(model.golden_features.size(), 8); ++i) {
    auto x = model.golden_features[i];
    const Scalar untouched = Scalar(-12345);
    Commands<Scalar> commands{untouched, untouched, untouched, untouched};
    const Status status = inverse.predict_features(x.data(), commands);
    for (const Scalar u : commands) {
      expect(status == Status::ok ? bool(std::isfinite(u)) : u == untouched, "commands are finite, or untouched");
    }
    expect(tested != Status::ok || status == Status::ok, "what passes its self test answers its golden vectors");
    x[i] = model.envelope_upper[i] + std::abs(model.envelope_upper[i]) + Scalar(1);
    expect(inverse.predict_features(x.data(), commands) == Status::outside_envelope, "the envelope holds");
  }
  MotionInputs<Scalar> inputs;
  Commands<Scalar> commands{};
  const Status status = inverse.predict(inputs, commands);
  expect(status == Status::ok || status == Status::outside_envelope || status == Status::output_not_finite,
         "hover is answered or declined");
}

template <class Shape>
void load(const std::uint8_t* data, std::size_t size) {
  using View = ModelView<Shape>;
  using Scalar = typename Shape::Scalar;
  for (const std::size_t offset : {1u, 2u, 4u, 7u}) {
    const Memory memory(data, size, offset);
    View view;
    expect(View::open(memory.block(), size, view) == Status::block_truncated, "misaligned is refused");
  }
  const Memory memory(data, size, 0);
  View view;
  view.input.mean[0] = Scalar(77);
  view.output.standard_deviation[3] = Scalar(78);
  view.envelope_lower[15] = Scalar(79);
  const Status status = View::open(memory.block(), size, view);
  ++tally.count[to_string(status)];
  if (status != Status::ok) {
    expect(status == Status::block_truncated || status == Status::block_incompatible || status == Status::block_corrupt,
           "a refusal says why");
    expect(view.parameters() == nullptr && view.golden_features.size() == 1 && view.input.mean[0] == Scalar(77) &&
               view.output.standard_deviation[3] == Scalar(78) && view.envelope_lower[15] == Scalar(79),
           "a refusal leaves the view alone");
    return;
  }
  const std::size_t length = detail::read_u32(memory.block() + Header::length);
  expect(length <= size &&
             length == ModelBlockLayout<Shape>::length(view.golden_features.size()) + record_bytes(memory.block()),
         "the length is right");
  expect(plain_crc32(memory.block(), length - 4) == detail::read_u32(memory.block() + length - 4),
         "the checksum is right");
  expect(std::memcmp(memory.block(), "PINNQUAD", 8) == 0 &&
             detail::read_u32(memory.block() + Header::version) == std::uint32_t{model_format_version},
         "it is a block of this format");
  const auto* begin = reinterpret_cast<const unsigned char*>(view.parameters());
  expect(begin >= memory.block() &&
             begin + sizeof(Scalar) * Shape::Network::parameter_count + Header::checksum_size <= memory.block() + size,
         "the weights lie in the block");
  for (std::size_t i = 0; i < static_cast<std::size_t>(Shape::Network::parameter_count); ++i) {
    expect(std::isfinite(view.parameters()[i]), "weights are finite");
  }
  for (std::size_t i = 0; i < view.input.mean.size(); ++i) {
    expect(std::isfinite(view.input.mean[i]) && std::isfinite(view.input.standard_deviation[i]) &&
               view.input.standard_deviation[i] > 0,
           "the input's scaler is sound");
    expect(std::isfinite(view.envelope_lower[i]) && std::isfinite(view.envelope_upper[i]) &&
               view.envelope_lower[i] <= view.envelope_upper[i],
           "the envelope is sound");
  }
  for (std::size_t i = 0; i < view.output.mean.size(); ++i) {
    expect(std::isfinite(view.output.mean[i]) && std::isfinite(view.output.standard_deviation[i]) &&
               view.output.standard_deviation[i] > 0,
           "the output's scaler is sound");
  }
  expect(view.golden_features.size() > 0 && view.golden_features.size() == view.golden_commands.size(),
         "golden vectors come in pairs");
  expect(rows_finite(view.golden_features) && rows_finite(view.golden_commands), "golden vectors are finite");
  fly<Shape>(view);
  static typename View::Packed packed;
  expect(View::open(memory.block(), size, view, packed) == Status::ok, "what opens is packed");
  fly<Shape>(view);
}

void write_u32(std::uint8_t* to, std::size_t value) {
  for (std::size_t byte = 0; byte < 4; ++byte) to[byte] = static_cast<std::uint8_t>((value >> (8 * byte)) & 0xffu);
}

/// The header of a block of `size` bytes for this shape, but for the golden count if it fits nothing.
template <class Shape>
void repair_header(std::uint8_t* data, std::size_t size) {
  using Layout = ModelBlockLayout<Shape>;
  std::copy(model_block_magic.begin(), model_block_magic.end(), data);
  write_u32(data + Header::version, model_format_version);
  write_u32(data + Header::scalar_bytes, sizeof(typename Shape::Scalar));
  write_u32(data + Header::inputs, Layout::inputs);
  write_u32(data + Header::outputs, Layout::outputs);
  write_u32(data + Header::parameters, Layout::parameter_count);
  write_u32(data + Header::shape_hash, shape_hash<Shape> & 0xffffffffu);
  write_u32(data + Header::shape_hash + 4, shape_hash<Shape> >> 32);
  const std::size_t row = sizeof(typename Shape::Scalar) * (Layout::inputs + Layout::outputs);
  const std::size_t records = size > Layout::length(0) ? record_bytes(data) : 0;
  const std::size_t others = Layout::length(0) + records;
  if (records < size && size > others) write_u32(data + Header::golden_vectors, (size - others) / row);
}

/// The greatest size not above `size` that a block of this shape with the records of these bytes can have.
template <class Shape>
std::size_t whole_rows(const std::uint8_t* data, std::size_t size) {
  using Layout = ModelBlockLayout<Shape>;
  const std::size_t row = Layout::length(1) - Layout::length(0);
  if (size < Layout::length(1) || record_bytes(data) > size - Layout::length(1)) return size;
  return size - (size - Layout::length(0) - record_bytes(data)) % row;
}

}  // namespace

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                               unsigned int seed) {
  std::minstd_rand engine(seed);
  size = LLVMFuzzerMutate(data, size, most);
  const bool is_double = size > 20 && data[Header::scalar_bytes] == sizeof(double);
  if (engine() % 4 != 0) size = is_double ? whole_rows<DoubleModel>(data, size) : whole_rows<SmallModel>(data, size);
  if (size < Header::size + Header::checksum_size) return size;
  if (engine() % 4 != 0) {
    if (is_double) {
      repair_header<DoubleModel>(data, size);
    } else {
      repair_header<SmallModel>(data, size);
    }
  }
  if (engine() % 8 != 0) write_u32(data + Header::length, size);
  if (engine() % 8 != 0) write_u32(data + size - 4, crc32(data, size - 4));
  return size;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  load<SmallModel>(data, size);
  load<DoubleModel>(data, size);
  return 0;
}
