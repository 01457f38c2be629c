// SPDX-License-Identifier: MIT
// Text, figures and bytes on their way into a page: what HTML and data URLs can hold, numbers in a page's signs.
#pragma once

#include <string>

namespace programs {

/// `<`, `>`, `&` and quotes as HTML text; control characters, which HTML has no place for, as spaces.
std::string html_text(const std::string& text);

/// Base64 (RFC 4648) of bytes.
std::string base64(std::string bytes);

/// Figures with true minus signs, powers of ten, a dash where there is none. Plain text.
namespace shown {

/// A number with fixed decimals.
std::string number(double value, int decimals, bool plus = false);

/// A figure with its unit in plain ASCII, such as "-4.1e-3" or "3.2 deg", in the page's signs.
std::string quantity(const std::string& text);

/// Two significant figures; powers of ten below a thousandth.
std::string p_value(double p);

}  // namespace shown
}  // namespace programs
