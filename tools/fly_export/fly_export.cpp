// SPDX-License-Identifier: MIT
// Flies an exported model with nothing of the trainer: the flight headers, the exported one, and a program's edge.
//   1. self test   2. replay of the test flight against what the trainer predicted   3. closed loop in the simulator
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <model.hpp>  // the exported one, by the configuration

#include "command_line/console.hpp"
#include "command_line/held_columns.hpp"
#include "command_line/options.hpp"
#include "flight/loop_trajectories.hpp"
#include "flight/model_range.hpp"
#include "pinnquad/flight.hpp"
#include "pinnquad/io/text_file.hpp"
#include "pinnquad/simulation/tracking.hpp"

namespace {

using namespace pinnquad;

using Model = TrainedQuadModel;
using Scalar = Model::Scalar;

constexpr double agreement_tolerance = 1e-6;  // float rounding of another order of summation, commands in 0..1
constexpr double fallback_limit = 0.05;       // more, and it is not the export that flies

/// The exported model with all its numbers zero: what they contribute is what this one lacks.
struct ZeroedModel : Model {
  static constexpr ModelKind kind = ModelKind::instance;
  static constexpr std::array<Scalar, Model::parameters.size()> parameters{};
  void forward(const Scalar* x, Scalar* y) const noexcept { Network::forward(parameters.data(), x, y); }
};

/// A model that is shown the altitude flies near the ground, where it was trained.
constexpr bool knows_altitude = std::is_base_of_v<MotionInputsWithAltitude<Scalar>, Model::Inputs>;

/// False of a model with a window or a column.
constexpr bool asks_for_motion = !is_windowed<Model::Features> && extra_column_names<Model::Features>.size() == 0;

/// Numbers of a row before the commands: the motion, and the altitude; of a model that asks for more, its features.
constexpr std::size_t asked_numbers = !asks_for_motion ? static_cast<std::size_t>(Model::Features::size)
                                      : knows_altitude ? 17
                                                       : 16;
using Asked = std::conditional_t<asks_for_motion, Model::Inputs, std::array<Scalar, Model::Features::size>>;

/// Of a model that asks for it.
template <class Inputs>
void set_altitude([[maybe_unused]] Inputs& inputs, [[maybe_unused]] double altitude_m) noexcept {
  if constexpr (knows_altitude) inputs.altitude_m = Scalar(altitude_m);
}

template <class Numbers>
void read_asked(const Numbers& v, Model::Inputs& inputs) noexcept {
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    inputs.linear_acceleration_m_s2[i] = Scalar(v[k]);
    inputs.angular_acceleration_rad_s2[i] = Scalar(v[3 + k]);
    inputs.velocity_m_s[i] = Scalar(v[6 + k]);
    inputs.body_rates_rad_s[i] = Scalar(v[9 + k]);
  }
  inputs.attitude = {Scalar(v[12]), Scalar(v[13]), Scalar(v[14]), Scalar(v[15])};
  set_altitude(inputs, v[16]);
}
template <class Numbers>
void read_asked(const Numbers& v, std::array<Scalar, Model::Features::size>& features) noexcept {
  for (std::size_t i = 0; i < features.size(); ++i) features[i] = Scalar(v[i]);
}

template <class Inverse>
Status ask(const Inverse& inverse, const Model::Inputs& inputs, Commands<Scalar>& commands) noexcept {
  return inverse.predict(inputs, commands);
}
template <class Inverse>
Status ask(const Inverse& inverse, const std::array<Scalar, Model::Features::size>& features,
           Commands<Scalar>& commands) noexcept {
  return inverse.predict_features(features.data(), commands);
}

template <class AskedType>
Scalar& first_number(AskedType& asked) noexcept {
  if constexpr (asks_for_motion) {
    return asked.velocity_m_s[0];
  } else {
    return asked[0];
  }
}

/// A row of the replay file, as `train` writes it.
struct ReplayRow {
  Asked asked;
  std::array<double, rotor_count> predicted{};
  std::array<double, rotor_count> flown{};
};

