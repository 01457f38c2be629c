// SPDX-License-Identifier: MIT
// Blocks that are none, or contradict themselves: a run-time model refuses each with a Status and in words, and reads
// no byte beyond the block.
#include "pinnquad/exported/run_time_model.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>

#include "pinnquad/deploy/block_model.hpp"
#include "pinnquad/exported/model_view.hpp"
#include "pinnquad/features/windowed.hpp"
#include "support/block_bytes.hpp"
#include "support/drawn_model.hpp"
#include "support/recorded_model.hpp"

using namespace pinnquad;
using pinnquad::test::BlockBytes;
using pinnquad::test::find;
using pinnquad::test::Record;
using pinnquad::test::records_of;
using pinnquad::test::with_records;

namespace {

using Bytes = std::vector<unsigned char>;
using Header = detail::ModelBlockHeader;

/// The Status, the words of a refusal, and what a program says on the ground.
struct Answer {
  Status status;
  std::string words;
  std::string line;
};

template <class Scalar = float>
Answer opened(const BlockBytes& block) {
  const auto model = std::make_unique<RunTimeModel<Scalar>>();
  Answer answer{RunTimeModel<Scalar>::open(block.data(), block.size(), *model), "", ""};
  if (answer.status != Status::ok) answer.words = std::string(model->fault().expected) + " | " + model->fault().found;
  try {
    const BlockModel ground("some.block", Bytes(block.data(), block.data() + block.size()));
  } catch (const InputError& error) {
    answer.line = error.what();
  }
  return answer;
}

/// Refused with this Status, and by both with this keyword in one line.
template <class Scalar = float>
void refused(const BlockBytes& block, Status status, const std::string& keyword) {
  CAPTURE(keyword);
  const Answer answer = opened<Scalar>(block);
  CHECK(answer.status == status);
  INFO("words: " << answer.words);
  INFO("line: " << answer.line);
  CHECK(answer.words.find(keyword) != std::string::npos);
  CHECK(answer.line.find("some.block: expected ") == 0);
  CHECK(answer.line.find(keyword) != std::string::npos);
  CHECK(answer.line.find('\n') == std::string::npos);
}
template <class Scalar = float>
void corrupt(const BlockBytes& block, const std::string& keyword) {
  refused<Scalar>(block, Status::block_corrupt, keyword);
}
template <class Scalar = float>
void incompatible(const BlockBytes& block, const std::string& keyword) {
  refused<Scalar>(block, Status::block_incompatible, keyword);
}

std::string text_of(const Record& record) { return {record.bytes.begin(), record.bytes.end()}; }

/// The block with one record changed.
BlockBytes changed(const Bytes& block, detail::BlockRecord type, const std::function<void(Bytes&)>& change) {
  auto records = records_of(block);
  change(find(records, type).bytes);
  return with_records(block, records);
}
BlockBytes with_text(const Bytes& block, detail::BlockRecord type, const std::string& text) {
  return changed(block, type, [&](Bytes& bytes) { bytes.assign(text.begin(), text.end()); });
}
/// With `now` in place of `before` in a text.
BlockBytes replaced(const Bytes& block, detail::BlockRecord type, const std::string& before, const std::string& now) {
  auto records = records_of(block);
  std::string text = text_of(find(records, type));
  REQUIRE(text.find(before) != std::string::npos);
  return with_text(block, type, text.replace(text.find(before), before.size(), now));
}
template <class Value>
BlockBytes with_value(const Bytes& block, detail::BlockRecord type, std::size_t at, Value value) {
  return changed(block, type, [&](Bytes& bytes) { std::memcpy(bytes.data() + at, &value, sizeof value); });
}
BlockBytes with_u32(const Bytes& block, std::size_t at, std::uint32_t value) {
  BlockBytes other(block);
  other.set_u32(at, value);
  other.seal();
  return other;
}
template <class Scalar>
BlockBytes with_scalar(const Bytes& block, std::size_t index, Scalar value) {
  BlockBytes other(block);
  other.set_scalar(index, value);
  other.seal();
  return other;
}

const Bytes& recorded() {
  static const Bytes block = model_block<test::RecordedModel>();
  return block;
}

using CentredFeatures = Windowed<WithColumns<PaperFeatures, BatteryVoltage>, 3, PeriodMicroseconds<10000>, Centred>;
using Physics = PhysicsFeatures;
using MonotoneNet = Network<float, InputSize<residual_inputs<Physics>>, Dense<4>>;

Bytes centred() {
  using Net = Network<double, InputSize<CentredFeatures::size>, Dense<4>>;
  return test::drawn_block(test::drawn_model<test::ModelOf<Net, CentredFeatures>>(1));
}
using MonotoneModel = test::ModelOf<MonotonePredictor<Physics, MonotoneNet>, Physics, AxisCommandOutputs>;
Bytes monotone() { return test::drawn_block(test::drawn_model<MonotoneModel>(1)); }

Bytes five() {
  using Net = Network<float, InputSize<16>, Dense<5>>;
  return test::drawn_block(test::drawn_model<test::ModelOf<Net, PaperFeatures, test::FiveOutputs>>(1));
}

}  // namespace

