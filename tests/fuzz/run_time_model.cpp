// SPDX-License-Identifier: MIT
// libFuzzer target over model blocks: whatever the bytes, open() reads none beyond the block and says why it refuses
// one; an accepted block is looked at, asked and certified without a trap, and a program refuses it in one line or
// takes it. A view of a known shape, which flies, is untouched unless it accepts, and then its numbers are sound. The
// mutator makes most inputs pass checksum, counts, hash: chance would not. Build and run: scripts/heavy/fuzz.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "fuzz/fuzzing.hpp"
#include "pinnquad/deploy/block_model.hpp"
#include "pinnquad/exported/model_view.hpp"
#include "pinnquad/inference/self_test.hpp"
#include "support/block_bytes.hpp"
#include "support/small_model_variants.hpp"

namespace {

using namespace pinnquad;
using Header = detail::ModelBlockHeader;
using Bytes = std::vector<unsigned char>;

using pinnquad_test::expect;
pinnquad_test::Tally tally;

/// Networks that are asked: a wide one takes as long as it is wide.
constexpr int most_parameters_asked = 1 << 16;

/// An accepted block, asked at golden vectors, at corners of its envelope and with motions.
template <class Scalar>
void ask(const RunTimeModel<Scalar>& model) {
  const RunTimeFeatures& features = model.features();
  expect(features.size() >= 1 && features.size() == model.network().inputs(), "features are the network's inputs");
  expect(model.outputs().size() == model.network().outputs(), "outputs are the network's");
  expect(features.column_count() <= RunTimeFeatures::most_columns, "columns have room");
  std::vector<Scalar> work(model.workspace());
  const Scalar difference = model.golden_difference(work.data());
  expect(!(difference < Scalar(0)), "a difference is none, or one");
  Commands<Scalar> u{};
  model.commands(model.scales().lower, u.data(), work.data());
  model.commands(model.scales().upper, u.data(), work.data());
  std::vector<RunTimeFeatures::Inputs<Scalar>> taps(std::size_t(features.window().taps));
  expect(features.asks_for_altitude() == (features.check(taps.data()) == Status::not_finite),
         "an altitude is asked for");
  for (auto& tap : taps) tap.altitude_m = Scalar(1);
  expect(features.check(taps.data()) == Status::ok, "hover is a motion");
  std::vector<Scalar> x(std::size_t(features.size()));
  features.extract(taps.data(), x.data());
  for (const Scalar value : x) expect(bool(std::isfinite(value)), "features of hover are numbers");
  model.commands(x.data(), u.data(), work.data());
  std::size_t letters = model.schema().size() + model.provenance("name").size();
  for (int k = 0; k < model.network().outputs(); ++k) letters += model.output(k).name.size();
  expect(letters < 1000000, "texts end");
}

template <class Scalar>
void open(const unsigned char* block, std::size_t size) {
  const auto model = std::make_unique<RunTimeModel<Scalar>>();
  const Status status = RunTimeModel<Scalar>::open(block, size, *model);
  if (status != Status::ok) {
    expect(status == Status::block_truncated || status == Status::block_incompatible || status == Status::block_corrupt,
           "a refusal says why");
    expect(model->fault().expected != nullptr && model->fault().found != nullptr, "in words");
    ++tally.count[std::string("refused: ") + model->fault().expected];
    return;
  }
  ++tally.count[to_string(status)];
  if (model->network().parameter_count() <= most_parameters_asked) ask(*model);
}

void look(const Bytes& bytes) {
  try {
    const BlockModel model("some.block", bytes);
    ++tally.count["taken by a program"];
    if (model.network().parameter_count() > most_parameters_asked) return;
    const std::vector<double> x = model.golden_features(0);
    for (const double u : model.commands(x)) expect(bool(std::isfinite(u)), "golden commands are numbers");
    model.derivatives(x);
    model.certificate();
    model.feature_names();
    model.has_affine_schema();
  } catch (const InputError& error) {
    expect(std::string(error.what()).find('\n') == std::string::npos, "a refusal is one line");
  }
}

/// As flight code opens it: std::isfinite judges the numbers, and not the library's own test of the bits.
template <class Shape>
void fly(const unsigned char* block, std::size_t size) {
  using View = ModelView<Shape>;
  using Scalar = typename Shape::Scalar;
  const auto all_finite = [](const auto& numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](Scalar value) { return bool(std::isfinite(value)); });
  };
  View view;
  view.input.mean[0] = Scalar(77);
  const Status status = View::open(block, size, view);
  ++tally.count[std::string("view: ") + to_string(status)];
  if (status != Status::ok) {
    expect(view.parameters() == nullptr && view.input.mean[0] == Scalar(77), "a refusal leaves the view alone");
    return;
  }
  const auto* weights = reinterpret_cast<const unsigned char*>(view.parameters());
  expect(
      weights >= block && weights + sizeof(typename Shape::Network::Parameters) + Header::checksum_size <= block + size,
      "the weights lie in the block");
  expect(all_finite(view.input.mean) && all_finite(view.output.mean), "means are finite");
  for (std::size_t i = 0; i < view.input.mean.size(); ++i) {
    expect(view.input.standard_deviation[i] > 0 && view.envelope_lower[i] <= view.envelope_upper[i],
           "deviations and envelope are sound");
  }
  static typename View::Packed packed;
  expect(View::open(block, size, view, packed) == Status::ok, "what opens is packed");
  const InverseDynamics<View> inverse(view);
  const Status tested = self_test(inverse);
  for (std::size_t i = 0; i < std::min<std::size_t>(view.golden_features.size(), 8); ++i) {
    auto x = view.golden_features[i];
    expect(all_finite(x) && all_finite(view.golden_commands[i]), "golden vectors are finite");
    const Scalar untouched = Scalar(-12345);
    Commands<Scalar> u{untouched, untouched, untouched, untouched};
    const Status answered = inverse.predict_features(x.data(), u);
    for (const Scalar command : u) {
      expect(answered == Status::ok ? bool(std::isfinite(command)) : command == untouched, "finite, or untouched");
    }
    expect(tested != Status::ok || answered == Status::ok, "what passes its self test answers its golden vectors");
    x[i] = view.envelope_upper[i] + std::abs(view.envelope_upper[i]) + Scalar(1);
    expect(inverse.predict_features(x.data(), u) == Status::outside_envelope, "the envelope holds");
  }
}