/// Reads the replay file. Throws InputError, one line.
std::vector<ReplayRow> read_replay(const std::string& path) {
  require_regular_file(path);
  std::ifstream file(path);
  if (!file) throw InputError(path, 0, 0, "a readable file", "none");
  std::string magic;
  int version = 0, columns = 0;
  std::size_t rows = 0;
  std::array<double, asked_numbers + 2 * rotor_count> v{};
  file >> magic >> version >> rows >> columns;
  const std::string expected = asks_for_motion ? "pinnquad-replay" : "pinnquad-replay-features";
  if (!file || magic != expected || version != 1 || columns != int(v.size()) || rows == 0) {
    throw InputError(path, 1, 0, "'" + expected + " 1 <rows> " + std::to_string(v.size()) + "'", "something else");
  }
  std::vector<ReplayRow> result;
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t i = 0; i < v.size(); ++i) {
      if (!(file >> v[i])) {
        throw InputError(path, row + 2, i + 1, "a number", file.eof() ? "the end of the file" : "something else");
      }
    }
    ReplayRow r;
    read_asked(v, r.asked);
    for (std::size_t i = 0; i < rotor_count; ++i) {
      r.predicted[i] = v[asked_numbers + i];
      r.flown[i] = v[asked_numbers + rotor_count + i];
    }
    result.push_back(r);
  }
  return result;
}

/// Replays the test flight. True if every answer agrees with the trainer's.
template <class Inverse>
bool replay(const Inverse& inverse, const std::vector<ReplayRow>& rows) {
  double worst = 0, error = 0;
  std::size_t answered = 0, outside = 0;
  for (const ReplayRow& row : rows) {
    Commands<Scalar> commands{};
    const Status status = ask(inverse, row.asked, commands);
    if (status == Status::outside_envelope) ++outside;
    if (status != Status::ok) continue;
    ++answered;
    for (std::size_t i = 0; i < rotor_count; ++i) {
      const double u = static_cast<double>(commands[i]);
      worst = std::max(worst, std::abs(u - row.predicted[i]));
      error += std::abs(u - row.flown[i]) / rotor_count;
    }
  }
  const bool agrees = answered > 0 && worst <= agreement_tolerance;
  std::printf("  replay       %zu samples, %zu outside the training envelope (%.2f %%)\n", rows.size(), outside,
              100.0 * static_cast<double>(outside) / static_cast<double>(rows.size()));
  std::printf("               largest difference from the trainer %.1e (limit %.0e): %s\n", worst, agreement_tolerance,
              agrees ? "agrees" : "DISAGREES");
  std::printf("               mean absolute error against the flown commands %.2fe-3\n",
              1e3 * error / static_cast<double>(answered > 0 ? answered : 1));
  return agrees;
}

/// Nanoseconds per answer, best of several passes over the replay: each call depends on the one before.
template <class Inverse>
double nanoseconds_per_prediction(const Inverse& inverse, const std::vector<ReplayRow>& rows) {
  using Clock = std::chrono::steady_clock;
  constexpr int passes = 40;
  double best = 1e300;
  Commands<Scalar> commands{};
  Scalar sink(0);
  for (int pass = 0; pass < passes; ++pass) {
    const auto start = Clock::now();
    for (const ReplayRow& row : rows) {
      Asked asked = row.asked;
      first_number(asked) += commands[0] * Scalar(1e-12);  // chains the calls
      const Status status = ask(inverse, asked, commands);
      sink += status == Status::ok ? commands[1] : Scalar(0);
    }
    const double ns = std::chrono::duration<double, std::nano>(Clock::now() - start).count();
    best = std::min(best, ns / static_cast<double>(rows.size()));
  }
  if (!is_finite(sink)) std::printf("  (not finite)\n");  // keeps the results alive
  return best;
}

using Distant = Quadrotor<double, StandardAtmosphere, QuadraticDrag>;
using NearGround = Quadrotor<double, StandardAtmosphere, QuadraticDrag, GroundEffect<Conyers>>;
using Vehicle = std::conditional_t<knows_altitude, NearGround, Distant>;