TEST_CASE("sound blocks open") {
  CHECK(opened(BlockBytes(recorded())).line == "");
  CHECK(opened<double>(BlockBytes(centred())).line == "");
  CHECK(opened(BlockBytes(monotone())).line == "");
  CHECK(opened(BlockBytes(five())).line == "");
}

TEST_CASE("a block that is cut short, changed, of another format or of other numbers") {
  for (const Bytes& block : {recorded(), five()}) {
    int truncated = 0;
    for (std::size_t length = 0; length < block.size(); ++length) {
      truncated += opened(BlockBytes(block, length)).status == Status::block_truncated;
    }
    CHECK(truncated == int(block.size()));
    refused(BlockBytes(block, block.size() - 1), Status::block_truncated, "cut short");
  }
  // one that says that it is as short as it is
  for (std::size_t length = Header::size + Header::checksum_size; length < recorded().size(); ++length) {
    BlockBytes other(recorded(), length);
    other.set_u32(Header::length, static_cast<std::uint32_t>(length));
    other.seal();
    CHECK(opened(other).status == Status::block_corrupt);
  }
  const auto size = static_cast<std::uint32_t>(recorded().size());
  for (const std::uint32_t length : {0u, 4u, 75u, size + 1, 0xffffffffu}) {
    const Status status = length < size ? Status::block_corrupt : Status::block_truncated;
    CHECK(opened(with_u32(recorded(), Header::length, length)).status == status);
  }
  BlockBytes other(recorded());
  other[300] = static_cast<unsigned char>(other[300] + 1);
  corrupt(other, "checksum");
  incompatible(with_u32(recorded(), 0, 0), "another file");
  const std::string own = "format " + std::to_string(model_format_version);
  for (const int format : {0, 1, model_format_version - 1, model_format_version + 1}) {
    const BlockBytes changed = with_u32(recorded(), Header::version, static_cast<std::uint32_t>(format));
    incompatible(changed, own);
    incompatible(changed, "train and export again");
    CHECK(opened(changed).line.find("found " + std::to_string(format)) != std::string::npos);
  }
  incompatible<double>(with_u32(recorded(), Header::scalar_bytes, 5), "size");
  CHECK(opened<float>(BlockBytes(centred())).words.find("size") != std::string::npos);
}

TEST_CASE("counts of any size are refused where they do not fit") {
  for (const std::size_t at : {Header::inputs, Header::outputs, Header::parameters, Header::golden_vectors}) {
    for (const std::uint32_t value :
         {0u, 1u, 15u, 17u, 512u, 513u, 1u << 28, 0x7fffffffu, 0x80000000u, 0xcccccccdu, 0xffffffffu}) {
      CAPTURE(at);
      CAPTURE(value);
      CHECK(opened(with_u32(recorded(), at, value)).status == Status::block_corrupt);
    }
  }
  corrupt(with_u32(recorded(), Header::inputs, 513), "512 features");
  corrupt(with_u32(recorded(), Header::parameters, 171), "counts that fit its length");
  corrupt(with_u32(recorded(), Header::golden_vectors, 0), "counts that fit its length");
  corrupt(with_u32(recorded(), Header::size, 0), "records that fit");
  CHECK(opened(with_u32(recorded(), Header::training_rows, 0xffffffffu)).status == Status::ok);
}

