// SPDX-License-Identifier: MIT
#include "page/page.hpp"

#include <filesystem>
#include <fstream>
#include <system_error>

#include <kainjow/mustache.hpp>
#include <nlohmann/json.hpp>

#include "page/text.hpp"

namespace programs {
namespace {

/// JSON as the template reads it: null and an empty text are as false. It cannot ask whether a list has entries: beside
/// a list `x` there is `any_x`.
kainjow::mustache::data mustache_data(const nlohmann::json& value) {
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
  if (value.is_boolean() || value.is_null() || value == "") return data(value == true);
  return data(value.is_string() ? value.get<std::string>() : value.dump());
}

std::string filled(const char* text, const nlohmann::json& content) {
  kainjow::mustache::mustache page(text);
  page.set_custom_escape(html_text);
  return page.render(mustache_data(content));
}

}  // namespace

std::string whole_page(const std::string& title, const std::string& style, const std::string& body) {
  return filled(page_file("page.html"),
                {{"title", title}, {"style", page_file("palette.css") + style}, {"body", body}});
}

std::string bundle_path(const std::string& name) {
  std::error_code ignored;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored);
  return (program.parent_path().parent_path() / "share/pinnquad" / (name + ".json")).string();
}

nlohmann::json read_bundle(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const nlohmann::json bundle = file ? nlohmann::json::parse(file, nullptr, false) : nlohmann::json();
  for (const char* part : {"style", "body", "script"}) {
    if (!bundle.is_object() || !bundle.contains(part) || !bundle[part].is_string()) return nullptr;
  }
  return bundle;
}

std::string text_page(const std::string& body, nlohmann::json content) {
  const nlohmann::json charts = read_bundle(bundle_path("charts"));
  content["charts"] = !charts.is_null();
  std::string style = page_file("text.css"), text = filled(page_file(body), content);
  if (!charts.is_null()) {
    style += charts["style"].get<std::string>();
    text += charts["body"].get<std::string>() + "<script>" + charts["script"].get<std::string>() + "</script>";
  }
  return whole_page(content.at("title"), style, text);
}

}  // namespace programs
