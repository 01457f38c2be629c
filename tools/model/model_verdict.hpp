// SPDX-License-Identifier: MIT
// May a model fly, by what its block says of itself (command_line/flight_verdict.hpp).
#pragma once

#include <optional>
#include <string>

#include "command_line/flight_verdict.hpp"
#include "pinnquad/deploy/block_model.hpp"
#include "pinnquad/io/decimal.hpp"
#include "training/export_verdict.hpp"

namespace programs {

/// `refuted`: two motions show that more acceleration asked is less torque commanded; about which axis. Null: none do.
inline FlightVerdict model_verdict(const pinnquad::BlockModel& model,
                                   const std::optional<pinnquad::BlockModel::ProvenSigns>& proof,
                                   const char* refuted = nullptr) {
  const std::string path = pinnquad::printable(model.path()), airframe_name = model.airframe_name();
  const pinnquad::AxisSlopes own = pinnquad::hover_slopes(model.airframe());
  const bool assumed = airframe_name.size() > 7 && airframe_name.substr(airframe_name.size() - 7) == "assumed";
  std::string facts = "more angular acceleration asked is more torque commanded, at every input";
  if (proof && !assumed) facts += ", " + least_share_in_words(proof->held_slope, own);
  FlightVerdict verdict(facts);
  if (refuted != nullptr) {
    verdict.refuse(std::string("asked for more ") + refuted + " acceleration, it may command less torque",
                   "train a structured model: pinnquad train FLIGHTS --export structured");
  } else if (!proof) {
    verdict.care("no proof that more angular acceleration asked is more torque commanded",
                 "train a structured model: pinnquad train FLIGHTS --export structured");
  }
  double r2 = 0;
  const std::string text = model.provenance("test_r_squared");
  if (text.empty()) {
    verdict.care("no flight judged it", "pinnquad evaluate " + path + " FLIGHTS");
  } else if (pinnquad::parse_number(text, r2) && !(r2 >= good_r2)) {
    const std::string low = "R^2 " + decimals(r2, 3) + " on the rows held out is low";
    r2 >= least_r2 ? verdict.care(low, livelier_flight) : verdict.refuse(low, livelier_flight);
  }
  if (proof && !assumed) {
    const double thrust =
        proof->structure ? proof->structure->held_thrust_slope / pinnquad::hover_thrust_slope(model.airframe()) : 1;
    for (const std::string& odd : odd_slopes(proof->held_slope, own, thrust)) verdict.care(odd, livelier_flight);
  }
  if (assumed) {
    verdict.care("its airframe is assumed, not the vehicle's", "pinnquad identify FLIGHTS --out vehicle.toml");
  }
  verdict.then("pinnquad loop " + path);
  return verdict;
}

}  // namespace programs
