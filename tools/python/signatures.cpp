// SPDX-License-Identifier: MIT
// Signatures of the module's functions as inspect reads them: "step(self, commands, seconds=0.002)\n--\n\ndoc".
// Python's own "$self" is not for them: a function of pybind11 counts as bound, and would lose its first argument.
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "python/bindings.hpp"

namespace python {

namespace {

/// Where `text` has the first of `marks` from `from` on, outside brackets and quotes; its size where it has none.
std::size_t outermost(std::string_view text, std::string_view marks, std::size_t from) {
  int depth = 0;
  char quote = 0;
  for (std::size_t i = from; i < text.size(); ++i) {
    const char c = text[i];
    if (quote != 0) {
      if (c == '\\') ++i;
      if (c == quote) quote = 0;
    } else if (depth == 0 && marks.find(c) != std::string_view::npos) {
      return i;
    } else if (c == '\'' || c == '"') {
      quote = c;
    } else if (c == '(' || c == '[' || c == '{' || c == '<') {
      ++depth;
    } else if (c == ')' || c == ']' || c == '}' || (c == '>' && text[i - 1] != '-')) {
      --depth;
    }
  }
  return text.size();
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

/// "self: Model, seconds: float = 5.0" -> "self, seconds=5.0"; a default that is no literal is "...".
std::string without_types(std::string_view arguments) {
  std::string result;
  for (std::size_t first = 0; first < arguments.size();) {
    const std::size_t end = outermost(arguments, ",", first);
    const std::string_view argument = arguments.substr(first, end - first);
    const std::size_t colon = outermost(argument, ":=", 0), equals = outermost(argument, "=", 0);
    const std::string_view name = trimmed(argument.substr(0, colon));
    result += (result.empty() ? "" : ", ") + std::string(name);
    if (equals < argument.size()) {
      const std::string_view value = trimmed(argument.substr(equals + 1));
      result += "=" + std::string(value.front() == '<' ? "..." : value);
    }
    first = end + 1;
  }
  return result;
}

/// Documentation of pybind11, "name(arguments) -> type\n\ndoc", as Python's own functions have it.
std::string with_text_signature(const std::string& text) {
  const std::size_t open = text.find('(');
  if (open == std::string::npos || text.find('\n') < open || text.find(")\n--\n\n") != std::string::npos) return text;
  const std::size_t close = outermost(text, ")", open + 1), line = text.find('\n', close);
  if (close >= text.size()) return text;
  const std::size_t doc = line == std::string::npos ? text.size() : text.find_first_not_of('\n', line);
  return text.substr(0, open) + "(" + without_types(std::string_view(text).substr(open + 1, close - open - 1)) +
         ")\n--\n\n" + (doc == std::string::npos ? "" : text.substr(doc));
}

void give_text_signature(PyObject* function) {
  if (PyInstanceMethod_Check(function)) function = PyInstanceMethod_GET_FUNCTION(function);
  if (!PyCFunction_Check(function)) return;
  PyMethodDef* const definition = reinterpret_cast<PyCFunctionObject*>(function)->m_ml;
  if (definition->ml_doc == nullptr) return;
  // memory of pybind11's, which frees it by std::free when the function ends
  char* const text = strdup(with_text_signature(definition->ml_doc).c_str());
  std::free(const_cast<char*>(definition->ml_doc));
  definition->ml_doc = text;
}

}  // namespace

void give_text_signatures(const py::module_& module) {
  for (const auto& [name, value] : module.attr("__dict__").cast<py::dict>()) {
    give_text_signature(value.ptr());
    // a class of the module's own: functions of others, such as an enumeration's, have a text that is not pybind11's
    if (Py_TYPE(value.ptr()) != py::detail::get_internals().default_metaclass) continue;
    for (const auto& member : value.attr("__dict__").attr("values")()) {
      const bool is_static = Py_TYPE(member.ptr()) == &PyStaticMethod_Type;
      give_text_signature(is_static ? member.attr("__func__").ptr() : member.ptr());
    }
  }
}

}  // namespace python
