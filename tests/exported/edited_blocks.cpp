// SPDX-License-Identifier: MIT
// A block that was edited under a right checksum is refused: a number out of its range by the name of its record,
// any other one by the block's hash. In flight it is a Status, and the view is untouched.
#include <doctest/doctest.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "../../examples/models/structured_quadrotor.hpp"
#include "models/own_racer.hpp"
#include "pinnquad/deploy/block_model.hpp"
#include "pinnquad/deploy/weight_file.hpp"
#include "pinnquad/exported/model_view.hpp"
#include "pinnquad/exported/run_time_model.hpp"
#include "support/block_bytes.hpp"
#include "support/drawn_model.hpp"

using namespace pinnquad;
using test::BlockBytes;
using test::find;
using test::Record;
using test::records_of;
using test::with_records;

namespace {

using Bytes = std::vector<unsigned char>;

/// Limits of trust of the shipped model, in its envelope.
struct SomeTrust {
  static constexpr auto distribution_mean = StructuredQuadModel::input.mean;
  static constexpr std::array<float, 190> whitening = [] {
    std::array<float, 190> numbers{};
    std::size_t at = 0;
    for (std::size_t column = 0; column < 19; at += 19 - column, ++column) numbers[at] = 1;
    return numbers;
  }();
  static constexpr double squared_distance_limit = 1000, command_residual_factor = 0.2, command_residual_limit = 0.02,
                          command_residual_cleared = 0.01, update_period_s = 0.05;
};

/// The shipped model with all records that it can have.
Bytes whole() {
  const Bytes block = model_block<StructuredQuadModel, SomeTrust>();
  std::vector<Record> records = records_of(block);
  const float times_s[4] = {0.2f, 0.3f, 0, 0.3f};
  Bytes bias(sizeof times_s);
  std::memcpy(bias.data(), times_s, sizeof times_s);
  records.push_back({static_cast<unsigned>(detail::BlockRecord::bias), bias});
  const BlockBytes made = with_records(block, records);
  return {made.data(), made.data() + made.size()};
}

/// One line of the program, "" for a block that it takes; `view` is as the compiled model has it.
std::string refusal(const BlockBytes& block) {
  ModelView<StructuredQuadModel> view;
  const Status status = ModelView<StructuredQuadModel>::open(block.data(), block.size(), view);
  CHECK((status == Status::ok) == (view.parameters() != nullptr));
  try {
    const BlockModel ground("edited.block", Bytes(block.data(), block.data() + block.size()));
  } catch (const InputError& error) {
    return error.what();
  }
  CHECK(status == Status::ok);
  return "";
}

template <class Value>
BlockBytes edited(const Bytes& block, detail::BlockRecord type, std::size_t at, Value value) {
  auto records = records_of(block);
  std::memcpy(find(records, type).bytes.data() + at, &value, sizeof value);
  BlockBytes made = with_records(block, records);
  return made;
}

}  // namespace

TEST_CASE("the shipped model with every record is taken") { CHECK(refusal(BlockBytes(whole())) == ""); }

TEST_CASE("a number of a record that no quadrotor has is refused by its name, though all hashes were made again") {
  const Bytes block = whole();
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const auto said = [&](const BlockBytes& other, const char* name) {
    const std::string line = refusal(other);
    CAPTURE(name);
    CAPTURE(line);
    CHECK(line.find(name) != std::string::npos);
    CHECK(line.find('\n') == std::string::npos);
  };
  for (const float value : {float(nan), float(infinity), -3.0f, 5.0f}) {
    said(edited(block, detail::BlockRecord::commands, 8, value), "record commands");
    said(edited(block, detail::BlockRecord::commands, 12, value), "record commands");
  }
  said(edited(block, detail::BlockRecord::clock, 0, std::uint32_t{1}), "record clock");
  said(edited(block, detail::BlockRecord::clock, 4, std::uint32_t{3999999999u}), "lag_removed_s");
  said(edited(block, detail::BlockRecord::window, 0, std::uint32_t{0}), "record window");
  said(edited(block, detail::BlockRecord::window, 4, std::uint32_t{2}), "record window");
  said(edited(block, detail::BlockRecord::verdict, 0, std::uint32_t{4}), "record verdict");
  said(edited(block, detail::BlockRecord::verdict, 0, std::uint32_t{3}), "R^2 bear out");
  const char* limits[] = {"squared_distance_limit", "command_residual_factor", "command_residual_limit",
                          "command_residual_cleared", "update_period_s"};
  for (std::size_t i = 0; i < 5; ++i) {
    for (const double value : {nan, infinity, -1.0, 0.0, 1e30}) {
      said(edited(block, detail::BlockRecord::trust, 8 * i, value), limits[i]);
    }
  }
  for (std::size_t i = 0; i < 19 + 190; ++i) {
    said(edited(block, detail::BlockRecord::trust, 40 + 4 * i, float(nan)), "record trust");
  }
  for (std::size_t i = 0; i < 4; ++i) {
    for (const float value : {float(nan), float(infinity), -0.2f, 0.0001f, 61.0f}) {
      said(edited(block, detail::BlockRecord::bias, 4 * i, value), "record bias");
    }
  }
}

/// Record and offset of each byte that a reader takes when a bit of it is another and the checksum was made again.
template <class Shape>
std::string taken(const Bytes& block) {
  using Header = detail::ModelBlockHeader;
  using Scalar = typename Shape::Scalar;
  std::string all;
  std::size_t record = 0, behind = Header::size + Header::record_counts;
  const std::size_t scalars = BlockBytes(block).scalars();
  BlockBytes other(block);
  const auto model = std::make_unique<RunTimeModel<Scalar>>();
  for (std::size_t i = 0; i < block.size() - Header::checksum_size; ++i) {
    if (i == behind && i < scalars) {
      record = i;
      behind += Header::record_head + Header::padded(detail::read_u32(block.data() + record + 4));
    }
    other[i] = static_cast<unsigned char>(block[i] ^ 1u << i % 8);
    other.seal_checksum();
    ModelView<Shape> view;
    std::string readers;
    if (ModelView<Shape>::open(other.data(), other.size(), view) == Status::ok) readers += " view";
    if (RunTimeModel<Scalar>::open(other.data(), other.size(), *model) == Status::ok) readers += " run time";
    try {
      const BlockModel ground("edited.block", Bytes(other.data(), other.data() + other.size()));
      readers += " ground";
    } catch (const InputError&) {
    }
    other[i] = block[i];
    if (readers.empty()) continue;
    const bool in_record = record != 0 && i < scalars;
    const unsigned type = in_record ? detail::read_u32(block.data() + record) & 0x7fffu : 0;
    all += std::to_string(type) + "+" + std::to_string(in_record ? i - record : i) + readers + "\n";
  }
  return all;
}

TEST_CASE("a bit of any byte: no reader takes the block, though its checksum was made again") {
  CHECK(taken<StructuredQuadModel>(whole()) == "");
  CHECK(taken<OwnRacer>(model_block<OwnRacer>()) == "");
  using Five = test::ModelOf<Network<float, InputSize<16>, Dense<5>>, PaperFeatures, test::FiveOutputs>;
  CHECK(taken<Five>(test::drawn_block(test::drawn_model<Five>(1))) == "");
}
