// SPDX-License-Identifier: MIT
// Calls the baseline's prediction and compares it with plain loops. The other instruction sets' are linked in, not
// called: if the linker took one of their functions for the baseline's, this program dies on a machine without them.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <vector>

#include "pinnquad/dynamics/linearized.hpp"
#include "prediction.hpp"

extern "C" {
void predict_baseline(const float* x, float* y);
#if defined(WITH_OTHERS)
void predict_avx2(const float* x, float* y);
void predict_avx512(const float* x, float* y);
#endif
}

namespace {

/// Four outputs of a network in double: layer sizes, weights as the library lays them out, one activation.
template <class Parameters, class Activation>
bool agrees(const std::vector<std::size_t>& sizes, const Parameters& parameters, const float* x, const float* y,
            const Activation& activation) {
  std::vector<double> values(x, x + sizes[0]);
  std::size_t next = 0;
  for (std::size_t layer = 1; layer < sizes.size(); ++layer) {
    std::vector<double> sums(sizes[layer]);
    const std::size_t bias = next + sizes[layer] * values.size();
    for (std::size_t row = 0; row < sums.size(); ++row) {
      sums[row] = static_cast<double>(parameters[bias + row]);
      for (const double v : values) sums[row] += static_cast<double>(parameters[next++]) * v;
      if (layer + 1 < sizes.size()) sums[row] = activation(sums[row]);
    }
    next = bias + sums.size();
    values = sums;
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    // sums of at most 70 terms of order 1, five layers: far below this; a wrong instruction is far above
    if (!(std::fabs(values[i] - static_cast<double>(y[i])) <= 1e-4 * (1.0 + std::fabs(values[i])))) {
      std::printf("output %zu is %.9g instead of %.9g\n", i, static_cast<double>(y[i]), values[i]);
      return false;
    }
  }
  return true;
}

/// Gelu, SiLU, softplus, sine, ELU and leaky ReLU between seven dense layers, in double; four ways to the same outputs
/// and two to a Jacobian.
bool agrees_smoothly(const float* x, const float* y) {
  const auto p = instruction_sets::some_parameters<instruction_sets::SmoothNet>();
  std::vector<double> values(x, x + 16);
  std::size_t next = 0;
  for (int layer = 0; layer < 7; ++layer) {
    std::vector<double> sums(layer < 6 ? 9 : 4);
    for (std::size_t row = 0; row < sums.size(); ++row) {
      sums[row] = static_cast<double>(p[next + sums.size() * values.size() + row]);
      for (std::size_t i = 0; i < values.size(); ++i)
        sums[row] += static_cast<double>(p[next + row * values.size() + i]) * values[i];
    }
    next += sums.size() * (values.size() + 1);
    for (double& v : sums) {
      if (layer == 0) v = v / 2 * (1 + std::erf(v / std::sqrt(2.0)));
      if (layer == 1) v = v / (1 + std::exp(-v));
      if (layer == 2) v = std::log(1 + std::exp(v));
      if (layer == 3) v = std::sin(v);
      if (layer == 4) v = v > 0 ? v : std::exp(v) - 1;
      if (layer == 5) v = v < 0 ? 0.01 * v : v;
    }
    values = sums;
  }
  for (std::size_t way = 0; way < 4; ++way) {
    for (std::size_t i = 0; i < 4; ++i) {
      const auto value = static_cast<double>(y[4 * way + i]);
      if (!(std::fabs(value - values[i]) <= 1e-5)) {
        std::printf("way %zu, smooth output %zu is %.9g instead of %.9g\n", way, i, value, values[i]);
        return false;
      }
    }
  }
  if (!(y[16] <= 1e-5f)) std::printf("smooth Jacobians differ by %.3g\n", static_cast<double>(y[16]));
  return y[16] <= 1e-5f;
}

/// u = (n / n_max)^2 of the golden commands taken for speeds.
bool golden_speeds(const float* commands) {
  const double n_max = pinnquad::PaperQuadrotor::value<double>().max_rotor_speed_rev_s;
  for (std::size_t i = 0; i < 4; ++i) {
    const double n = static_cast<double>(instruction_sets::Model::golden_commands[0][i]);
    if (!(std::fabs(static_cast<double>(commands[i]) - n * std::fabs(n) / (n_max * n_max)) <= 1e-9)) {
      std::printf("command %zu of speeds is %.9g\n", i, static_cast<double>(commands[i]));
      return false;
    }
  }
  return true;
}

/// The golden commands taken for a wrench, and for what is added to Eq. (3) inverted, by the dynamics in double.
bool golden_outputs(const float* of_wrench, const float* of_residual) {
  using namespace pinnquad;
  const auto airframe = PaperQuadrotor::value<double>();
  const Rotors<double> rotors(airframe);
  double y[4], x[6];
  for (std::size_t i = 0; i < 4; ++i) y[i] = static_cast<double>(instruction_sets::Model::golden_commands[0][i]);
  for (std::size_t i = 0; i < 6; ++i) x[i] = static_cast<double>(instruction_sets::Model::golden_features[0][i]);
  const Commands<double> wrench = rotors.commands({{0.0, 0.0, -y[0]}, {y[1], y[2], y[3]}}, 1.0);
  const Commands<double> base = linearized_commands(airframe, rotors, {{x[0], x[1], x[2]}, {x[3], x[4], x[5]}},
                                                    standard_gravity_m_s2<double>, 1.0);
  for (std::size_t i = 0; i < 4; ++i) {
    const double first = static_cast<double>(of_wrench[i]) - wrench[i];
    const double second = static_cast<double>(of_residual[i]) - base[i] - y[i];
    if (!(std::fabs(first) <= 1e-4 * (1.0 + std::fabs(wrench[i])) &&
          std::fabs(second) <= 1e-4 * (1.0 + std::fabs(base[i])))) {
      std::printf("command %zu of a wrench is off by %.3g, of a residual by %.3g\n", i, first, second);
      return false;
    }
  }
  return true;
}

/// Dense, batch norm, ReLU, dense, in double.
bool agrees_with_norm(const float* x, const float* y) {
  constexpr std::size_t in = 16, width = 9;
  const auto p = instruction_sets::some_variances<instruction_sets::NormNet>();
  const auto at = [&p](std::size_t i) { return static_cast<double>(p[i]); };
  const std::size_t norm = in * width, last = norm + 4 * width;
  double hidden[width];
  for (std::size_t row = 0; row < width; ++row) {
    double sum = 0;
    for (std::size_t i = 0; i < in; ++i) sum += at(row * in + i) * static_cast<double>(x[i]);
    const double mean = at(norm + 2 * width + row), variance = at(norm + 3 * width + row);
    const double v =
        at(norm + row) * (sum - mean) / std::sqrt(variance + pinnquad::batch_norm_epsilon) + at(norm + width + row);
    hidden[row] = v < 0 ? 0 : v;
  }
  for (std::size_t row = 0; row < 4; ++row) {
    double sum = at(last + 4 * width + row);
    for (std::size_t i = 0; i < width; ++i) sum += at(last + row * width + i) * hidden[i];
    if (!(std::fabs(sum - static_cast<double>(y[row])) <= 1e-4 * (1.0 + std::fabs(sum)))) {
      std::printf("output %zu with batch norm is %.9g instead of %.9g\n", row, static_cast<double>(y[row]), sum);
      return false;
    }
  }
  return true;
}

bool golden_commands(const float* commands) {
  for (std::size_t i = 0; i < 4; ++i) {
    const float difference = commands[i] - instruction_sets::Model::golden_commands[0][i];
    if (!(std::fabs(static_cast<double>(difference)) <= pinnquad::golden_tolerance)) {
      std::printf("command %zu of the exported model is off by %.3g\n", i, static_cast<double>(difference));
      return false;
    }
  }
  return true;
}

}  // namespace

