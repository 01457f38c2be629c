// SPDX-License-Identifier: MIT
// Pages: one head, one palette, one template (page.html) around what each of them says.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace programs {

/// A file of this repository, compiled in (page/CMakeLists.txt): page.html, palette.css, text.css (the style of text
/// and tables), or a body `<room>/<name>_page.html`, by its name without the room. Throws std::out_of_range.
const char* page_file(const std::string& name);

/// A page of its title as text, and its style and body as they are.
std::string whole_page(const std::string& title, const std::string& style, const std::string& body);

/// The path of a bundle by npm, "watch" or "charts": share/pinnquad/<name>.json beside the folder of the program, in a
/// build tree and in an installed one.
std::string bundle_path(const std::string& name);

/// Style, body and script of a bundle; null where the program was built without it.
nlohmann::json read_bundle(const std::string& path);

/// A page of text: the body of that name, such as "training_page.html", filled with the content, whose "title" is the
/// page's. Text is escaped where the body, a template of mustache, has two braces. What draws its charts is put in, and
/// the body's "charts" says whether it is there. Throws as page_file().
std::string text_page(const std::string& body, nlohmann::json content);

}  // namespace programs