constexpr auto column_names = extra_column_names<Model::Features>;
constexpr auto column_units = extra_column_units<Model::Features>;
using Columns = std::array<Scalar, column_names.size()>;

/// Measured beside the motion: the height above the ground, exactly; columns that stand still.
struct Measured {
  double ground_z_m = 0;
  Columns columns{};

  template <class Inputs>
  void operator()(const State<double>& state, std::uint64_t, Inputs& present) const noexcept {
    set_altitude(present, ground_z_m - state.position_m[2]);
    set_columns(present, columns.data());
  }
};

/// Values that the columns stand at in the closed loop.
Columns column_values(const std::vector<std::string>& given) {
  const std::vector<double> held = programs::held_columns(programs::range_of_header<Model>().columns(), given);
  Columns columns{};
  for (std::size_t i = 0; i < columns.size(); ++i) columns[i] = Scalar(held[i]);
  return columns;
}

template <class Trajectory, class FeedForward>
TrackingResult<double> fly(const char* label, const Vehicle& vehicle, const Trajectory& trajectory,
                           const FeedForward& feed_forward) {
  const double rotor_scale = vehicle.rotor_scale(vehicle.surroundings({}, 0));
  const FlightController<double> controller({}, flight_limits(vehicle.airframe(), rotor_scale));
  const TrackingResult<double> r = track(vehicle, trajectory, controller, feed_forward);
  char fallback[48] = "-";
  if (r.fallback.asked > 0) {
    std::snprintf(fallback, sizeof fallback, "%u of %u (%.2f %%)", r.fallback.fallbacks(), r.fallback.asked,
                  100.0 * r.fallback.fallbacks() / r.fallback.asked);
  }
  const Status ended = r.status != Status::ok ? r.status : r.declined;
  std::printf("  %-28s %8.2f %8.2f %9.2f   %-22s%s\n", label, 100 * r.rmse_m, 100 * r.max_error_m, r.max_speed_m_s,
              fallback, ended == Status::ok ? "" : to_string(ended));
  return r;
}

/// The closed loop. True if the export flew it, mostly by itself, and its weights were worth having.
template <class Flown>
bool closed_loop(const Flown& model, const Columns& columns) {
  const Vehicle vehicle(airframe_value<Model::Vehicle, double>(), paper_site<double>());
  if (vehicle.status() != Status::ok) {
    programs::complain("fly_export",
                       std::string("this airframe can't be flown near the ground: ") + to_string(vehicle.status()));
    return false;
  }
  const auto range = programs::range_of_header<Model>();
  const auto held = programs::eight_for(vehicle.airframe(), vehicle.site().ground_z_m, range);
  if (!held) {
    programs::complain("fly_export", "the model's envelope holds no figure-eight, however slow");
    return false;
  }
  const FigureEight<double>& trajectory = *held;
  const AnalyticInverse<Vehicle> analytic(vehicle);
  const Measured measured{vehicle.site().ground_z_m, columns};
  std::printf(
      "  closed loop  figure-eight, period %.1f s, %.0f s at 1 kHz, commands at 500 Hz; same feedback throughout\n",
      trajectory.period_s, TrackingPlan<double>{}.duration_s);
  if constexpr (knows_altitude) {
    const double middle = measured.ground_z_m - trajectory.center_m[2];
    std::printf("               in ground effect, %.2f to %.2f m above the ground\n", middle - trajectory.half_height_m,
                middle + trajectory.half_height_m);
  }
  for (std::size_t i = 0; i < columns.size(); ++i) {
    std::printf("               %s held at %g %s\n", printable(column_names[i]).c_str(), double(columns[i]),
                printable(column_units[i]).c_str());
  }
  std::printf("  %-28s %8s %8s %9s   %s\n", "feed-forward", "RMSE cm", "max cm", "speed m/s", "fell back to analytic");
  using Guard = Extend<TrainingGuard, Fallback<AnalyticInverse<Vehicle>>>;
  using Guarded = InverseDynamics<Flown, Guard>;
  using Zeroed = InverseDynamics<ZeroedModel, Guard>;
  const auto exported =
      fly("export", vehicle, trajectory, NetworkInverse<Guarded, Measured>(Guarded(model, analytic), measured));
  fly("analytic inverse", vehicle, trajectory, analytic);
  if constexpr (knows_altitude) {
    fly("analytic, no ground effect", vehicle, trajectory,
        AnalyticInverse<Distant>(Distant(vehicle.airframe(), vehicle.site(), {}, {})));
  }
  fly("the same, no jerk", vehicle, WithoutJerk{trajectory}, analytic);
  const auto zeroed =
      fly("export, weights zeroed", vehicle, trajectory, NetworkInverse<Zeroed, Measured>(Zeroed(analytic), measured));
  const double fallbacks = static_cast<double>(exported.fallback.fallbacks()) / exported.fallback.asked;
  if (fallbacks > fallback_limit) {
    std::printf("  the export declined %.1f %% of the samples: more than %.0f %%\n", 100 * fallbacks,
                100 * fallback_limit);
  }
  return exported.status == Status::ok && fallbacks <= fallback_limit && exported.rmse_m < zeroed.rmse_m;
}

