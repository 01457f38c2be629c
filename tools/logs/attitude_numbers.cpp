// SPDX-License-Identifier: MIT
#include "logs/attitude_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "pinnquad/io/decimal.hpp"

namespace pinnquad::logs {

void require_unit(const Signal& signal) {
  constexpr double tolerance = 0.05;
  for (std::size_t row = 0; row < signal.topic->size(); ++row) {
    const auto& v = signal.values;
    const double square = v[0][row] * v[0][row] + v[1][row] * v[1][row] + v[2][row] * v[2][row] + v[3][row] * v[3][row];
    if (!std::isfinite(square) || square < 1e-12 || std::abs(std::sqrt(square) - 1) <= tolerance) continue;
    throw wrong_cell(*signal.topic, row, signal.source->columns[0].name,
                     "a unit quaternion in " + topic_words(signal.topic->name, signal.topic->instance),
                     "one of length " + number_text(std::sqrt(square)));
  }
}

void require_radians(const Signal& signal) {
  constexpr double most_rad = 1.6, few = 0.01;
  const Source& source = *signal.source;
  const std::vector<double>& pitch = signal.values[1];
  std::size_t beyond = 0, worst = 0;
  std::vector<double> sizes;
  for (std::size_t row = 0; row < pitch.size(); ++row) {
    if (std::isfinite(pitch[row])) sizes.push_back(std::abs(pitch[row]));
    if (!(std::abs(pitch[row]) > most_rad)) continue;
    if (beyond++ == 0 || std::abs(pitch[row]) > std::abs(pitch[worst])) worst = row;
  }
  if (static_cast<double>(beyond) <= few * static_cast<double>(pitch.size())) return;
  // as the log has it nearly always: the smallest unit by which that is at most a right angle
  const auto usual = sizes.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(sizes.size() - 1));
  std::nth_element(sizes.begin(), usual, sizes.end());
  const double in_si = *unit_in_si(Dimension::angle, source.unit.empty() ? "rad" : source.unit);
  std::string advice;
  for (const char* unit : {"deg", "ddeg", "cdeg"}) {
    if (unit == source.unit || *usual / in_si * *unit_in_si(Dimension::angle, unit) > most_rad) continue;
    advice = std::string(" (another unit? Then the mapping needs unit = \"") + unit + "\")";
    break;
  }
  throw wrong_cell(*signal.topic, worst, source.columns[1].name, "a pitch of at most 90 degrees" + advice,
                   number_text(pitch[worst]) + " rad, beyond in " + std::to_string(beyond) + " rows");
}

void make_scalar(std::vector<std::vector<double>>& values) {
  std::vector<double> w(values[0].size());
  for (std::size_t row = 0; row < w.size(); ++row) {
    const double x = values[0][row], y = values[1][row], z = values[2][row], rest = 1 - (x * x + y * y + z * z);
    w[row] = std::isnan(rest) ? rest : std::sqrt(std::max(0.0, rest));
  }
  values.insert(values.begin(), std::move(w));
}

bool counts_to_32767(const std::vector<std::vector<double>>& values) {
  double most = 0;
  for (const std::vector<double>& column : values) {
    for (const double value : column) {
      if (!std::isfinite(value)) continue;
      if (std::abs(value - std::round(value)) > 0 || std::abs(value) > 32768) return false;
      most = std::max(most, std::abs(value));
    }
  }
  return most > 2;
}

}  // namespace pinnquad::logs
