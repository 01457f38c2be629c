// SPDX-License-Identifier: MIT
// Two faults: a room that comes later, and a header that is not there.
#pragma once

#include "high/second.hpp"
#include "second.hpp"
