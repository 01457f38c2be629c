// SPDX-License-Identifier: MIT
// Compiled once per instruction set, with its table's name as PINNQUAD_STEPS. It may emit nothing that another object
// could take: templates are on Lanes, which are named by the instruction set, and the rest is in this file alone.
#include "python/vehicle_steps.hpp"

#include <cstring>

#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/vehicle/lanes_of_vehicles.hpp"

namespace python {

namespace {

using namespace pinnquad;
constexpr std::size_t lane_count = native_lanes<double>;
using Wide = Lanes<double, native_lanes<double>>;
static_assert(sizeof(VehicleState<Wide>) == state_numbers * sizeof(Wide));

/// Rows of `Numbers` to lanes, and back.
template <std::size_t Numbers>
void to_lanes(const double* rows, std::size_t count, void* lanes) noexcept {
  double turned[Numbers * lane_count];
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const double* row = rows + (lane < count ? lane : count - 1) * Numbers;  // the last one fills up
    for (std::size_t k = 0; k < Numbers; ++k) turned[k * lane_count + lane] = row[k];
  }
  std::memcpy(lanes, turned, sizeof turned);
}
template <std::size_t Numbers>
void from_lanes(const void* lanes, std::size_t count, double* rows) noexcept {
  double turned[Numbers * lane_count];
  std::memcpy(turned, lanes, sizeof turned);
  for (std::size_t lane = 0; lane < count; ++lane) {
    for (std::size_t k = 0; k < Numbers; ++k) rows[lane * Numbers + k] = turned[k * lane_count + lane];
  }
}

template <class... Effects>
class StepsOf final : public VehicleSteps {
 public:
  StepsOf(const Airframe<double>& airframe, const Site<double>& site, double step_s, const Effects&... effects)
      : vehicles_(in_every_lane<Wide>(airframe),
                  Site<Wide>{Wide(site.elevation_m), Wide(site.ground_z_m), Wide(site.gravity_m_s2)}, effects...),
        step_(vehicles_.time_step(Wide(step_s))) {}

  std::size_t lanes() const noexcept override { return lane_count; }

  void step(double* states, const double* commands, std::size_t first, std::size_t last, std::uint64_t steps,
            std::uint8_t* statuses) const noexcept override {
    for (; first < last; first += lane_count) {
      const std::size_t count = last - first < lane_count ? last - first : lane_count;
      VehicleState<Wide> state;
      Commands<Wide> u;
      to_lanes<state_numbers>(states + first * state_numbers, count, &state);
      to_lanes<rotor_count>(commands + first * rotor_count, count, &u);
      Outcome<Wide> outcome(Status::ok);
      // what is refused is refused again: it has not moved
      for (std::uint64_t done = 0; done < steps; ++done) outcome = vehicles_.step(state, u, step_);
      from_lanes<state_numbers>(&state, count, states + first * state_numbers);
      for (std::size_t lane = 0; lane < count; ++lane) {
        statuses[first + lane] = static_cast<std::uint8_t>(outcome.lane(static_cast<int>(lane)));
      }
    }
  }

 private:
  Quadrotor<Wide, Effects...> vehicles_;
  typename Quadrotor<Wide, Effects...>::TimeStep step_;
};

template <class... Ground>
std::unique_ptr<VehicleSteps> steps_with(const Airframe<double>& airframe, const Site<double>& site,
                                         const PaperEffects& effects, double step_s, const Ground&... ground) {
  const auto& [air, wind, gust, drag] = effects;
  return std::unique_ptr<VehicleSteps>(
      new StepsOf<StandardAtmosphere, ConstantWind, PeriodicWind, QuadraticDrag, Ground...>(
          airframe, site, step_s, air, wind, gust, drag, ground...));
}

std::unique_ptr<VehicleSteps> steps_of(const Airframe<double>& airframe, const Site<double>& site,
                                       const PaperEffects& effects, GroundEffectModel ground_effect, double step_s) {
  switch (ground_effect) {
    case GroundEffectModel::cheeseman_bennett:
      return steps_with(airframe, site, effects, step_s, CheesemanBennettGroundEffect{});
    case GroundEffectModel::conyers: return steps_with(airframe, site, effects, step_s, ConyersGroundEffect{});
    case GroundEffectModel::none: break;
  }
  return steps_with(airframe, site, effects, step_s);
}

}  // namespace

const CompiledSteps PINNQUAD_STEPS = {detail::instruction_set.data(), steps_of};

}  // namespace python
