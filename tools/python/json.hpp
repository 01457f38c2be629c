// SPDX-License-Identifier: MIT
// JSON of the program as dicts and lists of Python; null is None.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "python/bindings.hpp"

namespace python {

inline py::object to_python(const nlohmann::json& value) {
  const std::string text = value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  return py::module_::import("json").attr("loads")(text);
}

}  // namespace python
