// SPDX-License-Identifier: MIT
// Flies an exported model in a simulator, by the controller that flies it in PX4 and on a Crazyflie: a figure-eight,
// whose vehicle carries a fifth more mass from half time on. Prints the errors and draws a moving picture of them.
//   fly_model MODEL.block PICTURE.svg       compiled with the folder of model.hpp as an include path
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "model.hpp"  // the exported header
#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/payload.hpp"
#include "pinnquad/control/autopilot/neural_controller.hpp"
#include "pinnquad/control/trajectory.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "pinnquad/simulation/tracking.hpp"

using namespace pinnquad;

constexpr double duration_s = 30, step_s = 0.001;
using Core = autopilot::NeuralController<TrainedQuadModel>;
using Flown = Quadrotor<double, StandardAtmosphere, QuadraticDrag, Payload>;

/// A flight, tick by tick.
struct Flight {
  std::vector<double> errors_m;  ///< distance from the path
  std::vector<Vector3<double>> positions_m;

  void add(const Vector3<double>& wanted_m, const Vector3<double>& flown_m) {
    errors_m.push_back((wanted_m - flown_m).norm());
    positions_m.push_back(flown_m);
  }
};

FigureEight<double> eight() {
  FigureEight<double> path;
  path.center_m[2] = -20;
  return path;
}

Flown loaded_vehicle() {
  const auto airframe = airframe_value<TrainedQuadModel::Vehicle, double>();
  const Payload payload{0.2 * airframe.mass_kg, duration_s / 2};
  return Flown(airframe, paper_site<double>(), StandardAtmosphere{}, QuadraticDrag{}, payload);
}

template <class Vector>
Vector3<float> in_float(const Vector& v) {
  return v.template cast<float>();
}

/// By the core of an autopilot. Throws std::runtime_error where it gives up.
Flight fly_core(const std::vector<char>& block, bool learns) {
  autopilot::CoreSettings settings;
  if (!learns)
    std::fill(std::begin(settings.most_bias), std::end(settings.most_bias), 0.0f), settings.most_across_m_s2 = 0;
  Core core(settings);
  const Status offered = core.offer_model(block.data(), block.size());
  if (offered != Status::ok) throw std::runtime_error(std::string("the model is refused: ") + to_string(offered));
  core.situation({true, false});

  const Flown vehicle = loaded_vehicle();
  const FigureEight<double> path = eight();
  VehicleState<double> state;
  state.body.position_m = path.center_m;
  Commands<double> hover{};
  if (hover_trim(vehicle, path.center_m, hover) != Status::ok) throw std::runtime_error("the vehicle can't hover");
  state.rotors = hover;
  Flight flight;
  for (int tick = 0; tick < std::lround(duration_s / step_s); ++tick) {
    const auto now_us = static_cast<std::uint64_t>(1'000'000 + 1000 * tick);
    state.time_s = step_s * tick;
    const State<double>& body = state.body;
    const TrajectoryPoint<double> point = path.sample(state.time_s);
    flight.add(point.position_m, body.position_m);
    const Quaternion<double>& q = body.attitude;
    const autopilot::LocalState local{in_float(body.position_m), in_float(body.velocity_m_s)};
    const TrajectoryPoint<float> asked{in_float(point.position_m), in_float(point.velocity_m_s),
                                       in_float(point.acceleration_m_s2), in_float(point.jerk_m_s3)};
    for (const Status taken : {core.body_rates(now_us, in_float(body.body_rates_rad_s)),
                               core.attitude(now_us, {float(q.w), float(q.x), float(q.y), float(q.z)}),
                               core.local(now_us, local), core.set_point(now_us, asked)}) {
      if (taken != Status::ok) throw std::runtime_error(std::string("a sample is refused: ") + to_string(taken));
    }
    Commands<float> commands{};
    autopilot::StepReport report;
    if (core.step(now_us, commands, report) != autopilot::Reaction::flies) throw std::runtime_error("the core gave up");
    Commands<double> u{};
    for (std::size_t i = 0; i < u.size(); ++i) u[i] = double(commands[i]);
    if (vehicle.step(state, u, step_s) != Status::ok) throw std::runtime_error("the flight ended early");
  }
  return flight;
}

/// By the vehicle's own equations, without a model.
Flight fly_analytic() {
  const Quadrotor<double, StandardAtmosphere, QuadraticDrag> known(airframe_value<TrainedQuadModel::Vehicle, double>(),
                                                                   paper_site<double>());
  const Flown flown = loaded_vehicle();
  ExactWorld<Flown> world{flown};
  Flight flight;
  const auto result = track(known, world, eight(), FlightController<double>({}, flight_limits(known.airframe(), 1.0)),
                            AnalyticInverse<std::decay_t<decltype(known)>>(known), {duration_s, step_s, 1},
                            [&](double, const auto& point, const auto& state, const auto&) {
                              flight.add(point.position_m, state.body.position_m);
                            });
  if (result.status != Status::ok) throw std::runtime_error("the flight ended early");
  return flight;
}

