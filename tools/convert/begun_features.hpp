// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "pinnquad/data/dataset.hpp"

namespace programs {

/// A features file (docs/convert.md) to begin with, for a network that was trained on these flights: the features of
/// `set` ("paper", "physics" or "inverse") with the range that training would take, and as comments mean and scale.
/// Throws std::invalid_argument, one line, for another set and for flights without a row.
std::string begun_features(const pinnquad::Dataset& flights, const std::string& set);

}  // namespace programs
