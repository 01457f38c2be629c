// SPDX-License-Identifier: MIT
// The judge of `pinnquad replay`: compiled models asked row by row, each by InverseDynamics with the guard that a
// user would write. One is an exported header; the others are made here and written as blocks: one of double with
// further features and another output schema, one as `train` fits it to logs, whose window a control loop's
// InputHistory fills.
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

using Row = std::array<double, 22>;  ///< a flight's columns, then the battery's voltage

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

/// Random weights, scaled by the rows; what lies beyond `spreads` of them is outside its envelope.
template <class Model, class Features>
void fill(Model& model, const std::vector<std::array<typename Model::Scalar, std::size_t(Features::size)>>& all,
          double spreads) {
  using Scalar = typename Model::Scalar;
  std::mt19937_64 engine(11);
  for (Scalar& weight : model.network.parameters) weight = Scalar(uniform(engine, -0.4, 0.4));
  for (std::size_t i = 0; i < std::size_t(Features::size); ++i) {
    double sum = 0, squares = 0;
    for (const auto& x : all) sum += double(x[i]);
    const double mean = sum / double(all.size());
    for (const auto& x : all) squares += (double(x[i]) - mean) * (double(x[i]) - mean);
    const double spread = std::sqrt(squares / double(all.size())) + 1e-3;
    model.input.mean[i] = Scalar(mean);
    model.input.standard_deviation[i] = Scalar(spread);
    model.envelope_lower[i] = Scalar(mean - spreads * spread);
    model.envelope_upper[i] = Scalar(mean + spreads * spread);
  }
}

template <class Array>
bool finite(const Array& x) {
  return std::all_of(x.begin(), x.end(), [](auto v) { return std::isfinite(double(v)); });
}

/// As train fits to logs: a ridge and a network on what it leaves.
struct Physics {
  using Scalar = float;
  using Features = PartlyWindowed<WithColumns<PhysicsFeatures, BatteryVoltage>, AccelerationFeatures, 9,
                                  PeriodMicroseconds<20000>, Causal>;
  using Network = Sum<pinnquad::Network<float, InputSize<Features::size>, Dense<4>>,
                      pinnquad::Network<float, InputSize<Features::size>, Clip, Dense<8>, Silu, Dense<4>>>;
  using Outputs = CommandOutputs;
  using Vehicle = PaperQuadrotor;
};
using PhysicsHistory = InputHistory<Physics::Features, float>;

/// Calls `use(inputs)` with what a control loop's history makes of each row.
template <class Use>
void each_window(const std::vector<Row>& rows, const Use& use) {
  PhysicsHistory history;
  for (const Row& row : rows) {
    PhysicsHistory::Present present;
    static_cast<MotionInputs<float>&>(present) = inputs_of<MotionInputs<float>>(row);
    present.column<BatteryVoltage>() = float(row[21]);
    use(history.take(present, row[0]), history.inputs());
  }
}

std::vector<unsigned char> physics_block(const std::vector<Row>& rows) {
  TrainedModel<Physics::Network, Context<Physics::Features, Physics::Vehicle>> model;
  std::vector<std::array<float, std::size_t(Physics::Features::size)>> all;
  each_window(rows, [&all](Status status, const auto& inputs) {
    if (status != Status::ok) return;
    all.emplace_back();
    Physics::Features::extract(inputs, all.back().data());
    if (!finite(all.back())) all.pop_back();
  });
  fill<decltype(model), Physics::Features>(model, all, 4);
  for (std::size_t i = 0; i < 4; ++i) model.output.mean[i] = 0.5f, model.output.standard_deviation[i] = 0.05f;
  return model_block(model, {model.input.mean}, {});
}

template <class Inverse>
void judge_windows(const std::vector<Row>& rows, const Inverse& inverse, const std::string& path) {
  std::ofstream file(path);
  file.precision(17);
  each_window(rows, [&](Status, const auto& inputs) {
    Commands<float> u{};
    typename Inverse::Report report;
    const Status status = inverse.predict(inputs, u, report);
    file << to_string(status) << ' ' << to_string(report.cause);
    for (const float command : u) file << ' ' << (has_output(status) ? double(command) : std::nan(""));
    file << '\n';
  });
}

struct Speeds {
  using Scalar = double;
  using Network = pinnquad::Network<double, InputSize<17>, Dense<12>, Tanh, Dense<12>, Tanh, Dense<4>>;
  using Features = PaperFeaturesWithAltitude;
  using Outputs = RotorSpeedOutputs;
  using Vehicle = PaperQuadrotor;
};

std::vector<unsigned char> speeds_block(const std::vector<Row>& rows) {
  TrainedModel<Speeds::Network, Context<Speeds::Features, Speeds::Vehicle, Speeds::Outputs>> model;
  using Inputs = MotionInputsWithAltitude<double>;
  std::vector<std::array<double, 17>> all;
  for (const Row& row : rows) {
    std::array<double, 17> x{};
    Speeds::Features::extract(inputs_of<Inputs>(row), x.data());
    if (finite(x)) all.push_back(x);
  }
  fill<decltype(model), Speeds::Features>(model, all, 2.2);
  for (std::size_t i = 0; i < 4; ++i) model.output.mean[i] = 140, model.output.standard_deviation[i] = 25;
  return model_block(model, {model.input.mean}, {});
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
  const std::vector<unsigned char> windowed = physics_block(rows);
  write_weight_file(folder + "physics.block", windowed);
  using WindowView = ModelView<Physics>;
  WindowView looks_back;
  if (WindowView::open(windowed.data(), windowed.size(), looks_back) != Status::ok) return 1;
  judge_windows(rows, InverseDynamics<WindowView>(looks_back), folder + "physics_training.txt");
  judge_windows(rows, InverseDynamics<WindowView, FallingBack>(looks_back, guard), folder + "physics_flight_stack.txt");
  return 0;
}
