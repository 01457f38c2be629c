// SPDX-License-Identifier: MIT
// Table 3 on the terminal, from the rows of a finished study.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "study/configuration.hpp"
#include "study/rows.hpp"
#include "training/judgement.hpp"

namespace study {

/// A column of one model on one flight, over its seeds.
inline std::vector<double> column(const StoredRows& stored, const Contender& contender, std::uint64_t flight_seed,
                                  const std::string& name) {
  std::vector<std::string_view> fields;
  const std::string header = rows_header();
  pinnquad::split_fields(header, fields);
  const auto at = static_cast<std::size_t>(std::find(fields.begin(), fields.end(), name) - fields.begin());
  std::vector<double> values;
  for (const auto& [id, row] : stored.rows) {
    if (id.model != contender.id || id.flight != contender.flight || id.flight_seed != flight_seed) continue;
    pinnquad::split_fields(row, fields);
    double value = 0;
    std::from_chars(fields[at].data(), fields[at].data() + fields[at].size(), value);
    values.push_back(value);
  }
  return values;
}

/// Rows are models and flights; mean and deviation over the seeds.
inline void print_summary(const Plan& plan, const StoredRows& stored) {
  std::printf("%-22s %-10s %18s %16s %16s %16s %18s\n", "model", "flight", "error, 1e-3", "roll, deg", "pitch, deg",
              "yaw, deg", "validation, 1e-3");
  for (const Contender& contender : plan.contenders) {
    for (const std::uint64_t seed : flight_seeds(plan, contender)) {
      const auto cell = [&](const char* name, double scale, int digits) {
        const std::vector<double> values = column(stored, contender, seed, name);
        const bool known = !values.empty() && std::isfinite(values.front());  // no validation rows: none is known
        return known ? programs::mean_and_deviation(values, scale, digits) : std::string("-");
      };
      std::printf("%-22s %-10s %18s %16s %16s %16s %18s\n", contender.id.c_str(),
                  (contender.flight + "/" + std::to_string(seed)).c_str(), cell("mae", 1e3, 3).c_str(),
                  cell("angle_difference_deg_roll", 1, 3).c_str(), cell("angle_difference_deg_pitch", 1, 3).c_str(),
                  cell("angle_difference_deg_yaw", 1, 3).c_str(), cell("validation_mae", 1e3, 3).c_str());
    }
  }
}

}  // namespace study
