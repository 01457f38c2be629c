// SPDX-License-Identifier: MIT
// A page of text: its template (pictures/page_template.hpp) filled with what it says, as JSON.
#pragma once

#include <string>
#include <utility>

#include <kainjow/mustache.hpp>
#include <nlohmann/json.hpp>

#include "pictures/html_text.hpp"
#include "pictures/page_template.hpp"

namespace programs {
namespace detail {

/// JSON as the template reads it. It cannot ask whether a list has entries: beside a list `x` there is `any_x`.
inline kainjow::mustache::data mustache_data(const nlohmann::json& value) {
  using kainjow::mustache::data;
  if (value.is_object()) {
    data object(data::type::object);
    for (const auto& item : value.items()) {
      object.set(item.key(), mustache_data(item.value()));
      if (item.value().is_array()) object.set("any_" + item.key(), data(!item.value().empty()));
    }
    return object;
  }
  if (value.is_array()) {
    data list(data::type::list);
    for (const nlohmann::json& item : value) list.push_back(mustache_data(item));
    return list;
  }
  if (value.is_boolean()) return data(value.get<bool>());
  return data(value.is_string() ? value.get<std::string>() : value.dump());
}

}  // namespace detail

/// The whole page; text is escaped where the template has two braces, `page_style` is added.
inline std::string filled_page(const char* page_template, nlohmann::json content) {
  content["page_style"] = page_style;
  kainjow::mustache::mustache page(page_template);
  page.set_custom_escape(html_text);
  return page.render(detail::mustache_data(content));
}

}  // namespace programs