// the mutator

void write_u32(std::uint8_t* to, std::size_t value) {
  for (std::size_t byte = 0; byte < 4; ++byte) to[byte] = static_cast<std::uint8_t>((value >> (8 * byte)) & 0xffu);
}

std::string_view text_of(const Bytes& bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

std::vector<std::string_view> texts_of(const Bytes& bytes) {
  std::vector<std::string_view> texts;
  std::string_view rest = text_of(bytes), text;
  while (RunTimeFeatures::take_text(rest, text)) texts.push_back(text);
  return texts;
}

/// The records, where the bytes hold some and scalars behind them; empty else.
std::vector<test::Record> records_in(const Bytes& block) {
  std::vector<test::Record> records;
  if (block.size() < Header::size + 16) return records;
  const std::uint32_t count = detail::read_u32(&block[Header::size]);
  std::size_t at = Header::size + Header::record_counts;
  for (std::uint32_t i = 0; i < count && i < 64; ++i) {
    if (at + 8 > block.size()) return {};
    const std::size_t length = detail::read_u32(&block[at + 4]);
    if (length > block.size() - at - 8) return {};
    const auto first = block.begin() + static_cast<std::ptrdiff_t>(at + 8);
    records.push_back({detail::read_u32(&block[at]), Bytes(first, first + static_cast<std::ptrdiff_t>(length))});
    at += 8 + Header::padded(length);
    if (at > block.size()) return {};
  }
  if (test::BlockBytes(block).scalars() > block.size()) records.clear();
  return records;
}

/// The hash of what the records say, as detail::hash_of_shape().
std::uint64_t hash_of(std::vector<test::Record> records) {
  const auto bytes = [&](detail::BlockRecord type) -> const Bytes& { return test::find(records, type).bytes; };
  const auto features = texts_of(bytes(detail::BlockRecord::features)),
             outputs = texts_of(bytes(detail::BlockRecord::outputs));
  const Bytes& vehicle = bytes(detail::BlockRecord::vehicle);
  Airframe<double> airframe{};
  std::size_t at = 0;
  if (vehicle.size() < 8 * airframe_number_count) return 0;
  each_number(airframe, [&](auto& number) {
    double value = 0;
    std::memcpy(&value, &vehicle[at], 8);
    at += 8;
    using Number = std::decay_t<decltype(number)>;
    if constexpr (std::is_same_v<Number, Spin>) {
      number = value < 0 ? Spin::clockwise : Spin::counter_clockwise;
    } else {
      number = value;
    }
  });
  const bool is_double = vehicle.size() > 16 * airframe_number_count;
  const std::size_t flown = airframe_number_count * (is_double ? 16u : 12u);
  detail::Fnv1a fnv;
  fnv.absorb_text(text_of(bytes(detail::BlockRecord::answer)));
  const auto pairs = [](const auto& texts, std::size_t first) {
    return [&texts, first](std::size_t i) {
      return detail::NameAndUnit{texts[first + 2 * i], texts[first + 2 * i + 1]};
    };
  };
  if (outputs.size() < 3) return 0;
  detail::absorb_shape(fnv, features.size() / 2, pairs(features, 0), (outputs.size() - 1) / 2, pairs(outputs, 1),
                       text_of(vehicle).substr(std::min(flown, vehicle.size())), motor_torque_signs(airframe));
  return fnv.hash;
}

/// As many scalars as the description asks for: those that are there, or new ones where their number is another.
void fit_scalars(Bytes& block, const std::vector<test::Record>& records, std::size_t most) {
  RunTimeNetwork network;
  std::vector<test::Record> copy = records;
  if (!network.parse(text_of(test::find(copy, detail::BlockRecord::answer).bytes))) return;
  const std::size_t inputs = std::size_t(network.inputs()), outputs = std::size_t(network.outputs());
  const std::size_t golden = 1, parameters = std::size_t(network.parameter_count());
  const std::size_t count = 4 * inputs + 2 * outputs + golden * (inputs + 4) + parameters;
  const std::size_t scalar = network.is_double() ? 8 : 4;
  const std::size_t first = test::BlockBytes(block).scalars();
  if (first + count * scalar + 4 > most) return;
  write_u32(&block[Header::scalar_bytes], scalar);
  write_u32(&block[Header::inputs], inputs);
  write_u32(&block[Header::outputs], outputs);
  write_u32(&block[Header::parameters], parameters);
  const std::size_t there = detail::read_u32(&block[Header::golden_vectors]);
  const std::size_t same = 4 * inputs + 2 * outputs + there * (inputs + 4) + parameters;
  if (there > 0 && there < 1000 && block.size() == first + same * scalar + 4) return;
  write_u32(&block[Header::golden_vectors], golden);
  block.resize(first + count * scalar + 4);
  const auto set = [&](std::size_t from, std::size_t until, double value) {
    for (std::size_t i = from; i < until; ++i) {
      const auto small = static_cast<float>(value);
      std::memcpy(&block[first + i * scalar], scalar == 8 ? static_cast<const void*>(&value) : &small, scalar);
    }
  };
  set(0, count, 0);
  set(inputs, 2 * inputs, 1);
  set(2 * inputs + outputs, 2 * inputs + 2 * outputs, 1);
  set(2 * inputs + 2 * outputs, 3 * inputs + 2 * outputs, -1);
  set(3 * inputs + 2 * outputs, 4 * inputs + 2 * outputs, 1);
}

}  // namespace

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                               unsigned int seed) {
  std::minstd_rand engine(seed);
  Bytes block(data, data + size);
  std::vector<test::Record> records = records_in(block);
  if (!records.empty() && engine() % 2 == 0) {  // one record changes: its length and all behind it are right
    Bytes& one = records[engine() % records.size()].bytes;
    const std::size_t room = one.size() + 64;
    one.resize(room);
    one.resize(LLVMFuzzerMutate(one.data(), room - 64, room));
    const test::BlockBytes made = test::with_records(block, records);
    block.assign(made.data(), made.data() + made.size());
  } else {
    block.resize(std::max(most, size));
    block.resize(LLVMFuzzerMutate(block.data(), size, most));
  }
  if (block.size() >= Header::size + Header::record_counts + Header::checksum_size) {
    if (engine() % 8 != 0) std::copy(model_block_magic.begin(), model_block_magic.end(), block.begin());
    if (engine() % 8 != 0) write_u32(&block[Header::version], model_format_version);
    records = records_in(block);
    try {
      if (!records.empty() && engine() % 2 == 0) fit_scalars(block, records, most);
      if (!records.empty() && engine() % 4 != 0) {
        const std::uint64_t hash = hash_of(records);
        write_u32(&block[Header::shape_hash], hash & 0xffffffffu);
        write_u32(&block[Header::shape_hash + 4], hash >> 32);
      }
    } catch (const std::out_of_range&) {  // a record that is not there
    }
    if (engine() % 8 != 0) write_u32(&block[Header::length], block.size());
    if (engine() % 8 != 0) write_u32(&block[block.size() - 4], crc32(block.data(), block.size() - 4));
  }
  size = std::min(block.size(), most);
  std::copy_n(block.begin(), size, data);
  return size;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Bytes bytes(data, data + size);
  const test::BlockBytes memory(bytes);  // exactly as long: the sanitizer sees a read past the end
  open<float>(memory.data(), memory.size());
  open<double>(memory.data(), memory.size());
  fly<test::SmallModel>(memory.data(), memory.size());
  fly<test::DoubleModel>(memory.data(), memory.size());
  look(bytes);
  return 0;
}