TEST_CASE("every mandatory record is asked for; what is unknown is refused if it is mandatory") {
  for (const detail::BlockRecord type :
       {detail::BlockRecord::commands, detail::BlockRecord::clock, detail::BlockRecord::window,
        detail::BlockRecord::allocation, detail::BlockRecord::answer, detail::BlockRecord::features,
        detail::BlockRecord::outputs, detail::BlockRecord::vehicle}) {
    auto records = records_of(recorded());
    records.erase(records.begin() + (&find(records, type) - records.data()));
    corrupt(with_records(recorded(), records), "all records");
  }
  auto records = records_of(recorded());
  records.erase(records.begin() + (&find(records, detail::BlockRecord::provenance) - records.data()));
  CHECK(opened(with_records(recorded(), records)).line == "");
  records.push_back({detail::block_record_types + 1, Bytes(13, 1)});
  CHECK(opened(with_records(recorded(), records)).line == "");
  records.back().type |= detail::mandatory_record;
  incompatible(with_records(recorded(), records), "records that are known");
}

TEST_CASE("a description of a predictor that is too deep, too long, too wide or of anything else") {
  const auto described = [](const std::string& text) {
    return with_text(recorded(), detail::BlockRecord::answer, text);
  };
  const std::string network =
      "pinnquad::Network<float, pinnquad::Inputs<16>, pinnquad::Dense<8>, pinnquad::Relu, "
      "pinnquad::Dense<4>>";
  CHECK(opened(described(network)).line == "");
  const auto times = [](int count, const std::string& text) {
    std::string all;
    for (int i = 0; i < count; ++i) all += text;
    return all;
  };
  for (const std::string& text :
       {std::string(),
        std::string(" "),
        std::string("x"),
        network + ">",
        network + " x",
        network + std::string(1, '\0'),
        network.substr(0, network.size() - 1),
        times(10000, "pinnquad::Sum<"),
        times(10000, "pinnquad::Sum<") + network + times(10000, ", " + network + ">"),
        times(4, "pinnquad::Sum<") + network + times(4, ", " + network + ">"),
        "pinnquad::Network<float, pinnquad::Inputs<16>" + times(100000, ", pinnquad::Relu") + ">",
        "pinnquad::Network<float, pinnquad::Inputs<16>" + times(33, ", pinnquad::Dense<16>") + ">",
        std::string("pinnquad::Network<float, pinnquad::Inputs<16>>"),
        std::string("pinnquad::Network<float, pinnquad::Inputs<16>, pinnquad::Dense<1000000000>, pinnquad::Dense<4>>"),
        std::string("pinnquad::Network<float, pinnquad::Inputs<16>, pinnquad::Dense<16384>, pinnquad::Dense<16384>, "
                    "pinnquad::Dense<16384>, pinnquad::Dense<4>>"),
        "pinnquad::Network<float, pinnquad::Inputs<16>, pinnquad::Dense<" + times(1000, "9") + ">>",
        std::string("pinnquad::Network<float, pinnquad::Inputs<16>, pinnquad::Dense<-4>>"),
        std::string("pinnquad::Network<float, pinnquad::Inputs<16>, pinnquad::Dense<0>>"),
        std::string("pinnquad::Network<float, pinnquad::Inputs<>, pinnquad::Dense<4>>"),
        std::string("pinnquad::Network<half, pinnquad::Inputs<16>, pinnquad::Dense<4>>"),
        std::string("pinnquad::Network<float, pinnquad::Inputs<16>, mine::Swish, pinnquad::Dense<4>>"),
        "pinnquad::Bounded<pinnquad::Bounded<" + network + ">>",
        "pinnquad::PathBounded<" + network + ">",
        "pinnquad::Withheld<" + network + ", 19>",
        "pinnquad::Withheld<" + network + ", 19, 18>",
        "pinnquad::Withheld<" + network + ", 22, 3, 5>",
        "pinnquad::Withheld<" + network + ", 19, 3",
        std::string("pinnquad::AxisAligned<float, 16>"),
        std::string("pinnquad::AxisAligned<float, 3, 0>"),
        "pinnquad::AxisAligned<float, 16384" + times(65, ", 3") + ">",
        "pinnquad::Sum<" + network + ", pinnquad::Network<double, pinnquad::Inputs<16>, pinnquad::Dense<4>>>",
        "pinnquad::Sum<" + network + ", pinnquad::Network<float, pinnquad::Inputs<16>, pinnquad::Dense<5>>>"}) {
    incompatible(described(text), "a network of dense layers");
  }
  for (const char* text :
       {"pinnquad::Network<float, pinnquad::Inputs<16>, pinnquad::Dense<9>, pinnquad::Relu, pinnquad::Dense<4>>",
        "pinnquad::Network<float, pinnquad::Inputs<15>, pinnquad::Dense<8>, pinnquad::Relu, pinnquad::Dense<4>>",
        "pinnquad::Network<float, pinnquad::Inputs<16>, pinnquad::Dense<8>, pinnquad::Relu, pinnquad::Dense<5>>",
        "pinnquad::Network<double, pinnquad::Inputs<16>, pinnquad::Dense<8>, pinnquad::Relu, pinnquad::Dense<4>>",
        "pinnquad::Network<float, pinnquad::Inputs<16>, pinnquad::Relu>"}) {
    corrupt(described(text), "inputs, outputs and parameters");
  }
  // as many numbers, in another order
  corrupt(replaced(recorded(), detail::BlockRecord::answer, "Relu", "Tanh"), "hash");
}

