// SPDX-License-Identifier: MIT
// Bodies of functions that are no templates stand in impl/ beside their header, which includes them at its end: nothing
// need be linked. Where PINNQUAD_COMPILED is defined it does not, and a library that is built once has them
// (the CMake target pinnquad::compiled).
#pragma once

#ifdef PINNQUAD_COMPILED
#define PINNQUAD_BODY
#else
#define PINNQUAD_BODY inline
#endif
