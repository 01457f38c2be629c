// SPDX-License-Identifier: MIT
#pragma once
namespace pinnquad {

struct Needed {};     ///< by a program
struct Mentioned {};  ///< by a comment of a program alone
struct Lonely {};     ///< by a test alone

namespace detail {
struct Own {};
}  // namespace detail

}  // namespace pinnquad
