// SPDX-License-Identifier: MIT
#include "python/vehicle_steps.hpp"

#include <cstring>
#include <tuple>
#include <utility>
#include <vector>

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

/// The air, wind and drag: steps of a vehicle that knows no other effect take two thirds of the time.
using FewEffects = std::tuple<Switched<StandardAtmosphere, Usually::on>, Switched<ConstantWind>, Switched<PeriodicWind>,
                              Switched<QuadraticDrag, Usually::on>>;

template <class... Effects>
int count_on(const std::tuple<Effects...>& effects) {
  return std::apply([](const Effects&... each) { return (int{each.on} + ...); }, effects);
}
template <class... Effects>
std::tuple<Effects...> some_of(const SwitchedEffects& all, const std::tuple<Effects...>& /*wanted*/) {
  return {std::get<Effects>(all)...};
}

template <class AnyEffects>
class StepsInLanes final : public VehicleSteps {
 public:
  StepsInLanes(const Site<double>& site, double step_s, const AnyEffects& effects)
      : site_{Wide(site.elevation_m), Wide(site.ground_z_m), Wide(site.gravity_m_s2)},
        step_s_(step_s),
        effects_(effects) {}

  std::size_t lanes() const noexcept override { return lane_count; }

  void set_airframe(const Airframe<double>& airframe) override {
    groups_.clear();
    groups_.push_back(group_of(in_every_lane<Wide>(airframe)));
  }

  bool set_airframes(std::size_t group, const Airframe<double>* airframes, std::size_t count) override {
    Airframe<Wide> all = in_every_lane<Wide>(airframes[0]);
    for (std::size_t lane = 1; lane < count; ++lane) {
      if (!set_lane(all, static_cast<int>(lane), airframes[lane])) return false;
    }
    if (group < groups_.size()) {
      groups_[group] = group_of(all);
    } else {
      groups_.push_back(group_of(all));
    }
    return true;
  }

  void step(double* states, const double* commands, std::size_t first, std::size_t last, std::uint64_t steps,
            std::uint8_t* statuses) const noexcept override {
    for (; first < last; first += lane_count) {
      const Group& group = groups_[groups_.size() == 1 ? 0 : first / lane_count];
      const std::size_t count = last - first < lane_count ? last - first : lane_count;
      VehicleState<Wide> state;
      Commands<Wide> u;
      to_lanes<state_numbers>(states + first * state_numbers, count, &state);
      to_lanes<rotor_count>(commands + first * rotor_count, count, &u);
      Outcome<Wide> outcome(Status::ok);
      // what is refused is refused again: it has not moved
      for (std::uint64_t done = 0; done < steps; ++done) outcome = group.vehicles.step(state, u, group.step);
      from_lanes<state_numbers>(&state, count, states + first * state_numbers);
      for (std::size_t lane = 0; lane < count; ++lane) {
        statuses[first + lane] = static_cast<std::uint8_t>(outcome.lane(static_cast<int>(lane)));
      }
    }
  }

 private:
  using Vehicles = decltype(quadrotor_with(AnyEffects(), std::declval<Airframe<Wide>>(), std::declval<Site<Wide>>()));
  struct Group {
    Vehicles vehicles;
    typename Vehicles::TimeStep step;
  };

  Group group_of(const Airframe<Wide>& airframes) const {
    const Vehicles vehicles = quadrotor_with(effects_, airframes, site_);
    return {vehicles, vehicles.time_step(Wide(step_s_))};
  }

  Site<Wide> site_;
  double step_s_;
  AnyEffects effects_;
  std::vector<Group> groups_;
};

}  // namespace

VehicleSteps::~VehicleSteps() = default;

std::unique_ptr<VehicleSteps> steps_in_lanes(const Site<double>& site, double step_s, const SwitchedEffects& effects) {
  const FewEffects few = some_of(effects, FewEffects{});
  if (count_on(few) == count_on(effects)) return std::make_unique<StepsInLanes<FewEffects>>(site, step_s, few);
  return std::make_unique<StepsInLanes<SwitchedEffects>>(site, step_s, effects);
}

}  // namespace python
