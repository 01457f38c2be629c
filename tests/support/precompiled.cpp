// SPDX-License-Identifier: MIT
// Nothing: a target that precompiles headers for others needs a source of its own.
// What is precompiled stands in tests/CMakeLists.txt.
