// SPDX-License-Identifier: MIT
// A certificate that the compiler works out, with -fsanitize=undefined: g++ then takes a pointer into an array that is
// compared with null for no constant.
#include "models/near_ground_quadrotor.hpp"

static_assert(pinnquad::certificate_of<NearGroundQuadModel>().proven());

int main() {}
