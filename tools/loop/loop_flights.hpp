// SPDX-License-Identifier: MIT
// Flights of controllers on all cores. In a folder each is flown once: a journal keeps what is done, line by line, so
// that the same command goes on where it was stopped.
#pragma once

#include <cstddef>
#include <fstream>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "command_line/folder_lock.hpp"
#include "loop/controlled_loop.hpp"

namespace programs {

/// FOLDER/loop.journal, one JSON value a line: the plan, then what is done. A last line that was not written whole is
/// dropped. The folder is held as long as this lives.
class LoopJournal {
 public:
  /// Throws OutputError, one line, of a journal of another plan too.
  LoopJournal(const std::string& folder, const nlohmann::json& plan);

  /// The row of a flight, or null.
  const nlohmann::json* row(const LoopFlight& flight) const;
  const std::map<std::string, nlohmann::json>& tuned() const { return tuned_; }  ///< by controller
  /// Thread-safe. Throws OutputError.
  void add(const nlohmann::json& value);

 private:
  std::size_t read(const nlohmann::json& plan);
  [[noreturn]] void refuse(const nlohmann::json& found, const nlohmann::json& plan) const;
  void file(const nlohmann::json& value);
  void write(const nlohmann::json& value);

  FolderLock lock_;
  std::string path_;
  std::ofstream out_;
  std::mutex mutex_;
  std::map<std::string, nlohmann::json> rows_, tuned_;
};

/// The plan of a journal: what its flights have in common.
nlohmann::json plan_of(const LoopSetting& setting, const std::string& airframe);

/// The rows of all flights, in their order; those that the journal lacks are flown, by `fly`. `journal`: or null.
/// Throws Interrupted, which says how to go on.
std::vector<nlohmann::json> rows_of(const std::vector<LoopFlight>& flights, LoopJournal* journal, std::size_t threads,
                                    const std::function<nlohmann::json(const LoopFlight&)>& fly);

}  // namespace programs
