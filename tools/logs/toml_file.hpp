// SPDX-License-Identifier: MIT
// TOML files as the library and the program take them: small, and what is wrong with one is said with line and column.
#pragma once

// the parser answers broken text with an error of its own behind these: a debug build must not end there
#define TOML_ASSERT(expr) static_cast<void>(0)
#include <toml++/toml.h>

#include <string>

namespace pinnquad::logs {

/// The tables of a text; `path` names it. Throws InputError if it is no TOML, or nested too deep.
toml::table parse_toml(const std::string& content, const std::string& path);

/// The tables of a file. Throws InputError: it can't be read, has more than 1 MiB where `what` ("an airframe") was
/// expected, or is no TOML.
toml::table read_toml_file(const std::string& path, const std::string& what);

[[noreturn]] void refuse_toml(const std::string& path, const toml::source_region& where, const std::string& expected,
                              const std::string& found);

/// Of a number: an integer, however large, or a floating-point one.
double toml_number(const toml::node& node);

/// A node as the one-line messages name it: its value, or its kind.
std::string described(const toml::node& node);

/// A text of the file. One with a NUL inside would be cut there where it names a file.
std::string text_of_toml(const std::string& path, const toml::value<std::string>& text);

}  // namespace pinnquad::logs
