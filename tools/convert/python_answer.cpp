// SPDX-License-Identifier: MIT
#include "convert/python_answer.hpp"

#include "pinnquad/io/file_error.hpp"

namespace programs {

nlohmann::json python_answer(const AskPython& ask, const std::string& request, const std::string& path) {
  nlohmann::json answer = nlohmann::json::parse(ask(request));
  if (answer.contains("expected")) {
    const nlohmann::json& where = answer.at("path");
    throw pinnquad::InputError(where.is_string() ? where.get<std::string>() : path, 0, 0,
                               pinnquad::printable(answer.at("expected").get<std::string>()),
                               pinnquad::printable(answer.at("found").get<std::string>()));
  }
  return answer;
}

}  // namespace programs
