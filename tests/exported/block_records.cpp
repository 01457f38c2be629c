// SPDX-License-Identifier: MIT
// The records of a block: read back, refused where they say another thing than the shape, skipped where unknown
// and optional; whatever their bytes are, none beyond the block is read and a refused block leaves the view as it was.
#include "pinnquad/exported/block_records.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "pinnquad/control/motion_bias.hpp"
#include "pinnquad/deploy/weight_file.hpp"
#include "pinnquad/exported/model_view.hpp"
#include "pinnquad/features/windowed.hpp"
#include "pinnquad/inference/self_test.hpp"
#include "pinnquad/outputs/residual_outputs.hpp"
#include "support/block_bytes.hpp"
#include "support/recorded_model.hpp"

using namespace pinnquad;
using pinnquad::test::BlockBytes;
using pinnquad::test::find;
using pinnquad::test::Record;
using pinnquad::test::RecordedModel;
using pinnquad::test::records_of;
using pinnquad::test::SmallModel;
using pinnquad::test::with_records;

namespace {

using Bytes = std::vector<unsigned char>;

template <class Shape>
Status opened(const BlockBytes& block, ModelView<Shape>& view) {
  const ModelView<Shape> before = view;
  const Status status = ModelView<Shape>::open(block.data(), block.size(), view);
  if (status != Status::ok) {
    CHECK(view.parameters() == before.parameters());
    CHECK(view.facts.command_upper == before.facts.command_upper);
    CHECK(view.facts.sample_period_s == before.facts.sample_period_s);
    CHECK(view.facts.has_verdict == before.facts.has_verdict);
    CHECK(view.input.mean == before.input.mean);
  }
  return status;
}
template <class Shape>
Status opened(const BlockBytes& block) {
  ModelView<Shape> view;
  return opened(block, view);
}

/// A shape without weights.
struct BareShape {
  using Scalar = float;
  using Network = SmallModel::Network;
  using Features = PaperFeatures;
  using Outputs = CommandOutputs;
  using Vehicle = PaperQuadrotor;
};

}  // namespace

TEST_CASE("terms are read back from a block") {
  const BlockBytes block(model_block<RecordedModel>());
  ModelView<RecordedModel> view;
  REQUIRE(opened(block, view) == Status::ok);
  CHECK(view.facts.command_meaning == CommandMeaning::thrust);
  CHECK(view.facts.command_lower == 0);
  CHECK(view.facts.command_upper == 1);
  CHECK(view.facts.sample_period_s == 0.004);
  CHECK(view.facts.lag_removed_s == 0.0125);
  CHECK_FALSE(view.facts.has_verdict);
}

TEST_CASE("a block of other terms than its header's does not open; a shape without weights takes any") {
  const Bytes bytes = model_block<RecordedModel>();
  const BlockBytes recorded(bytes);
  const BlockBytes described(model_block<SmallModel>());
  CHECK(opened<BareShape>(recorded) == Status::ok);
  CHECK(opened<BareShape>(described) == Status::ok);
  // its period is not said
  CHECK(opened<RecordedModel>(described) == Status::block_incompatible);
  const auto with_commands = [&](CommandMeaning meaning, std::uint32_t period_ns) {
    auto records = records_of(bytes);
    find(records, detail::BlockRecord::commands).bytes[0] = static_cast<unsigned char>(meaning);
    for (std::size_t i = 0; i < 4; ++i) {
      find(records, detail::BlockRecord::clock).bytes[i] = static_cast<unsigned char>(period_ns >> (8 * i));
    }
    return with_records(bytes, records);
  };
  CHECK(opened<RecordedModel>(with_commands(CommandMeaning::thrust, 4000000)) == Status::ok);
  CHECK(opened<RecordedModel>(with_commands(CommandMeaning::thrust, 4030000)) == Status::ok);
  CHECK(opened<RecordedModel>(with_commands(CommandMeaning::thrust, 4100000)) == Status::block_incompatible);
  CHECK(opened<RecordedModel>(with_commands(CommandMeaning::throttle, 4000000)) == Status::block_incompatible);
}

