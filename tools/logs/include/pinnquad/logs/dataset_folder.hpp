// SPDX-License-Identifier: MIT
// An imported dataset as a folder: dataset.json says what it is and how it was made, each flight is a CSV file
// (data/csv.hpp).
//   {"format": 1, "sample_period_s": 0.02, "lag_removed_s": 0.03, "absent": ["velocity"],
//    "flights": [{"name", "file", "trajectory", "weight", "rows", "source"}],
//    "steps": [{"step", "rows_before", "rows_after", "told"}]}
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pinnquad/logs/read_dataset.hpp"

namespace pinnquad::logs {

inline constexpr const char* dataset_file_name = "dataset.json";

/// Throws OutputError where something stands at the path that a dataset may not replace: a file, or a folder that holds
/// more than a dataset.
void require_dataset_place(const std::string& path);

/// The text of dataset.json.
std::string dataset_json(const ImportedDataset& dataset);

/// The file of each flight in the folder.
std::vector<std::string> flight_files(const ImportedDataset& dataset);

/// The folder appears whole or not at all; a dataset that stood there is replaced. Throws OutputError, one line. Calls
/// `go_on(share)` now and then, unless it is empty: what it throws leaves nothing behind.
void write_dataset_folder(const std::string& path, const ImportedDataset& dataset,
                          const std::function<void(double)>& go_on = {});

/// Throws InputError, one line: no dataset.json, one of another format, flights that are missing or not as it says.
ImportedDataset read_dataset_folder(const std::string& path, const OnProgress& on_progress = {});

}  // namespace pinnquad::logs
