// SPDX-License-Identifier: MIT
// Networks that Python has, or files of them, as models; models as networks for elsewhere.
#include <string>

#include "convert/convert_network.hpp"
#include "python/bindings.hpp"

namespace python {

namespace {

/// networks.answer, of texts.
programs::AskPython asked(const py::function& answer) {
  return [answer](const std::string& request) { return answer(request).cast<std::string>(); };
}

}  // namespace

void bind_conversion(py::module_& module) {
  module.def(
      "_convert",
      [](const std::string& source, const std::filesystem::path& features, const std::filesystem::path& out,
         const std::string& name, const std::string& prefix, const std::string& output, bool in_double,
         const py::function& answer) {
        return programs::convert_network({source, features.string(), out.string(), name, prefix, output, in_double},
                                         asked(answer));
      },
      "Of pinnquad.convert().");
  module.def(
      "_network_of",
      [](const pinnquad::BlockModel& model, const std::string& ending, const py::function& answer) {
        return py::bytes(programs::network_of(model, ending, asked(answer)));
      },
      "Of pinnquad.save_network().");
}

}  // namespace python
