// SPDX-License-Identifier: MIT
// Do flights have one vehicle, and is it the airframe's? Each flight is identified (regression/identification.hpp), and
// its numbers, with their intervals, are compared with those of the others and of the airframe: motors in another
// order, propellers that turn the other way, commands of another range, late commands, a payload.
#pragma once

#include "pinnquad/dynamics/airframe.hpp"
#include "pinnquad/logs/read_dataset.hpp"

namespace pinnquad::logs {

/// Adds what is found to the dataset's warnings, what contradicts the airframe's signs, or every other flight, to its
/// contradictions, and flights whose numbers are not those of most others to its unlike ones. `known`: the airframe is
/// that of the flights; else its motors' order and signs alone are asked. At most five minutes of each flight are
/// looked at. Compared is what a flight tells to 15 %. Found, with 95 % intervals beyond it: thrust of a rotor over
/// mass that is 8 % off the other flights' (beyond what the battery's voltage explains), an effectiveness 30 %; 1.4
/// times the airframe's or less than it over 1.4; a thrust whose slope over the commands is not its level, by a factor
/// of 1.6, in most flights. And a lag of 0.12 s or more either way, or 0.06 s off the other flights'. The second half
/// of a flight is compared with the first as another flight is. Battery voltages that no battery has, or 1.76 times
/// those of the other flights; commands that are all below 0.15.
/// Limits: calm flights tell little, and are compared in what they tell. Rates and attitude are taken as right
/// (find_turning_mistake()).
void check_vehicle(ImportedDataset& dataset, const Airframe<double>& airframe, bool known,
                   const OnProgress& on_progress = {});

/// Throws std::invalid_argument, one line, where there is a contradiction: nothing should be learned from such flights.
void require_one_vehicle(const ImportedDataset& dataset);

}  // namespace pinnquad::logs