namespace instruction_sets {
alignas(8) unsigned char block[4096];
std::size_t block_bytes = 0;
}  // namespace instruction_sets

namespace {

/// A description as a block has it, spaces among it.
struct Description {
  std::vector<unsigned char> text;
  void add(std::string_view piece) { text.insert(text.end(), piece.begin(), piece.end()); }
  void add(int number) {
    if (number >= 10) add(number / 10);
    text.push_back(static_cast<unsigned char>('0' + number % 10));
  }
};

/// A block of the records that a block must have, written without the rooms that do not fly.
void write_block() {
  using namespace pinnquad;
  using instruction_sets::block;
  using instruction_sets::Model;
  using Header = ModelBlockHeader;
  using Layout = ModelBlockLayout<Model>;
  constexpr std::size_t golden = Model::golden_features.size();
  const auto number = [](std::size_t at, std::uint64_t value, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; ++i) block[at + i] = static_cast<unsigned char>(value >> (8 * i));
  };
  std::size_t end = Header::size + Header::record_counts;
  std::uint32_t count = 0;
  const auto record = [&](BlockRecord type, const std::vector<unsigned char>& bytes) {
    number(end, static_cast<unsigned>(type) | mandatory_record, 4);
    number(end + 4, bytes.size(), 4);
    std::memcpy(block + end + Header::record_head, bytes.data(), bytes.size());
    end += Header::record_head + Header::padded(bytes.size());
    ++count;
  };
  const auto bytes_of = [](const auto&... values) {
    std::vector<unsigned char> bytes;
    const auto add = [&bytes](const auto& value) {
      const std::size_t at = bytes.size();
      bytes.resize(at + sizeof value);
      std::memcpy(bytes.data() + at, &value, sizeof value);
    };
    (add(values), ...);
    return bytes;
  };
  const auto append = [](std::vector<unsigned char>& bytes, const std::vector<unsigned char>& more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
  };
  const auto texts = [](std::vector<unsigned char> bytes, const auto& names, const auto& units) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      for (const char* text : {names[i], units[i]}) bytes.insert(bytes.end(), text, text + std::strlen(text) + 1);
    }
    return bytes;
  };
  const auto letters = [](const auto& text) { return std::vector<unsigned char>(text.text, text.text + text.count); };
  using Vehicle = Model::Vehicle;
  record(BlockRecord::commands, bytes_of(std::uint32_t{0}, std::uint32_t{0}, 0.0f, 1.0f));
  record(BlockRecord::clock, bytes_of(std::uint32_t{0}, std::uint32_t{0}));
  record(BlockRecord::window, bytes_of(std::uint32_t{1}, std::uint32_t{1}));
  record(BlockRecord::allocation, bytes_of(allocation(airframe_value<Vehicle, float>())));
  Description answer;
  pinnquad::detail::describe<Model::Network>(answer);
  record(BlockRecord::answer, answer.text);
  record(BlockRecord::features, texts({}, Model::Features::names, Model::Features::units));
  auto schema = letters(pinnquad::detail::description_letters<Model::Outputs>());
  schema.push_back(0);
  record(BlockRecord::outputs, texts(schema, OutputMap<Model::Outputs>::names, OutputMap<Model::Outputs>::units));
  std::vector<unsigned char> vehicle;
  const auto exact = airframe_value<Vehicle, double>();
  const auto flown = airframe_value<Vehicle, float>();
  each_number(exact, [&](auto number) { append(vehicle, bytes_of(static_cast<double>(number))); });
  each_number(flown, [&](auto number) { append(vehicle, bytes_of(static_cast<float>(number))); });
  vehicle.insert(vehicle.end(), Vehicle::name, Vehicle::name + std::strlen(Vehicle::name));
  record(BlockRecord::vehicle, vehicle);
  record(BlockRecord::contents, bytes_of(Model::contents_hash, std::uint64_t{0}));
  const std::size_t own = end - 8;
  number(Header::size, count, 4);
  number(Header::size + 4, end - Header::size - Header::record_counts, 4);
  const std::size_t length = static_cast<std::size_t>(Layout::length(golden)) + end - Header::size;
  const auto scalars = [end](std::size_t at, const auto& values) {
    std::memcpy(block + end + at * sizeof(float), &values, sizeof values);
  };
  std::memcpy(block, &model_block_magic, sizeof model_block_magic);
  number(Header::version, model_format_version, 4);
  number(Header::length, length, 4);
  number(Header::scalar_bytes, sizeof(float), 4);
  number(Header::inputs, Layout::inputs, 4);
  number(Header::outputs, Layout::outputs, 4);
  number(Header::parameters, Layout::parameter_count, 4);
  number(Header::golden_vectors, golden, 4);
  number(Header::training_rows, Model::training_rows, 4);
  number(Header::shape_hash, shape_hash<Model>, 8);
  number(Header::training_data_hash, Model::training_data_hash, 8);
  scalars(Layout::input_mean, Model::input.mean);
  scalars(Layout::input_deviation, Model::input.standard_deviation);
  scalars(Layout::output_mean, Model::output.mean);
  scalars(Layout::output_deviation, Model::output.standard_deviation);
  scalars(Layout::envelope_lower, Model::envelope_lower);
  scalars(Layout::envelope_upper, Model::envelope_upper);
  scalars(Layout::golden_features, Model::golden_features);
  scalars(Layout::golden_commands(golden), Model::golden_commands);
  scalars(Layout::parameters(golden), Model::parameters);
  const std::size_t hashed = length - Header::checksum_size;
  number(own, pinnquad::detail::hash_of_block(block, hashed, block + own), 8);
  number(hashed, crc32(block, hashed), 4);
  instruction_sets::block_bytes = length;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace instruction_sets;
  void (*predict)(const float*, float*) = predict_baseline;
