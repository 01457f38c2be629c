// SPDX-License-Identifier: MIT
// Flies a short flight and writes it twice: as a page to watch it, of watch.json of the working folder, and as rows of
// plain text for the test to compare with.
//   watch_driver page.html rows.csv [samples] [title]
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <random>
#include <string>

#include "page/watch_page.hpp"
#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/simulation/flights.hpp"
#include "pinnquad/simulation/simulator.hpp"

namespace {

using namespace pinnquad;

int run(const std::string& html, const std::string& csv, std::size_t samples, const std::string& title) {
  const std::string bundle = "watch.json";
  programs::WatchPage::require_available(html, bundle);
  programs::WatchPage page(title, airframe_value<PaperQuadrotor, double>(), paper_site<double>().ground_z_m, bundle);
  std::ofstream rows(csv);
  rows.precision(17);
  rows << "t,north,east,down,v_north,v_east,v_down,qw,qx,qy,qz,u1,u2,u3,u4\n";
  const Quadrotor<double, StandardAtmosphere, QuadraticDrag> quadrotor(airframe_value<PaperQuadrotor, double>(),
                                                                       paper_site<double>(), {}, {});
  FlightPlan plan;
  plan.samples = samples;
  const RandomPilot<std::mt19937_64> pilot(std::mt19937_64(7), pilot_style(quadrotor, plan.start_m),
                                           quadrotor.site().ground_z_m);
  const FlightReport report = fly(quadrotor, pilot, plan, [&](const auto& flies) {
                                page.add(flies.vehicle(), flies.recording().back().commands);
                                const State<double>& body = flies.vehicle().body;
                                rows << flies.vehicle().time_s;
                                for (int i = 0; i < 3; ++i) rows << ',' << body.position_m[i];
                                for (int i = 0; i < 3; ++i) rows << ',' << body.velocity_m_s[i];
                                rows << ',' << body.attitude.w << ',' << body.attitude.x << ',' << body.attitude.y
                                     << ',' << body.attitude.z;
                                for (const double command : flies.recording().back().commands) rows << ',' << command;
                                rows << '\n';
                              }).report;
  rows.close();
  if (report.end != FlightEnd::completed || !rows) {
    std::fprintf(stderr, "watch_driver: the flight or its rows failed: %s\n", to_string(report.status));
    return 1;
  }
  page.write(html);
  return 0;
}

}  // namespace

int main(int argument_count, char** arguments) {
  if (argument_count < 3) {
    std::fprintf(stderr, "usage: watch_driver page.html rows.csv [samples] [title]\n");
    return 2;
  }
  const std::size_t samples = argument_count > 3 ? std::strtoull(arguments[3], nullptr, 10) : 600;
  const std::string title = argument_count > 4 ? arguments[4] : "paper_quadrotor, seed 7";
  try {
    return run(arguments[1], arguments[2], samples, title);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "watch_driver: %s\n", error.what());
    return 2;
  }
}
