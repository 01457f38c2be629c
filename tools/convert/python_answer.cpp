// SPDX-License-Identifier: MIT
#include "convert/python_answer.hpp"

#include "pinnquad/io/file_error.hpp"

namespace programs {

nlohmann::json python_answer(const AskPython& ask, const std::string& request, const std::string& path) {
  nlohmann::json answer = nlohmann::json::parse(ask(request), nullptr, false);
  if (!answer.is_object()) throw pinnquad::InputError(path, 0, 0, "an answer of networks.py", "none");
  if (!answer.contains("expected")) return answer;
  const auto text = [&answer](const char* key, const std::string& otherwise) {
    return answer.contains(key) && answer[key].is_string() ? answer[key].get<std::string>() : otherwise;
  };
  throw pinnquad::InputError(text("path", path), 0, 0, pinnquad::printable(text("expected", "a network")),
                             pinnquad::printable(text("found", "none")));
}

}  // namespace programs