#if defined(WITH_OTHERS)
  if (argc > 1 && std::strcmp(argv[1], "avx2") == 0) predict = predict_avx2;
  if (argc > 1 && std::strcmp(argv[1], "avx512") == 0) predict = predict_avx512;
#else
  static_cast<void>(argc);
  static_cast<void>(argv);
#endif
  float x[16];
  for (int i = 0; i < 16; ++i) x[i] = 0.125f * static_cast<float>(i) - 1.0f;
  write_block();
  float y[outputs] = {};
  predict(x, y);
  const auto relu = [](double v) { return v < 0.0 ? 0.0 : v; };
  const auto tanh = [](double v) { return std::tanh(v); };
  const bool ok = agrees({16, 25, 25, 25, 4}, some_parameters<Net>(), x, y, relu) &&
                  agrees({16, 70, 4}, some_parameters<WideNet>(), x, y + 4, tanh) &&
                  agrees({16, 25, 25, 25, 4}, some_parameters<Net>(), x, y + 8, relu) && golden_commands(y + 12) &&
                  golden_speeds(y + 16) && golden_commands(y + 20) && golden_commands(y + 24) &&
                  agrees_with_norm(x, y + 28) && agrees_smoothly(x, y + 32) && golden_outputs(y + 49, y + 53);
  std::puts(ok ? "predicts" : "predicts something else");
  return ok ? 0 : 1;
}
