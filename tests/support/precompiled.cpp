// SPDX-License-Identifier: MIT
// Nothing: a target that precompiles headers for others needs a source of its own.
// tests/CMakeLists.txt lists the precompiled headers.