TEST_CASE("features that are no list, that no window has, or other ones") {
  const auto with = [](const std::string& before, const std::string& now) {
    return replaced(recorded(), detail::BlockRecord::features, before, now);
  };
  const std::string end(1, '\0');
  corrupt(with("roll" + end + "rad", "roll" + end + "deg"), "names and units of its features");
  corrupt(with("roll", "pitch"), "names and units of its features");
  corrupt(with("roll", ""), "names and units of its features");
  for (const char* name : {"roll[-1]", "roll[+0]", "roll[-0]", "roll[-]", "roll[]", "roll]", "[-1]", "]", "roll[--1]",
                           "roll[-99999999999999999999]", "roll[-1][-1]"}) {
    corrupt(with("roll", name), "names and units of its features");
  }
  corrupt(with("roll", "rolling"), "hash");  // a column, for all that is known
  std::string many;
  for (int i = 0; i < 100000; ++i) many += "n" + std::to_string(i) + end + "1" + end;
  corrupt(with_text(recorded(), detail::BlockRecord::features, many), "names and units of its features");
  many.clear();
  for (int i = 0; i < 16; ++i) many += "n" + std::to_string(i) + end + "1" + end;
  corrupt(with_text(recorded(), detail::BlockRecord::features, many), "hash");
  for (const std::string& text : {std::string(), many.substr(0, many.size() - 1), many + end, end + many}) {
    corrupt(with_text(recorded(), detail::BlockRecord::features, text), "names and units of its features");
  }
}

