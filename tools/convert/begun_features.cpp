// SPDX-License-Identifier: MIT
#include "convert/begun_features.hpp"

#include <stdexcept>

#include "command_line/in_words.hpp"
#include "pinnquad/data/row_set.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/training/training_data.hpp"

namespace programs {
namespace {

using namespace pinnquad;

template <class Features>
std::string features_text(const RowSet& rows) {
  std::string text;
  const auto columns = pinnquad::detail::feature_statistics<Features>(rows);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto& column = columns[i];
    text += in_words("  { name = \"%s\", unit = \"%s\", lower = %.4g, upper = %.4g },  # mean = %.6g, scale = %.6g\n",
                     Features::names[i], Features::units[i], column.lowest - column.margin(),
                     column.highest + column.margin(), column.mean, column.scale());
  }
  return text;
}

}  // namespace

std::string begun_features(const Dataset& flights, const std::string& set) {
  const RowSet rows = all_rows(flights.flights());
  if (rows.size() == 0) throw std::invalid_argument("a features file begins with the rows of a flight; there are none");
  std::string features;
  if (set == "paper") {
    features = features_text<PaperFeatures>(rows);
  } else if (set == "physics") {
    features = features_text<PhysicsFeatures>(rows);
  } else if (set == "inverse") {
    features = features_text<InverseFeatures>(rows);
  } else {
    throw std::invalid_argument("--inputs " + set + ": paper, physics or inverse was expected");
  }
  return "# The numbers that the network reads, in its order. One that reads (value - mean) / scale says so in the "
         "braces.\n"
         "feature = [\n" +
         features +
         "]\n"
         "# Of safetensors alone, after each Linear but the last: activations = \"relu\"\n"
         "# Where its outputs were standardised too: [output] with mean and scale, four numbers each\n"
         "[airframe]\n"
         "name = \"paper_quadrotor\"  # or file = \"mine.toml\", beside this file\n";
}

}  // namespace programs
