// SPDX-License-Identifier: MIT
// Blocks that lie under a right checksum, a row each: open() or the self test refuses each. They are written into a
// folder, for the program to refuse too.
//   lies_driver FOLDER
#include <cstdio>
#include <cstring>
#include <exception>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "models/near_ground_quadrotor.hpp"
#include "models/own_racer.hpp"
#include "pinnquad/deploy/weight_file.hpp"
#include "support/block_bytes.hpp"

namespace {

using namespace pinnquad;
using test::BlockBytes;

/// A block, and where its parts are.
template <class Model>
struct Edited {
  using Scalar = typename Model::Scalar;
  using Layout = ModelBlockLayout<Model>;
  static constexpr std::size_t golden = Model::golden_features.size();

  BlockBytes bytes{model_block<Model>()};

  /// Offset of a record's bytes.
  std::size_t record(BlockRecord type) const {
    std::size_t at = ModelBlockHeader::size + ModelBlockHeader::record_counts;
    while ((detail::read_u32(bytes.data() + at) & 0x7fffu) != static_cast<unsigned>(type)) {
      at += ModelBlockHeader::record_head + ModelBlockHeader::padded(detail::read_u32(bytes.data() + at + 4));
    }
    return at + ModelBlockHeader::record_head;
  }
  /// Multiplies scalars of a record, `first` bytes behind its begin.
  void scale_record(BlockRecord type, std::size_t first, std::size_t count, double factor) {
    for (std::size_t i = 0; i < count; ++i) {
      unsigned char* at = &bytes[record(type) + first + i * sizeof(Scalar)];
      Scalar value{};
      std::memcpy(&value, at, sizeof value);
      value = static_cast<Scalar>(static_cast<double>(value) * factor);
      std::memcpy(at, &value, sizeof value);
    }
  }
  void set_in_record(BlockRecord type, std::size_t offset, Scalar value) {
    std::memcpy(&bytes[record(type) + offset], &value, sizeof value);
  }
  void scale(std::size_t first, std::size_t count, double factor) {
    for (std::size_t i = first; i < first + count; ++i) {
      bytes.set_scalar(i, static_cast<Scalar>(static_cast<double>(bytes.template scalar<Scalar>(i)) * factor));
    }
  }
};

using Residual = Edited<NearGroundQuadModel>;
using Window = Edited<OwnRacer>;

template <class Block>
struct Lie {
  const char* name;
  std::function<void(Block&)> tell;
};

constexpr std::size_t first_parameter = Residual::Layout::parameters(Residual::golden);
constexpr std::size_t first_bound =
    first_parameter + std::size_t(detail::StatedStructure<NearGroundQuadModel::Network>::at);
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

const std::vector<Lie<Residual>> residual_lies = {
    {"bounds_of_residual_a_million_times", [](Residual& b) { b.scale(first_bound, 8, 1e6); }},
    {"slope_1e-45", [](Residual& b) { b.bytes.set_scalar(first_parameter + 1, 1e-45F); }},
    {"slope_0", [](Residual& b) { b.bytes.set_scalar(first_parameter + 1, 0.0F); }},
    {"slope_negative", [](Residual& b) { b.scale(first_parameter, 1, -1); }},
    {"other_frame",  // as the writer of a model in another frame would hash it
     [](Residual& b) {
       detail::Fnv1a fnv;
       for (std::size_t i = 0; i < 8; ++i) fnv.absorb(b.bytes[ModelBlockHeader::shape_hash + i]);
       fnv.absorb_text("body FLU, world ENU");
       for (std::size_t i = 0; i < 8; ++i) {
         b.bytes[ModelBlockHeader::shape_hash + i] = static_cast<unsigned char>(fnv.hash >> (8 * i));
       }
     }},
    {"lag_-3", [](Residual& b) { b.bytes.set_u32(b.record(BlockRecord::clock) + 4, 0U - 3U); }},
    {"lag_4.2_s", [](Residual& b) { b.bytes.set_u32(b.record(BlockRecord::clock) + 4, 4200000000U); }},
    {"envelope_reversed",
     [](Residual& b) {
       for (std::size_t i = 0; i < Residual::Layout::inputs; ++i) {
         const auto lower = b.bytes.scalar<float>(Residual::Layout::envelope_lower + i);
         const auto upper = b.bytes.scalar<float>(Residual::Layout::envelope_upper + i);
         b.bytes.set_scalar(Residual::Layout::envelope_lower + i, upper);
         b.bytes.set_scalar(Residual::Layout::envelope_upper + i, lower);
       }
     }},
    {"envelope_1e30", [](Residual& b) { b.bytes.set_scalar(Residual::Layout::envelope_upper + 4, 1e30F); }},
    {"envelope_about_nothing", [](Residual& b) { b.bytes.set_scalar(Residual::Layout::envelope_upper, -13.7F); }},
    {"golden_command_off", [](Residual& b) { b.scale(Residual::Layout::golden_commands(Residual::golden), 1, 1.001); }},
    {"golden_feature_nan",
     [](Residual& b) { b.bytes.set_scalar(Residual::Layout::golden_features + 3, not_a_number); }},
    {"parameter_edited", [](Residual& b) { b.scale(first_parameter + 3, 1, 1.05); }},
    {"input_spread_0", [](Residual& b) { b.bytes.set_scalar(Residual::Layout::input_deviation + 2, 0.0F); }},
    {"input_spread_negative", [](Residual& b) { b.scale(Residual::Layout::input_deviation + 2, 1, -1); }},
    {"output_spread_doubled", [](Residual& b) { b.scale(Residual::Layout::output_deviation, 4, 2); }},
    {"allocation_edited", [](Residual& b) { b.scale_record(BlockRecord::allocation, 4, 1, 1.00001); }},
    {"command_range_swapped",
     [](Residual& b) {
       b.set_in_record(BlockRecord::commands, 8, 1.0F);
       b.set_in_record(BlockRecord::commands, 12, 0.0F);
     }},
    {"window_of_three", [](Residual& b) { b.bytes.set_u32(b.record(BlockRecord::window), 3); }},
};

const std::vector<Lie<Window>> window_lies = {
    {"window_taps_changed", [](Window& b) { b.bytes.set_u32(b.record(BlockRecord::window), 3); }},
    {"window_not_causal", [](Window& b) { b.bytes.set_u32(b.record(BlockRecord::window) + 4, 0); }},
    {"period_of_another_window", [](Window& b) { b.bytes.set_u32(b.record(BlockRecord::clock), 20000000U); }},
    {"column_renamed", [](Window& b) { b.bytes[b.record(BlockRecord::columns)] ^= 1U; }},
};

template <class Model>
const char* said_of(const BlockBytes& bytes) {
  ModelView<Model> view;
  const Status opened = ModelView<Model>::open(bytes.data(), bytes.size(), view);
  if (opened != Status::ok) return "open";
  return self_test(InverseDynamics<ModelView<Model>>(view)) != Status::ok ? "self test" : nullptr;
}

/// The number of lies that were believed.
template <class Model>
int tell(const std::vector<Lie<Edited<Model>>>& lies, const std::string& folder) {
  int believed = said_of<Model>(Edited<Model>().bytes) != nullptr;  // the truth is
  for (const Lie<Edited<Model>>& lie : lies) {
    Edited<Model> edited;
    lie.tell(edited);
    edited.bytes.seal();
    const char* refused_by = said_of<Model>(edited.bytes);
    std::fprintf(stderr, "%-36s %s\n", lie.name, refused_by == nullptr ? "BELIEVED" : refused_by);
    believed += refused_by == nullptr;
    write_weight_file(folder + "/" + lie.name + ".block",
                      {edited.bytes.data(), edited.bytes.data() + edited.bytes.size()});
  }
  return believed;
}

}  // namespace

int main(int argument_count, char** arguments) {
  if (argument_count != 2) return 2;
  try {
    return tell<NearGroundQuadModel>(residual_lies, arguments[1]) + tell<OwnRacer>(window_lies, arguments[1]) == 0 ? 0
                                                                                                                   : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "lies_driver: %s\n", error.what());
    return 2;
  }
}
