// SPDX-License-Identifier: MIT
// Text, figures and bytes on their way into a page: what HTML and data URLs can hold, numbers in a page's signs.
#pragma once

#include <string>

namespace programs {

/// `<`, `>`, `&` and quotes as HTML text; control characters, which HTML has no place for, as spaces.
std::string html_text(const std::string& text);

/// Base64 (RFC 4648) of bytes.
std::string base64(std::string bytes);

/// Figures with true minus signs, a dash where there is none. Plain text.
namespace shown {

/// A number with fixed decimals.
std::string number(double value, int decimals);

}  // namespace shown
}  // namespace programs