TEST_CASE("what a shape's hash does not cover can't be left unsaid, and nothing is said twice") {
  const Bytes block = model_block<RecordedModel>();
  const auto sound = records_of(block);
  // commands, clock, window, allocation; answer, features, outputs, vehicle, provenance
  REQUIRE(sound.size() == 9);
  for (std::size_t i = 0; i < sound.size(); ++i) {
    CHECK((sound[i].type >= detail::mandatory_record) == (i < 8));
    auto records = sound;
    records.erase(records.begin() + static_cast<std::ptrdiff_t>(i));
    CHECK(opened<RecordedModel>(with_records(block, records)) == (i < 8 ? Status::block_incompatible : Status::ok));
    records = sound;
    records.push_back(sound[i]);
    CHECK(opened<RecordedModel>(with_records(block, records)) == Status::block_corrupt);
  }
}

namespace {

/// Of a record that is a few bytes longer or shorter than it should be. Texts have no length of their own: a shape says
/// the predictor, and its hash says names and units.
Status with_other_length(unsigned type) {
  switch (static_cast<detail::BlockRecord>(type & 0x7fffu)) {
    case detail::BlockRecord::answer: return Status::block_incompatible;
    case detail::BlockRecord::features:
    case detail::BlockRecord::outputs:
    case detail::BlockRecord::vehicle: return Status::ok;
    default: return Status::block_corrupt;
  }
}

}  // namespace

TEST_CASE("a record of another length is corrupt, and so are counts that do not add up") {
  const Bytes block = model_block<RecordedModel>();
  for (std::size_t i = 0; i + 1 < records_of(block).size(); ++i) {  // the last is the provenance, of texts in turn
    for (const int change : {-1, 1, 4, 8}) {
      auto records = records_of(block);
      records[i].bytes.resize(static_cast<std::size_t>(static_cast<int>(records[i].bytes.size()) + change), 0);
      CHECK(opened<RecordedModel>(with_records(block, records)) == with_other_length(records[i].type));
    }
  }
  for (const std::size_t length : {std::size_t{0}, std::size_t{8}, airframe_number_count * (8 + sizeof(float))}) {
    auto records = records_of(block);
    find(records, detail::BlockRecord::vehicle).bytes.resize(length);  // without all of its name
    CHECK(opened<RecordedModel>(with_records(block, records)) == Status::block_corrupt);
  }
  const std::size_t counts = detail::ModelBlockHeader::size;
  const auto changed = [&](std::size_t offset, std::uint32_t value) {
    BlockBytes other(block);
    other.set_u32(offset, value);
    other.seal();
    return opened<RecordedModel>(other);
  };
  const std::uint32_t bytes = detail::read_u32(block.data() + counts + 4);
  for (const std::uint32_t value : {0u, 3u, 5u, 6u, 0x80000000u, 0xffffffffu}) {
    CHECK(changed(counts, value) == Status::block_corrupt);
  }
  for (const std::uint32_t value :
       {0u, 7u, bytes - 8, bytes - 1, bytes + 1, bytes + 8, 0x80000000u, 0xfffffff8u, 0xffffffffu}) {
    CHECK(changed(counts + 4, value) == Status::block_corrupt);
  }
  for (const std::uint32_t value : {0u, 1u, 15u, 17u, 100000u, 0x7ffffff8u, 0xfffffff8u, 0xffffffffu}) {
    CHECK(changed(counts + 12, value) == Status::block_corrupt);  // length of the first record
  }
  // a record that is skipped, whose length leaves the records or the block
  auto records = records_of(block);
  records.insert(records.begin(), Record{77, Bytes(8, 0)});
  for (const std::uint32_t value : {bytes + 8, bytes + 16, 100000u, 0x7ffffff8u, 0xfffffff0u, 0xffffffffu}) {
    BlockBytes other = with_records(block, records);
    other.set_u32(counts + 12, value);
    other.seal();
    CHECK(opened<RecordedModel>(other) == Status::block_corrupt);
  }
  CHECK(changed(counts + 8, 0x18001u) == Status::block_corrupt);  // the word behind a type is 0
}

