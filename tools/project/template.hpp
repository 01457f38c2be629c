// SPDX-License-Identifier: MIT
// The files of a new project, as template/ has them: compiled into the program, which works wherever it lies. Defined
// in a source that CMake writes of them.
#pragma once

#include <vector>

namespace programs {

/// A text with places to fill: {{version}}, {{name}}, {{struct}}, {{airframe}}, {{airframe_value}}, {{features}},
/// {{outputs}}, {{network}}.
struct TemplateFile {
  const char* name;
  const char* text;
};

const std::vector<TemplateFile>& project_template();

}  // namespace programs
