// SPDX-License-Identifier: MIT
// Gaps of a study: against Table 2, its own plan, and a study's defaults.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "command_line/listed.hpp"
#include "report/paper.hpp"
#include "report/settings.hpp"

namespace programs {

/// Parts of a whole study that this one lacks, one line each.
inline std::vector<std::string> missing_lines(const Study& study, const StudySettings& settings) {
  std::vector<std::string> lines;
  std::string absent_models;
  for (int model = 1; model <= study_models; ++model) {
    if (settings.plans(model)) continue;
    add_to_list(absent_models, std::to_string(model));
  }
  if (!absent_models.empty()) lines.push_back("not part of this study: models " + absent_models);
  if (study.cut_rows > 0) lines.push_back("rows.csv ends with a row that is cut off: left out");
  const std::size_t wanted = std::max(settings.seeds, study.expected.size());
  for (int model = 1; model <= study_models; ++model) {
    if (!settings.plans(model)) continue;
    const std::string name = "model " + std::to_string(model);
    const std::vector<const StudyRow*> trainings = study.trainings(model);
    if (trainings.empty()) {
      lines.push_back(name + ": no rows");
      continue;
    }
    if (model == 1) continue;  // it is not trained
    std::set<std::uint64_t> seeds;
    std::size_t undefined = 0;
    for (const StudyRow* row : trainings) {
      seeds.insert(row->seed);
      undefined += std::isfinite(row->figure("mae")) ? 0 : 1;
    }
    std::string absent;
    for (const std::uint64_t seed : study.expected) {
      if (seeds.count(seed) == 0) absent += (absent.empty() ? ", without seed " : ", ") + std::to_string(seed);
    }
    if (seeds.size() < wanted) {
      lines.push_back(name + ": " + std::to_string(seeds.size()) + " of " + std::to_string(wanted) + " seeds" + absent);
    }
    if (undefined > 0) {
      lines.push_back(name + ": " + std::to_string(undefined) + " trainings without a finite error, left out");
    }
  }
  return lines;
}

/// Counts of a study below the defaults: "12 epochs of 300", "2 seeds of 20". A model that lacks seeds of a study that
/// has them is told by missing_lines.
inline std::vector<std::string> smaller_than_default(const Study& study, const StudySettings& settings) {
  std::uint64_t epochs = paper_epochs;
  for (const StudyRow& row : study.rows) {
    if (row.model > 1) epochs = std::min(epochs, row.epochs);
  }
  const std::size_t seeds = std::max(settings.seeds, study.expected.size());
  std::vector<std::string> lines;
  const auto compare = [&lines](std::uint64_t count, int by_default, const char* what) {
    if (count >= static_cast<std::uint64_t>(by_default)) return;
    lines.push_back(std::to_string(count) + what + (count == 1 ? "" : "s") + " of " + std::to_string(by_default));
  };
  compare(epochs, paper_epochs, " epoch");
  compare(seeds, paper_seeds, " seed");
  return lines;
}

}  // namespace programs