/// Self test, replay, speed, closed loop: the exit code.
template <class Flown>
int fly_model(const Flown& model, const std::vector<ReplayRow>& rows, const Columns& columns) {
  const InverseDynamics<Flown> inverse(model);
  const Status tested = self_test(inverse);
  std::printf("  self test    %zu golden vectors: %s\n", model.golden_features.size(), to_string(tested));
  if (tested != Status::ok) return programs::exit_failed;
  const bool agrees = replay(inverse, rows);
  std::printf("  speed        %.0f ns per %s\n", nanoseconds_per_prediction(inverse, rows),
              asks_for_motion ? "predict(), checks and features included" : "predict_features(), checks included");
  const bool flew = closed_loop(model, columns);
  if (!agrees || !flew) programs::complain("fly_export", "the export does not fly as it should");
  return agrees && flew ? 0 : programs::exit_failed;
}

/// The same for the weights of a block that a later training has written for this header.
int fly_block(const std::string& path, const std::vector<ReplayRow>& rows, const Columns& columns) {
  require_regular_file(path);
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> block{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  static ModelView<Model>::Packed packed;
  ModelView<Model> view;
  const Status opened = ModelView<Model>::open(block.data(), block.size(), view, packed);
  if (!file || opened != Status::ok) {
    programs::complain("fly_export", path + ": " + (file ? to_string(opened) : "no such readable file"));
    return programs::exit_bad_input;
  }
  std::printf("  block        %s, %zu bytes, trained on %u rows\n", path.c_str(), block.size(), view.training_rows);
  return fly_model(view, rows, columns);
}

int run(int argument_count, char** arguments) {
  std::string path, block;
  std::vector<std::string> given;
  CLI::App app{"Flies an exported model: self test, replay of its test flight, closed loop.", "fly_export"};
  app.footer("Exit codes: 0; 1 the export does not fly as it should; 2 bad input or a file that can't be read.");
  programs::add_path(app, "--replay", path, "FILE", "the test flight and the trainer's predictions, written by train")
      ->required();
  programs::add_path(app, "--block", block, "FILE",
                     "fly the weights of this model block, written by train, instead of the header's");
  app.add_option("--column", given,
                 "the value at which a column that the model asks for is held in the closed loop, in place of the "
                 "middle of its training envelope: --column battery_voltage=15.2")
      ->type_name("NAME=VALUE");
  if (const std::optional<int> code = programs::parse_command_line(app, argument_count, arguments)) return *code;
  const Columns columns = column_values(given);
  const std::vector<ReplayRow> rows = read_replay(path);
  std::printf("  model        %s, %d parameters in %zu bytes, trained on %s (%d rows)\n", Model::name,
              Model::Network::parameter_count, sizeof Model::parameters, Model::training_data, Model::training_rows);
  return block.empty() ? fly_model(Model{}, rows, columns) : fly_block(block, rows, columns);
}

}  // namespace

int main(int argument_count, char** arguments) {
  return programs::run_program("fly_export", [&] { return run(argument_count, arguments); });
}
