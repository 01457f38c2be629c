// SPDX-License-Identifier: MIT
// Clean: low comes before high.
#pragma once

#include "low/first.hpp"