TEST_CASE("a record that says another thing than the shape is refused") {
  const Bytes block = model_block<RecordedModel>();
  const auto changed = [&](detail::BlockRecord type, std::size_t at, const auto value) {
    auto records = records_of(block);
    std::memcpy(find(records, type).bytes.data() + at, &value, sizeof value);
    return opened<RecordedModel>(with_records(block, records));
  };
  CHECK(changed(detail::BlockRecord::commands, 0, std::uint32_t{0}) == Status::ok);
  CHECK(changed(detail::BlockRecord::commands, 0, std::uint32_t{1}) == Status::block_incompatible);
  CHECK(changed(detail::BlockRecord::commands, 0, std::uint32_t{3}) == Status::block_incompatible);
  CHECK(changed(detail::BlockRecord::clock, 0, std::uint32_t{5000000}) == Status::block_incompatible);
  CHECK(changed(detail::BlockRecord::clock, 4, std::uint32_t{0}) == Status::ok);  // no shape has a lag
  CHECK(changed(detail::BlockRecord::window, 0, std::uint32_t{2}) == Status::block_incompatible);
  CHECK(changed(detail::BlockRecord::window, 4, std::uint32_t{0}) == Status::block_incompatible);
  for (std::size_t i = 0; i < 16; ++i) {
    CHECK(changed(detail::BlockRecord::allocation, 4 * i, 0.5f) == Status::block_incompatible);
    CHECK(changed(detail::BlockRecord::allocation, 4 * i, std::numeric_limits<float>::quiet_NaN()) ==
          Status::block_incompatible);
  }
  auto records = records_of(block);
  records.push_back(
      {static_cast<unsigned>(detail::BlockRecord::columns) | detail::mandatory_record, Bytes{'n', '1', 0, 's', 0}});
  CHECK(opened<RecordedModel>(with_records(block, records)) == Status::block_incompatible);
  records.back() = {static_cast<unsigned>(detail::BlockRecord::base) | detail::mandatory_record, Bytes{'b'}};
  CHECK(opened<RecordedModel>(with_records(block, records)) == Status::block_incompatible);
  records.back().bytes.clear();  // no base is none
  CHECK(opened<RecordedModel>(with_records(block, records)) == Status::ok);
}

namespace {

using WindowedFeatures = Windowed<WithColumns<PaperFeatures, BatteryVoltage>, 2, PeriodMicroseconds<10000>>;
using WindowedNet = Network<float, InputSize<WindowedFeatures::size>, Dense<4>>;

/// A trained model whose weights are of no interest.
template <class NetworkType, class ContextType>
TrainedModel<NetworkType, ContextType> some_model() {
  TrainedModel<NetworkType, ContextType> model;
  model.input.standard_deviation.fill(1.0f);
  model.output.standard_deviation.fill(1.0f);
  model.envelope_lower.fill(-1.0f);
  model.envelope_upper.fill(1.0f);
  model.network.parameters.fill(0.01f);
  return model;
}

}  // namespace

TEST_CASE("window, columns and period of a feature set with a past are records") {
  using Shape = TrainedModel<WindowedNet, Context<WindowedFeatures, PaperQuadrotor>>;
  const auto model = some_model<WindowedNet, Context<WindowedFeatures, PaperQuadrotor>>();
  const Bytes block = model_block(model, {Shape::FeatureVector{}}, {});
  ModelView<Shape> view;
  REQUIRE(opened(BlockBytes(block), view) == Status::ok);
  CHECK(view.facts.sample_period_s == 0.01);
  auto records = records_of(block);
  CHECK(detail::read_u32(find(records, detail::BlockRecord::window).bytes.data()) == 2);
  const std::string columns = std::string("battery_voltage") + '\0' + "V" + '\0';
  CHECK(find(records, detail::BlockRecord::columns).bytes == Bytes(columns.begin(), columns.end()));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    auto others = records;
    unsigned char& letter = find(others, detail::BlockRecord::columns).bytes[i];
    letter = static_cast<unsigned char>(letter ^ 1u);
    CHECK(opened<Shape>(with_records(block, others)) == Status::block_incompatible);
  }
  find(records, detail::BlockRecord::columns).bytes.pop_back();
  CHECK(opened<Shape>(with_records(block, records)) == Status::block_incompatible);
  Provenance from;
  from.sample_period_s = 0.02;
  CHECK_THROWS_WITH_AS(model_block(model, {Shape::FeatureVector{}}, from),
                       "export: the sample period is not that of the features' window", std::invalid_argument);
}

