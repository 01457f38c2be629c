// SPDX-License-Identifier: MIT
// Flies a short flight and writes it twice: as a replay page and as rows of plain text for the test to compare with.
//   replay_driver page.html rows.csv [samples] [title]
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <random>
#include <string>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/simulation/flight.hpp"
#include "replay_page.hpp"

namespace {

using pinnquad::Commands;
using pinnquad::Status;
using pinnquad::VehicleState;

/// The rows of a flight as pinnquad::fly() has them, handed to `each_row(vehicle, commands)`: state and command.
template <class EachRow>
Status fly_rows(std::size_t samples, const EachRow& each_row) {
  using namespace pinnquad;
  const Quadrotor<double, StandardAtmosphere, QuadraticDrag> quadrotor(airframe_value<PaperQuadrotor, double>(),
                                                                       paper_site<double>(), {}, {});
  const FlightPlan plan;
  RandomPilot<std::mt19937_64> pilot(std::mt19937_64(7), pilot_style(quadrotor, plan.start_m),
                                     quadrotor.site().ground_z_m);
  VehicleState<double> vehicle;
  vehicle.body.position_m = plan.start_m;
  HoverTrim<double> hover;
  Status status = hover_trim(quadrotor, plan.start_m, hover);
  vehicle.rotors = hover.commands;
  Commands<double> commands = hover.commands;
  const double density_ratio = quadrotor.density_ratio(quadrotor.surroundings(vehicle.body, 0.0));
  const FlightController<double> controller(plan.gains, flight_limits(quadrotor.airframe(), density_ratio, plan.gains),
                                            quadrotor.site().gravity_m_s2);
  for (std::size_t row = 0; row < samples; ++row) {
    for (int tick = 0; tick < plan.controls_per_sample && status == Status::ok; ++tick) {
      Accelerations<double> demand;
      status = controller(vehicle.body, pilot(vehicle.body, vehicle.time_s), demand);
      if (status == Status::ok) status = inverse_commands(quadrotor, vehicle.body, demand, vehicle.time_s, commands);
      if (status == Status::ok) commands = keep_torque(commands);
      for (int i = 0; i < plan.steps_per_control && status == Status::ok; ++i) {
        status = quadrotor.step(vehicle, commands, plan.physics_step_s);
      }
    }
    if (status != Status::ok) return status;
    vehicle.time_s = static_cast<double>(row + 1) * plan.sample_period_s();
    each_row(vehicle, commands);
  }
  return status;
}

int run(const std::string& html, const std::string& csv, std::size_t samples, const std::string& title) {
  programs::ReplayPage::require_available(html);
  programs::ReplayPage page(title, pinnquad::airframe_value<pinnquad::PaperQuadrotor, double>(),
                            pinnquad::paper_site<double>().ground_z_m);
  std::ofstream rows(csv);
  rows.precision(17);
  rows << "t,north,east,down,v_north,v_east,v_down,qw,qx,qy,qz,u1,u2,u3,u4\n";
  const Status status = fly_rows(samples, [&](const VehicleState<double>& vehicle, const Commands<double>& commands) {
    page.add(vehicle, commands);
    const pinnquad::State<double>& body = vehicle.body;
    rows << vehicle.time_s;
    for (int i = 0; i < 3; ++i) rows << ',' << body.position_m[i];
    for (int i = 0; i < 3; ++i) rows << ',' << body.velocity_m_s[i];
    rows << ',' << body.attitude.w << ',' << body.attitude.x << ',' << body.attitude.y << ',' << body.attitude.z;
    for (const double command : commands) rows << ',' << command;
    rows << '\n';
  });
  rows.close();
  if (status != Status::ok || !rows) {
    std::fprintf(stderr, "replay_driver: the flight or its rows failed: %s\n", to_string(status));
    return 1;
  }
  page.write(html);
  return 0;
}

}  // namespace

int main(int argument_count, char** arguments) {
  if (argument_count < 3) {
    std::fprintf(stderr, "usage: replay_driver page.html rows.csv [samples] [title]\n");
    return 2;
  }
  const std::size_t samples = argument_count > 3 ? std::strtoull(arguments[3], nullptr, 10) : 600;
  const std::string title = argument_count > 4 ? arguments[4] : "paper_quadrotor, seed 7";
  try {
    return run(arguments[1], arguments[2], samples, title);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "replay_driver: %s\n", error.what());
    return 2;
  }
}
