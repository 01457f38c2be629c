// SPDX-License-Identifier: MIT
// And when it is not to be trusted.
#pragma once

#include "../structured_trust.hpp"

using TrainedQuadModelTrust = StructuredQuadModelTrust;
