// SPDX-License-Identifier: MIT
// Input of a study's report, as it lies in the study's folder.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "page/text.hpp"
#include "report/figures.hpp"
#include "report/settings.hpp"

namespace programs {
namespace detail {

/// Input of a study's report.
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
  std::vector<StudyRow> rows = read_study_rows(folder + "/rows.csv", input.settings, cut_rows);
  input.study = make_study(std::move(rows), input.settings.flights, input.settings.weights);
  input.study.cut_rows = cut_rows;
  for (const int model : {2, 4}) {
    const std::string path = folder + "/series/model" + std::to_string(model) + ".csv";
    std::error_code error;
    if (std::filesystem::exists(path, error)) input.series.emplace_back(model, read_study_series(path));
  }
  return input;
}

/// The pictures of the flights, where DIR/flights holds those that `fly --pictures` draws, as {name, caption, base64};
/// the names of those that are not there go into `left_out`.
inline nlohmann::json flight_pictures(const std::string& folder, std::vector<std::string>& left_out) {
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
       {"wind.svg", "Fig. 6", "D3: drag and what the wind adds along the body’s axes; below, the wind."}}};
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder + "/flights", error))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  nlohmann::json found = nlohmann::json::array();
  for (const Picture& picture : pictures) {
    const std::string ending = picture.ending;
    const auto file = std::find_if(files.begin(), files.end(), [&ending](const std::filesystem::path& path) {
      const std::string name = path.filename().string();
      return name.size() >= ending.size() && name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
    });
    if (file == files.end()) {
      left_out.push_back(picture.name);
    } else {
      found.push_back({{"name", picture.name},
                       {"caption", picture.caption},
                       {"base64", base64(pinnquad::file_text(file->string()))}});
    }
  }
  return found;
}

}  // namespace detail
}  // namespace programs
