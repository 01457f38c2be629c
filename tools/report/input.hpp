// SPDX-License-Identifier: MIT
// What a study's report is made of, as it lies in the study's folder.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "report/figures.hpp"
#include "report/settings.hpp"

namespace programs {
namespace detail {

/// What a study's report is made of.
struct ReportInput {
  std::string folder;
  StudySettings settings;
  Study study;
  std::vector<std::pair<int, StudySeries>> series;  ///< of models 2 and 4, where there
};

inline ReportInput read_report_input(const std::string& folder) {
  ReportInput input;
  input.folder = folder;
  input.settings = read_study_settings(folder + "/study.json");
  std::size_t cut_rows = 0;
  std::vector<StudyRow> rows = read_study_rows(folder + "/rows.csv", cut_rows);
  input.study = make_study(std::move(rows), input.settings.flights, input.settings.weights);
  input.study.cut_rows = cut_rows;
  for (const int model : {2, 4}) {
    const std::string path = folder + "/series/model" + std::to_string(model) + ".csv";
    std::error_code error;
    if (std::filesystem::exists(path, error)) input.series.emplace_back(model, read_study_series(path));
  }
  return input;
}

/// The pictures of the flights, where DIR/flights holds those that `fly --pictures` draws.
inline std::string flight_pictures(const std::string& folder, std::string& left_out) {
  struct Picture {
    const char* ending;
    const char* name;
    const char* caption;
  };
  static constexpr std::array<Picture, 4> pictures = {
      {{"trajectory.svg", "Fig. 4 (d)", "The flown path of D1, coloured by speed."},
       {"correlation.svg", "Fig. 2 over the whole flight",
        "Angular acceleration and signed command sum over the whole flight."},
       {"ground_effect.svg", "Fig. 5",
        "D2: thrust ratio of the ground effect models with what was flown; below, height and force over "
        "time with the split."},
       {"wind.svg", "Fig. 6", "D3: drag and what the wind adds along the body&rsquo;s axes; below, the wind."}}};
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder + "/flights", error))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::string text;
  for (const Picture& picture : pictures) {
    const std::string ending = picture.ending;
    bool found = false;
    for (const std::filesystem::path& file : files) {
      const std::string name = file.filename().string();
      if (name.size() < ending.size() || name.compare(name.size() - ending.size(), ending.size(), ending) != 0)
        continue;
      text += html::figure(html::embedded_svg(pinnquad::file_text(file.string()), picture.name),
                           html::tag("b", std::string(picture.name) + ".") + " " + picture.caption);
      found = true;
      break;
    }
    if (!found) left_out += (left_out.empty() ? "" : ", ") + std::string(picture.name);
  }
  return text;
}

}  // namespace detail
}  // namespace programs
