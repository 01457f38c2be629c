// SPDX-License-Identifier: MIT
// What `pinnquad replay` must say of a flight: compiled models asked row by row, each by InverseDynamics with the guard that a
// user would write. One is an exported header; the other, of double, further features and another output schema, is made here
// and written as a block.
//   replay_log_judge FLIGHT.csv FOLDER
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "models/demo_quadrotor.hpp"
#include "pinnquad/core/random.hpp"
#include "pinnquad/deploy/weight_file.hpp"
#include "pinnquad/flight.hpp"

namespace {

using namespace pinnquad;

using Row = std::array<double, 21>;

/// NaN is a number here.
std::vector<Row> read_rows(const char* path) {
  std::ifstream file(path);
  std::vector<Row> rows;
  std::string line;
  for (std::getline(file, line); std::getline(file, line);) {
    Row row{};
    const char* at = line.c_str();
    for (double& value : row) {
      char* end = nullptr;
      value = std::strtod(at, &end);
      if (end == at) value = std::nan("");
      at = *end == ',' ? end + 1 : end;
    }
    rows.push_back(row);
  }
  return rows;
}

/// By half angles.
template <class Inputs>
Inputs inputs_of(const Row& r) {
  using Scalar = std::decay_t<decltype(Inputs{}.attitude.w)>;
  Inputs in;
  for (int i = 0; i < 3; ++i) {
    in.linear_acceleration_m_s2[i] = Scalar(r[std::size_t(1 + i)]);
    in.angular_acceleration_rad_s2[i] = Scalar(r[std::size_t(4 + i)]);
    in.velocity_m_s[i] = Scalar(r[std::size_t(7 + i)]);
    in.body_rates_rad_s[i] = Scalar(r[std::size_t(10 + i)]);
  }
  const double cr = std::cos(r[13] / 2), sr = std::sin(r[13] / 2), cp = std::cos(r[14] / 2), sp = std::sin(r[14] / 2),
               cy = std::cos(r[15] / 2), sy = std::sin(r[15] / 2);
  in.attitude = {Scalar(cr * cp * cy + sr * sp * sy), Scalar(sr * cp * cy - cr * sp * sy),
                 Scalar(cr * sp * cy + sr * cp * sy), Scalar(cr * cp * sy - sr * sp * cy)};
  if constexpr (std::is_same_v<Inputs, MotionInputsWithAltitude<Scalar>>) in.altitude_m = Scalar(r[16]);
  return in;
}

struct Absurd {
  static constexpr double lower = -0.5, upper = 1.5;
};
using Formula = AnalyticInverse<Quadrotor<float, QuadraticDrag>>;
using FallingBack = Extend<TrainingGuard, RefuseCommands<Absurd>, Fallback<Formula>>;

template <class Inverse>
void judge(const std::vector<Row>& rows, const Inverse& inverse, const std::string& path) {
  std::ofstream file(path);
  file.precision(17);
  for (const Row& row : rows) {
    Commands<typename Inverse::Scalar> u{};
    typename Inverse::Report report;
    const Status status = inverse.predict(inputs_of<typename Inverse::Inputs>(row), u, report);
    file << to_string(status) << ' ' << to_string(report.cause);
    for (const auto command : u) file << ' ' << (has_output(status) ? double(command) : std::nan(""));
    file << '\n';
  }
}

struct Speeds {
  using Scalar = double;
  using Network = pinnquad::Network<double, InputSize<17>, Dense<12>, Tanh, Dense<12>, Tanh, Dense<4>>;
  using Features = PaperFeaturesWithAltitude;
  using Outputs = RotorSpeedOutputs;
  using Vehicle = PaperQuadrotor;
};

/// Random weights; rows beyond 2.2 spreads lie outside its envelope.
std::vector<unsigned char> speeds_block(const std::vector<Row>& rows) {
  TrainedModel<Speeds::Network, Context<Speeds::Features, Speeds::Vehicle, Speeds::Outputs>> model;
  std::mt19937_64 engine(11);
  for (double& weight : model.network.parameters) weight = uniform(engine, -0.4, 0.4);
  using Inputs = MotionInputsWithAltitude<double>;
  std::vector<std::array<double, 17>> all;
  for (const Row& row : rows) {
    std::array<double, 17> x{};
    Speeds::Features::extract(inputs_of<Inputs>(row), x.data());
    if (std::all_of(x.begin(), x.end(), [](double v) { return std::isfinite(v); })) all.push_back(x);
  }
  for (std::size_t i = 0; i < 17; ++i) {
    double sum = 0, squares = 0;
    for (const auto& x : all) sum += x[i];
    const double mean = sum / double(all.size());
    for (const auto& x : all) squares += (x[i] - mean) * (x[i] - mean);
    const double spread = std::sqrt(squares / double(all.size())) + 1e-3;
    model.input.mean[i] = mean;
    model.input.spread[i] = spread;
    model.envelope_lower[i] = mean - 2.2 * spread;
    model.envelope_upper[i] = mean + 2.2 * spread;
  }
  for (std::size_t i = 0; i < 4; ++i) model.output.mean[i] = 140, model.output.spread[i] = 25;
  std::array<double, 17> golden = model.input.mean;
  return model_block(model, {golden}, {});
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) return std::fprintf(stderr, "replay_log_judge FLIGHT.csv FOLDER\n"), 2;
  const std::vector<Row> rows = read_rows(arguments[1]);
  const std::string folder = std::string(arguments[2]) + "/";
  const FallingBack guard(Formula(Quadrotor<float, QuadraticDrag>(airframe_value<PaperQuadrotor, float>())));
  judge(rows, InverseDynamics<DemoQuadModel>(), folder + "demo_training.txt");
  judge(rows, InverseDynamics<DemoQuadModel, FallingBack>(guard), folder + "demo_flight_stack.txt");
  const std::vector<unsigned char> block = speeds_block(rows);
  write_weight_file(folder + "speeds.block", block);
  using View = ModelView<Speeds>;
  View view;
  if (View::open(block.data(), block.size(), view) != Status::ok) return 1;
  judge(rows, InverseDynamics<View>(view), folder + "speeds_training.txt");
  judge(rows, InverseDynamics<View, FallingBack>(view, guard), folder + "speeds_flight_stack.txt");
  return 0;
}