TEST_CASE("a window that its features do not have, without a period, or centred about no instant; another column") {
  const Bytes block = centred();
  const auto window = [&](std::uint32_t taps, std::uint32_t causal) {
    return changed(block, detail::BlockRecord::window, [&](Bytes& bytes) {
      std::memcpy(bytes.data(), &taps, 4);
      std::memcpy(bytes.data() + 4, &causal, 4);
    });
  };
  CHECK(opened<double>(window(3, 0)).line == "");
  for (const std::uint32_t taps : {0u, 1u, 65u, 0x10003u, 0xffffffffu}) {
    corrupt<double>(window(taps, 0), taps == 0 ? "record window" : "names and units of its features");
  }
  corrupt<double>(window(3, 1), "names and units of its features");  // [+1] is not in a causal one
  corrupt<double>(window(4, 0), "odd");
  corrupt<double>(with_value(block, detail::BlockRecord::clock, 0, std::uint32_t{0}), "period");
  corrupt<double>(replaced(block, detail::BlockRecord::features, "roll[+1]", "roll[+2]"),
                  "names and units of its features");
  incompatible<double>(replaced(block, detail::BlockRecord::columns, "battery_voltage", "battery_current"), "columns");
  incompatible<double>(with_text(block, detail::BlockRecord::columns, "battery_voltage"), "columns");
  // a measured value by the name of one that is worked out
  auto records = records_of(recorded());
  const std::string column = std::string("roll") + '\0' + "rad" + '\0';
  records.push_back(
      {static_cast<unsigned>(detail::BlockRecord::columns) | detail::mandatory_record, {column.begin(), column.end()}});
  incompatible(with_records(recorded(), records), "columns");
}

TEST_CASE("outputs that no library has, or that are other ones than those that they are called") {
  incompatible(replaced(recorded(), detail::BlockRecord::outputs, "CommandOutputs", "OtherOutputs"), "output schema");
  incompatible(replaced(recorded(), detail::BlockRecord::outputs, "CommandOutputs", "RotorSpeedOutputs"),
               "output schema");
  incompatible(replaced(recorded(), detail::BlockRecord::outputs, "u3", "u5"), "output schema");
  incompatible(replaced(recorded(), detail::BlockRecord::outputs, "u3", "u3" + std::string(1, '\0')), "output schema");
  incompatible(with_text(recorded(), detail::BlockRecord::outputs, ""), "output schema");
  auto records = records_of(recorded());
  const std::string base = "pinnquad::LinearizedInverse";
  records.push_back(
      {static_cast<unsigned>(detail::BlockRecord::base) | detail::mandatory_record, {base.begin(), base.end()}});
  incompatible(with_records(recorded(), records), "output schema");
  // more outputs than the schema of the library has names
  const auto own = records_of(five());
  const std::string text = text_of(find(records = own, detail::BlockRecord::outputs));
  const std::string called = "pinnquad::CommandOutputs" + text.substr(text.find('\0'));
  incompatible(with_text(five(), detail::BlockRecord::outputs, called), "output schema");
  records = own;
  records.erase(records.begin() + (&find(records, detail::BlockRecord::affine) - records.data()));
  incompatible(with_records(five(), records), "output schema");
  corrupt(with_value(five(), detail::BlockRecord::affine, 0, std::numeric_limits<float>::quiet_NaN()), "record affine");
  corrupt(replaced(five(), detail::BlockRecord::outputs, "u5", "u6"), "hash");
}

