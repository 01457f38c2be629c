// SPDX-License-Identifier: MIT
// The structured model whole: the choices of altitude and residual, whatever runs the fits.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/pinnquad.hpp"
#include "pinnquad/training/structured/agreement.hpp"

using namespace pinnquad;

namespace {

using Altitude = StructuredSettings::Altitude;
const GivenAirframe quadrotor = given_airframe<PaperQuadrotor>();

Flight flown(const std::string& name, std::uint64_t seed, std::size_t samples) {
  FlightPlan plan = AgileFlight::plan();
  plan.samples = samples;
  const Quadrotor<double, StandardAtmosphere, QuadraticDrag> vehicle(
      airframe_value<PaperQuadrotor, double>(), paper_site<double>(), StandardAtmosphere{}, QuadraticDrag{});
  Flight flight = fly(vehicle, AgileFlight::pilot(vehicle, std::mt19937_64(seed)), plan).flight;
  flight.name = flight.trajectory = name;
  return flight;
}

/// The same, with what no affine map tells in all its commands: `size` |v_bx|.
Flight bent(const std::string& name, std::uint64_t seed, std::size_t samples, double size) {
  Flight flight = flown(name, seed, samples);
  for (Sample& sample : flight) {
    for (double& u : sample.commands) u += size * std::abs(sample.velocity_m_s[0]);
  }
  return flight;
}

const Dataset& flights() {
  static const Dataset dataset(flown("flown", 3, 1500));
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
  return fit_structured(split_for_training(flights()), quadrotor, settings);
}

/// The last job first, and a word of each call.
struct Backwards : FitWork {
  explicit Backwards(std::string* words) : calls(words) {}
  void run(std::size_t count, const std::function<bool(std::size_t)>& job) const override {
    *calls += "run " + std::to_string(count) + ", ";
    for (std::size_t i = count; i-- > 0;) static_cast<void>(job(i));
  }
  void chose(const FitWork::Altitude&) const override { *calls += "chose, "; }

  std::string* calls;
};

struct StopsAfter : FitWork {
  StopsAfter(int* epochs, bool* was_chosen) : epochs_left(epochs), chosen(was_chosen) {}
  bool goes_on(int) const override { return --*epochs_left >= 0; }
  void chose(const FitWork::Altitude&) const override { *chosen = true; }

  int* epochs_left;
  bool* chosen;
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
      CHECK(chosen.models[i].with_altitude == (least < 0));
      CHECK(chosen.models[i].parameters == (least < 0 ? with : without).models[i].parameters);
      CHECK(chosen.best().validation_error <= chosen.models[i].validation_error);
    }
  }
}

TEST_CASE("what runs the fits, and in which order, changes no model") {
  std::string calls;
  const StructuredSettings settings = quick(Altitude::by_validation);
  const StructuredFits in_turn = fitted(settings);
  const StructuredFits backwards =
      fit_structured(split_for_training(flights()), quadrotor, settings, Backwards(&calls));
  CHECK(calls == "run 2, chose, run 2, ");
  REQUIRE(backwards.models.size() == in_turn.models.size());
  for (std::size_t i = 0; i < in_turn.models.size(); ++i) {
    CHECK(backwards.models[i].parameters == in_turn.models[i].parameters);
  }
}

TEST_CASE("what is stopped before the choice leaves nothing, and after it the models that were finished") {
  StructuredSettings settings = quick(Altitude::by_validation);
  for (const int epochs : {4, 8, 100}) {
    int left = epochs;
    bool chosen = false;
    const StructuredFits fits =
        fit_structured(split_for_training(flights()), quadrotor, settings, StopsAfter(&left, &chosen));
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
  const Certificate certificate = *pinned.best().model.written.certificate;
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

TEST_CASE("a residual that the validation rows keep is dropped where whole flights left out do not gain") {
  StructuredSettings settings = quick(Altitude::no);
  settings.residual.epochs = 30;
  settings.seeds = 1;
  const auto kept = [&](double of_other) {
    Dataset dataset;
    dataset.add(bent("a", 3, 2000, 0.02));
    dataset.add(bent("b", 4, 1000, of_other));
    dataset.add(bent("c", 5, 1000, 0.02));
    const RowSplit split = {{dataset[0], {0, 2000}}, {dataset[2], {0, 1000}}, {}};
    RowSplit both = split;
    both.train.add(dataset[1], {0, 1000});
    CHECK(fit_structured(split, quadrotor, settings).best().has_residual);  // one flight: validation alone
    return fit_structured(both, quadrotor, settings).best().has_residual;
  };
  CHECK(kept(0.02));
  CHECK_FALSE(kept(-0.02));
}

TEST_CASE("where the validation rows are fitted too, whole flights left out choose: all of the residual, or none") {
  StructuredSettings settings = quick(Altitude::no);
  settings.residual.epochs = 30;
  settings.seeds = 1;
  settings.fit_validation = true;
  const auto fit = [&](double size, double of_other) {
    Dataset dataset;
    dataset.add(bent("a", 3, 1200, size));
    dataset.add(bent("b", 4, 1200, of_other));
    dataset.add(bent("c", 5, 1200, size));
    const RowSplit split = {{dataset[0], {0, 1200}}, {dataset[2], {0, 1200}}, {}};
    RowSplit more = split;
    more.train.add(dataset[1], {0, 1200});
    const RowSet unseen(dataset[1], {0, 1200});
    const auto two = fit_structured(split, quadrotor, settings).best();
    const double error = model_errors(two.model, unseen).mean.mean_absolute;
    const auto three = fit_structured(more, quadrotor, settings).best();
    return std::array<double, 3>{two.has_residual ? 1.0 : 0.0, error, three.has_residual ? 1.0 : 0.0};
  };
  const auto with = fit(0.02, 0.02), odd = fit(0.02, -0.02);
  CHECK(with[0] == 1);
  CHECK(with[2] == 1);
  CHECK(with[1] < 0.015);  // of a flight that neither trained nor chose; the base alone leaves 0.03
  CHECK(odd[2] == 0);

  // one flight of one trajectory: its quarters are left out
  Dataset alone(bent("a", 3, 1500, 0.02));
  const RowSplit split{{alone[0], {0, 1200}}, {alone[0], {1200, 1500}}, {}};
  CHECK(std::isfinite(fit_structured(split, quadrotor, settings).best().validation_error));
}

TEST_CASE("the share of a residual's answer is that of least squared error, and 0 where one group does not gain") {
  detail::Agreement agreement;
  agreement.begin_group();
  agreement.add(0, 1.0, 0.5);
  agreement.add(0, -2.0, -1.0);
  agreement.add(1, 1.0, 3.0);
  agreement.add(2, 1.0, 0.5);
  agreement.add(3, 1.0, -1.0);
  CHECK(agreement.share(0) == doctest::Approx(0.5));  // (0.5 + 2) / (1 + 4)
  CHECK(agreement.share(1) == 1);                     // no more than it says
  CHECK(agreement.share(3) == 0);
  // 1.25 - (2 x 2.5 x 0.5 - 5 x 0.25) = 0 of the first, 9 - 5 of the second, 0.25 - 0.25 of the third
  CHECK(agreement.gain() == doctest::Approx(1.25 + 5 + 0.25));
  agreement.begin_group();
  agreement.add(0, 1.0, 0.6);
  agreement.add(2, 1.0, -0.1);
  CHECK(agreement.share(0) == doctest::Approx(3.1 / 6));
  CHECK(agreement.share(2) == 0);
}
