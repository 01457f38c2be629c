// SPDX-License-Identifier: MIT
// Pages: one head, one palette, one template (page.html) around what each of them says.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace programs {

// Files of this repository, compiled in (page/CMakeLists.txt).
extern const char* const page_template;           ///< page/page.html, in the language of mustache
extern const char* const page_palette;            ///< page/palette.css
extern const char* const text_style;              ///< page/text.css: a page of text, tables and charts
extern const char* const training_page_template;  ///< training/training_page.html

/// A page of its title as text, and its style and body as they are.
std::string whole_page(const std::string& title, const std::string& style, const std::string& body);

/// A page of text: `body_template` filled with the content, whose "title" is the page's. Text is escaped where the
/// template has two braces.
std::string text_page(const char* body_template, const nlohmann::json& content);

}  // namespace programs
