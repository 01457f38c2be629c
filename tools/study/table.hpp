// SPDX-License-Identifier: MIT
// Table 2 as contenders, and the choice of some of them on the command line.
#pragma once

#include <string>
#include <vector>

#include "study/contender.hpp"

namespace study {

/// The models that a list such as "2,4,5-8" names, in the order of Table 2; an empty list names all.
/// Throws std::invalid_argument, one line, for a number that Table 2 does not have and for text that is no list.
std::vector<Contender> chosen_models(const std::string& list);

}  // namespace study