namespace {

struct OtherInverse : LinearizedBase {
  static constexpr const char* description = "OtherInverse";
};
using Net16 = Network<float, InputSize<16>, Dense<4>>;
template <class Base>
using ResidualContext = Context<PaperFeatures, PaperQuadrotor, ResidualOutputs<Base>>;
template <class Base>
using ResidualModel = TrainedModel<Net16, ResidualContext<Base>>;

}  // namespace

TEST_CASE("a residual on another base does not open, though its outputs have the same names") {
  const auto model = some_model<Net16, ResidualContext<LinearizedBase>>();
  const Bytes block = model_block(model, {ResidualModel<LinearizedBase>::FeatureVector{}}, {});
  CHECK(opened<ResidualModel<LinearizedBase>>(BlockBytes(block)) == Status::ok);
  CHECK(opened<ResidualModel<OtherInverse>>(BlockBytes(block)) == Status::block_incompatible);
  auto records = records_of(block);
  const std::string base = "pinnquad::LinearizedInverse";
  CHECK(find(records, detail::BlockRecord::base).bytes == Bytes(base.begin(), base.end()));
  records.erase(records.begin() + (&find(records, detail::BlockRecord::base) - records.data()));
  CHECK(opened<ResidualModel<LinearizedBase>>(with_records(block, records)) == Status::block_incompatible);
}

TEST_CASE("a verdict and a bias go along where they are given") {
  using Model = ResidualModel<LinearizedBase>;
  const auto model = some_model<Net16, ResidualContext<LinearizedBase>>();
  Provenance from;
  from.verdict = Verdict{-0.5, 0.25, -1.0};
  from.bias_time_constants_s = {0.25, 0.5, 0, 1};
  const std::vector<Model::FeatureVector> golden = {Model::FeatureVector{}};
  const Bytes block = model_block(model, golden, from);
  CHECK(block.size() <= ModelBlockLayout<Model>::length(1) + ModelBlockLayout<Model>::most_record_bytes());
  ModelView<Model> view;
  REQUIRE(opened(BlockBytes(block), view) == Status::ok);
  const BlockBytes kept(block);
  REQUIRE(opened(kept, view) == Status::ok);
  CHECK(view.facts.has_verdict);
  CHECK(view.facts.worse_than_mean);
  REQUIRE(view.facts.has_bias);
  const auto settings = bias_settings<double>(view.facts);
  CHECK(settings.time_constants_s == SignedSums<double>{0.25, 0.5, std::numeric_limits<double>::infinity(), 1});
  CHECK(bias_settings<float>(view.facts).time_constants_s[1] == 0.5f);
  // without it the block is the same but for the record
  auto without = records_of(block);
  without.erase(without.begin() + (&find(without, detail::BlockRecord::bias) - without.data()));
  Provenance silent = from;
  silent.bias_time_constants_s.reset();
  ModelView<Model> other;
  const BlockBytes bare(with_records(block, without));
  const Bytes expected = model_block(model, golden, silent);
  REQUIRE(bare.size() == expected.size());
  CHECK(std::memcmp(bare.data(), expected.data(), expected.size()) == 0);
  REQUIRE(opened(bare, other) == Status::ok);
  CHECK_FALSE(other.facts.has_bias);
  CHECK(bias_settings<double>(other.facts).time_constants_s == BiasSettings<double>{}.time_constants_s);

  for (const Record& record : records_of(block)) {
    const unsigned type = record.type & 0x7fffu;
    const bool optional = type == static_cast<unsigned>(detail::BlockRecord::verdict) ||
                          type == static_cast<unsigned>(detail::BlockRecord::provenance) ||
                          type == static_cast<unsigned>(detail::BlockRecord::bias);
    CHECK((record.type < detail::mandatory_record) == optional);
  }
  from.bias_time_constants_s = {0.25, 0.5, -1, 1};
  CHECK_THROWS_WITH_AS(model_block(model, golden, from),
                       "export: expected time constants of the bias of 0.02 to 60 s, or 0 (record bias), found -1",
                       std::invalid_argument);
}
