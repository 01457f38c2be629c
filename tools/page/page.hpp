// SPDX-License-Identifier: MIT
// Pages: one head, one palette, one template (page.html) around what each of them says.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace programs {

/// A file of this repository, compiled in (page/CMakeLists.txt): page.html, palette.css, text.css (the style of text,
/// tables and charts), or a body `<room>/<name>_page.html`, by its name without the room. Throws std::out_of_range.
const char* page_file(const std::string& name);

/// A page of its title as text, and its style and body as they are.
std::string whole_page(const std::string& title, const std::string& style, const std::string& body);

/// A page of text: the body of that name, such as "training_page.html", filled with the content, whose "title" is the
/// page's. Text is escaped where the body, a template of mustache, has two braces. Throws as page_file().
std::string text_page(const std::string& body, const nlohmann::json& content);

}  // namespace programs
