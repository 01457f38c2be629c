// SPDX-License-Identifier: MIT
// The structured model whole: the choices of altitude and residual, whatever runs the fits.
#include "pinnquad/training/structured/fit_structured.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/pinnquad.hpp"

using namespace pinnquad;

namespace {

using Altitude = StructuredSettings::Altitude;

const Dataset& flights() {
  static const Dataset dataset = [] {
    FlightPlan plan = AgileFlight::plan();
    plan.samples = 1500;
    const Quadrotor<double, StandardAtmosphere, QuadraticDrag> vehicle(
        airframe_value<PaperQuadrotor, double>(), paper_site<double>(), StandardAtmosphere{}, QuadraticDrag{});
    Flight flight = fly(vehicle, AgileFlight::pilot(vehicle, std::mt19937_64(3)), plan).flight;
    flight.name = "flown";
    return Dataset(std::move(flight));
  }();
  return dataset;
}

StructuredSettings quick(Altitude altitude) {
  StructuredSettings settings;
  settings.residual.epochs = 3;
  settings.altitude = altitude;
  settings.first_seed = 7;
  settings.seeds = 3;
  return settings;
}

StructuredFits fitted(const StructuredSettings& settings) {
  return fit_structured<PaperQuadrotor>(split_for_training(flights()), settings);
}

std::vector<float> parameters_of(const StructuredFits::Fit& fit) {
  return std::visit(
      [](const auto& model) {
        return std::vector<float>(model.network.parameters.begin(), model.network.parameters.end());
      },
      fit.model);
}

bool shown_the_altitude(const StructuredFits::Fit& fit) { return fit.model.index() >= 2; }

/// The last job first, and a word of each call.
struct Backwards {
  std::string* calls;
  template <class Job>
  void run(std::size_t count, const Job& job) const {
    *calls += "run " + std::to_string(count) + ", ";
    for (std::size_t i = count; i-- > 0;) static_cast<void>(job(i));
  }
  bool goes_on(int) const { return true; }
  void chose(const StructuredAltitude&) const { *calls += "chose, "; }
};

struct StopsAfter {
  int* epochs_left;
  bool* chosen;
  template <class Job>
  void run(std::size_t count, const Job& job) const {
    for (std::size_t i = 0; i < count && job(i); ++i) {
    }
  }
  bool goes_on(int) const { return --*epochs_left >= 0; }
  void chose(const StructuredAltitude&) const { *chosen = true; }
};

}  // namespace

TEST_CASE("the altitude is shown as the rule says; by validation, where the error falls by the share that is asked") {
  const StructuredFits without = fitted(quick(Altitude::no)), with = fitted(quick(Altitude::yes));
  REQUIRE(without.models.size() == 3);
  REQUIRE(with.models.size() == 3);
  CHECK(!without.altitude.taken);
  CHECK(with.altitude.taken);
  CHECK(!with.altitude.error_with);
  StructuredSettings settings = quick(Altitude::by_validation);
  for (const double least : {-1000.0, 0.999999}) {
    settings.least_altitude_gain = least;
    const StructuredFits chosen = fitted(settings);
    REQUIRE(chosen.models.size() == 3);
    CHECK(*chosen.altitude.error_with == with.models[0].validation_error);
    CHECK(*chosen.altitude.error_without == without.models[0].validation_error);
    CHECK(chosen.altitude.taken == (least < 0));
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(chosen.models[i].seed == 7 + i);
      CHECK(shown_the_altitude(chosen.models[i]) == (least < 0));
      CHECK(parameters_of(chosen.models[i]) == parameters_of((least < 0 ? with : without).models[i]));
      CHECK(chosen.best().validation_error <= chosen.models[i].validation_error);
    }
  }
}

TEST_CASE("what runs the fits, and in which order, changes no model") {
  std::string calls;
  const StructuredSettings settings = quick(Altitude::by_validation);
  const StructuredFits in_turn = fitted(settings);
  const StructuredFits backwards =
      fit_structured<PaperQuadrotor>(split_for_training(flights()), settings, Backwards{&calls});
  CHECK(calls == "run 2, chose, run 2, ");
  REQUIRE(backwards.models.size() == in_turn.models.size());
  for (std::size_t i = 0; i < in_turn.models.size(); ++i) {
    CHECK(parameters_of(backwards.models[i]) == parameters_of(in_turn.models[i]));
  }
}

TEST_CASE("what is stopped before the choice leaves nothing, and after it the models that were finished") {
  StructuredSettings settings = quick(Altitude::by_validation);
  for (const int epochs : {4, 8, 100}) {
    int left = epochs;
    bool chosen = false;
    const StructuredFits fits =
        fit_structured<PaperQuadrotor>(split_for_training(flights()), settings, StopsAfter{&left, &chosen});
    CHECK(chosen == (epochs > 4));
    CHECK(fits.models.size() == (epochs == 4 ? 0u : epochs == 8 ? 1u : 3u));
    if (fits.models.empty()) CHECK_THROWS_AS(static_cast<void>(fits.best()), std::logic_error);
  }
}

TEST_CASE("pinned slopes are the airframe's, and every model is proven") {
  StructuredSettings settings = quick(Altitude::no);
  settings.pinned_slopes = true;
  const StructuredFits pinned = fitted(settings);
  const AxisSlopes own = hover_slopes(airframe_value<PaperQuadrotor, double>());
  const Certificate certificate =
      std::visit([](const auto& model) { return certificate_of_trained(model); }, pinned.best().model);
  CHECK(certificate.proven());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    CHECK(certificate.slope[axis] == doctest::Approx(own[axis]).epsilon(1e-5));
  }
}

TEST_CASE("of errors that are not finite none is the best") {
  StructuredSettings settings = quick(Altitude::no);
  settings.seeds = 1;
  StructuredFits fits = fitted(settings);
  const StructuredFits::Fit one = fits.models.front();
  fits.models.assign(4, one);
  const double errors[] = {std::nan(""), 0.2, 0.1, std::nan("")};
  for (std::size_t i = 0; i < 4; ++i) fits.models[i].validation_error = errors[i];
  CHECK(fits.best().validation_error == 0.1);
}
