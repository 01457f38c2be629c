// SPDX-License-Identifier: MIT
// The ablation: what of the recipe decides the outcome; its variants are compiled in ablation.cpp.
#pragma once

#include <string>
#include <vector>

#include "study/contender.hpp"

namespace study {

/// The variants that a list such as "vanilla,informed" names; an empty list names all.
/// Throws std::invalid_argument, one line, for a name that there is not.
std::vector<Contender> chosen_variants(const std::vector<std::string>& names);

}  // namespace study
