// SPDX-License-Identifier: MIT
// Compares the flights at hand with those that the shipped models say they were trained on.
//   shipped_models DEMO_FLIGHT.csv CRAZYFLIE_FLIGHT.csv
#include <cstdio>
#include <exception>
#include <string>

#include "models/crazyflie_2_1.hpp"
#include "models/demo_quadrotor.hpp"
#include "models/structured_quadrotor.hpp"
#include "pinnquad/data/csv.hpp"
#include "pinnquad/data/dataset.hpp"
#include "pinnquad/data/split.hpp"

namespace {

template <class Model>
bool trained_on(const std::string& path, const char* header) {
  const pinnquad::Flight flight = pinnquad::read_flight_csv(path);
  const auto hash = static_cast<unsigned long long>(pinnquad::content_hash(flight));
  const auto rows = static_cast<int>(pinnquad::split_contiguous(flight.size()).train.size());
  const bool same = hash == Model::training_data_hash && rows == Model::training_rows;
  std::printf("%s: trained on %d rows of flight %016llx; the flight made today: %d rows of %016llx%s\n", header,
              Model::training_rows, static_cast<unsigned long long>(Model::training_data_hash), rows, hash,
              same ? "" : ": stale, make it again (docs/train.md, 'The models that are shipped')");
  return same;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    const bool demo = trained_on<DemoQuadModel>(argv[1], "examples/models/demo_quadrotor.hpp");
    const bool crazyflie = trained_on<CrazyflieModel>(argv[2], "examples/models/crazyflie_2_1.hpp");
    const bool structured = trained_on<StructuredQuadModel>(argv[1], "examples/models/structured_quadrotor.hpp");
    return demo && crazyflie && structured ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