/// RMSE before and after half time, from a second after each begins on; cm.
void print(const char* name, const std::vector<double>& errors) {
  const auto rmse_cm = [&](double from_s, double to_s) {
    double sum = 0;
    const auto first = std::size_t(from_s / step_s), last = std::size_t(to_s / step_s);
    for (std::size_t i = first; i < last; ++i) sum += errors[i] * errors[i];
    return 100 * std::sqrt(sum / double(last - first));
  };
  std::printf("  %-34s %8.2f %18.2f\n", name, rmse_cm(0, duration_s / 2), rmse_cm(duration_s / 2, duration_s));
}

struct Curve {
  const char* name;
  const char* color;
  Flight flight;
};

/// A moving picture as SVG, 760 x 530: above, the vehicles on their path, seen from the west and a little from above;
/// below, the error over time, up to `most_m`. It plays twice as fast as they fly; without animation the curves are
/// whole.
void draw(const std::string& path, const std::vector<Curve>& curves, double most_m) {
  AtomicFile file(path);
  std::ostream& svg = file.stream();
  const std::string forever = " dur='" + std::to_string(std::lround(duration_s / 2)) + "s' repeatCount='indefinite'/>";
  const auto x = [](double time_s) { return 60 + 680 * time_s / duration_s; };
  const auto y = [&](double error_m) { return 490 - 230 * std::min(error_m / most_m, 1.0); };
  const auto text = [&](double at_x, double at_y, const std::string& words, const char* anchor = "middle") {
    svg << "<text x='" << at_x << "' y='" << at_y << "' text-anchor='" << anchor << "'>" << words << "</text>\n";
  };
  const auto seen = [&](const Vector3<double>& position_m) {
    const Vector3<double> from_center_m = position_m - eight().center_m;
    const auto pixels = [](double value) { return double(std::lround(10 * value)) / 10; };
    svg << pixels(400 + 80 * from_center_m[0]) << ',' << pixels(105 + 80 * from_center_m[2] - 20 * from_center_m[1]);
  };
  constexpr std::size_t shown_ticks = 50;

  svg << "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 760 530' font-family='sans-serif' font-size='12'>\n"
         "<rect width='760' height='530' fill='white'/>\n<polygon stroke='#ccc' fill='none' points='";
  for (double time_s = 10; time_s < 17.5; time_s += 0.05) seen(eight().sample(time_s).position_m), svg << ' ';
  svg << "'/>\n<path stroke='#ccc' fill='none' d='";
  for (int i = 0; i <= 5; ++i) svg << 'M' << x(0) << ' ' << y(most_m * i / 5) << 'H' << x(duration_s);
  svg << 'M' << x(duration_s / 2) << " 260V490'/>\n";
  for (int i = 0; i <= 5; ++i) text(52, y(most_m * i / 5) + 4, std::to_string(std::lround(20 * most_m * i)), "end");
  for (int t = 0; t <= 30; t += 5) text(x(t), 506, std::to_string(t));
  text(400, 524, "time, s");
  text(60, 250, "distance from the path, cm", "start");
  text(x(duration_s / 2) + 4, 272, "a fifth more mass", "start");
  svg << "<clipPath id='past'><rect x='60' y='250' width='680' height='250'><animate attributeName='width' from='0' "
         "to='680'"
      << forever << "</rect></clipPath>\n";
  int line = 0;
  for (const Curve& curve : curves) {
    svg << "<polyline fill='none' clip-path='url(#past)' stroke-width='1.5' stroke='" << curve.color << "' points='";
    for (std::size_t i = 0; i < curve.flight.errors_m.size(); i += shown_ticks)
      svg << x(step_s * double(i)) << ',' << y(curve.flight.errors_m[i]) << ' ';
    svg << "'/>\n<g fill='" << curve.color << "'>";
    text(70, 278 + 16 * line++, curve.name, "start");
    svg << "<circle r='5'><animateMotion calcMode='linear' values='";
    for (std::size_t i = 0; i < curve.flight.positions_m.size(); i += shown_ticks)
      svg << (i == 0 ? "" : ";"), seen(curve.flight.positions_m[i]);
    svg << "'" << forever << "</circle></g>\n";
  }
  svg << "</svg>\n";
  file.commit();
}

int main(int count, char** arguments) try {
  if (count != 3) throw std::invalid_argument("expected MODEL.block PICTURE.svg");
  if (self_test(InverseDynamics<TrainedQuadModel>{}) != Status::ok) throw std::runtime_error("the self test failed");
  std::ifstream file(arguments[1], std::ios::binary);
  const std::vector<char> block{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file || block.empty()) throw std::runtime_error(std::string(arguments[1]) + ": no such readable file");
  const std::vector<Curve> curves = {{"analytic inverse, no model", "#888", fly_analytic()},
                                     {"export, learning nothing in flight", "#d95f02", fly_core(block, false)},
                                     {"export", "#1b6ca8", fly_core(block, true)}};
  std::printf("  %-34s %8s %18s\n", "RMSE, cm", "nominal", "a fifth more mass");
  for (const Curve& curve : curves) print(curve.name, curve.flight.errors_m);
  double most_m = 0;
  for (const Curve& curve : curves) {
    most_m = std::max(most_m, *std::max_element(curve.flight.errors_m.begin(), curve.flight.errors_m.end()));
  }
  most_m = std::ceil(10 * most_m) / 10;
  draw(arguments[2], curves, most_m);
} catch (const std::exception& error) {
  std::fprintf(stderr, "fly_model: %s\n", error.what());
  return 1;
}
