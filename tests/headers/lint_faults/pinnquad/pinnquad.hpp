// SPDX-License-Identifier: MIT
// Planted: an umbrella that forgets core/bare.hpp.
#pragma once

#include "pinnquad/attic/old.hpp"
#include "pinnquad/core/down.hpp"
#include "pinnquad/core/eigen.hpp"
#include "pinnquad/core/words.hpp"
#include "pinnquad/loss/long.hpp"
#include "pinnquad/loss/loss.hpp"
#include "pinnquad/nn/layer.hpp"
#include "pinnquad/schedule/circle_a.hpp"
#include "pinnquad/schedule/circle_b.hpp"
#include "pinnquad/schedule/constant.hpp"
