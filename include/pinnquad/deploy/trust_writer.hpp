// SPDX-License-Identifier: MIT
// Writes the limits of trust in a model as a struct beside it, for JointDistance and CommandResidualMonitor.
#pragma once

#include <cstdint>
#include <ostream>
#include <string>

#include "pinnquad/training/structured/trust_limits.hpp"

namespace pinnquad {

/// Writes `struct <model_name>Trust`, to follow what write_model() wrote under that name: the header's contract is
/// unchanged, and a header without it is whole. `Scalar`: the model's. Throws std::invalid_argument, and writes
/// nothing, for a name that no struct may have and a number that is not finite as the model's Scalar has it.
template <class Scalar>
void write_trust(std::ostream& stream, const std::string& model_name, const FittedTrust& trust,
                 std::uint64_t training_data_hash);

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/deploy/impl/trust_writer.hpp"
#endif
