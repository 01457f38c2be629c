// Planted: neither guard nor licence.
// FAULT no '#pragma once'
// FAULT no line '// SPDX-License-Identifier: MIT'
// FAULT is not reached from pinnquad/pinnquad.hpp