TEST_CASE("an airframe that can't fly, that is said twice in two ways, or has another allocation or name") {
  constexpr std::size_t flown = 8 * airframe_number_count;
  const auto airframe = [&](std::size_t number, double value) {
    return changed(recorded(), detail::BlockRecord::vehicle, [&](Bytes& bytes) {
      const auto as_flown = static_cast<float>(value);
      std::memcpy(bytes.data() + 8 * number, &value, sizeof value);
      std::memcpy(bytes.data() + flown + 4 * number, &as_flown, sizeof as_flown);
    });
  };
  constexpr std::size_t x_of_first = 7, spin_of_first = 9;  // each_number(): mass, inertia, products, rotors
  for (const double mass :
       {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    corrupt(airframe(0, mass), "airframe");
  }
  corrupt(airframe(spin_of_first, 0.5), "airframe");
  corrupt(airframe(x_of_first, 0.3), "allocation");
  corrupt(with_value(recorded(), detail::BlockRecord::vehicle, 0, 1.6), "airframe");
  corrupt(with_value(recorded(), detail::BlockRecord::vehicle, flown, 1.6f), "airframe");
  corrupt(with_value(recorded(), detail::BlockRecord::allocation, 12, 7.0f), "allocation");
  corrupt(with_value(recorded(), detail::BlockRecord::allocation, 12, std::numeric_limits<float>::quiet_NaN()),
          "allocation");
  corrupt(replaced(recorded(), detail::BlockRecord::vehicle, "paper_quadrotor", "paper_hexarotor"), "hash");
  corrupt(with_u32(recorded(), Header::shape_hash, 1), "hash");
}

TEST_CASE("numbers that are none, deviations, envelope, golden vectors") {
  using Layout = ModelBlockLayout<test::RecordedModel>;
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const std::size_t count = Layout::parameters(6) + Layout::parameter_count;
  for (std::size_t i = 0; i < count; ++i) corrupt(with_scalar(recorded(), i, i % 2 == 0 ? nan : -inf), "numbers");
  for (const float deviation : {0.0f, -1.0f}) {
    corrupt(with_scalar(recorded(), Layout::input_deviation + 3, deviation), "standard deviations");
    corrupt(with_scalar(recorded(), Layout::output_deviation + 1, deviation), "standard deviations");
  }
  corrupt(with_scalar(recorded(), Layout::envelope_lower, 1e9f), "envelope");
  corrupt(with_scalar(recorded(), Layout::envelope_upper, 1e30f), "envelope");
  corrupt(with_scalar(recorded(), Layout::golden_features, 1e5f), "golden");
  BlockBytes still(recorded());  // a feature that never moved is sound
  const auto upper = still.scalar<float>(Layout::envelope_upper);
  still.set_scalar(Layout::envelope_lower, upper);
  for (std::size_t row = 0; row < 6; ++row) still.set_scalar(Layout::golden_features + row * Layout::inputs, upper);
  still.seal();
  CHECK(opened(still).status == Status::ok);
}

TEST_CASE("a monotone model whose numbers prove nothing") {
  const Bytes block = monotone();
  // a slope below 0, and golden commands of it
  BlockBytes other(block);
  const std::size_t inputs = detail::read_u32(block.data() + Header::inputs), golden = 3;
  const std::size_t commands = 4 * inputs + 8 + golden * inputs;
  other.set_scalar(commands + 4 * golden, -1.0f);
  other.seal();
  CHECK(opened(other).line.find("golden commands") != std::string::npos);
  const auto model = std::make_unique<RunTimeModel<float>>();
  REQUIRE(RunTimeModel<float>::open(other.data(), other.size(), *model) == Status::ok);
  std::vector<float> work(model->workspace());
  Commands<float> made[golden];
  for (std::size_t i = 0; i < golden; ++i) model->commands(model->golden_features(int(i)), made[i].data(), work.data());
  for (std::size_t i = 0; i < 4 * golden; ++i) other.set_scalar(commands + i, made[i / 4][i % 4]);
  other.seal();
  CHECK(opened(other).line == "");  // weights are not asked: who certifies it finds no proof
  const Bytes made_again(other.data(), other.data() + other.size());
  CHECK_FALSE(BlockModel("unproven.block", made_again).certificate().value().proven());
  ModelView<MonotoneModel> view;  // in flight there is nobody who asks
  CHECK(ModelView<MonotoneModel>::open(block.data(), block.size(), view) == Status::ok);
  CHECK(ModelView<MonotoneModel>::open(other.data(), other.size(), view) == Status::block_corrupt);
}

TEST_CASE("a file that is not there or is empty is refused in one line") {
  for (const Bytes& bytes : {Bytes{}, Bytes(3, 'x'), Bytes(200, 'x')}) {
    CHECK_THROWS_AS(BlockModel("some.block", bytes), InputError);
  }
  CHECK_THROWS_AS(BlockModel("no/such.block"), InputError);
}
