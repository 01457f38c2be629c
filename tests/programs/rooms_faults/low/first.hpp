// SPDX-License-Identifier: MIT
// Three faults: a room that comes later, a header that is not there, an example.
#pragma once

#include "../../rooms_faults_examples/example.hpp"
#include "high/second.hpp"
#include "second.hpp"
